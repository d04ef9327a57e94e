//! Memory that the recorder's images lie in.

use crate::host::Host;
use gpu_allocator::vulkan::Allocation;

/// Memory that goes back to the host's allocator.
pub struct Memory {
    allocation: Option<Allocation>,
    host: Host,
}

impl Memory {
    /// Takes an allocation of the host's allocator.
    pub fn new(host: &Host, allocation: Allocation) -> Self {
        Self { allocation: Some(allocation), host: host.clone() }
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Some(allocation) = self.allocation.take() {
            // Freeing fails only for a foreign allocation
            let _ = self.host.with_allocator(|allocator| allocator.free(allocation));
        }
    }
}
