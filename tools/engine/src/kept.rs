//! Things that must not be destroyed while a GPU that never finished may use them.

use crate::host::Host;
use std::mem::ManuallyDrop;

/// A value that is dropped, unless its host was abandoned: then it is leaked, as all that the host made.
pub struct Kept<T> {
    value: ManuallyDrop<T>,
    host: Host,
}

impl<T> Kept<T> {
    /// Keeps `value` with the host that it was made on.
    pub fn new(host: &Host, value: T) -> Self {
        Self { value: ManuallyDrop::new(value), host: host.clone() }
    }
}

impl<T> std::ops::Deref for Kept<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> Drop for Kept<T> {
    fn drop(&mut self) {
        if !self.host.is_abandoned() {
            // SAFETY: Dropped here once; nothing uses the value afterwards.
            unsafe { ManuallyDrop::drop(&mut self.value) };
        }
    }
}
