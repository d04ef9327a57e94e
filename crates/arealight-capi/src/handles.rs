//! Which objects of the host are alive, so that a handle that was destroyed, or is of another kind, is
//! refused.

use crate::arguments;
use crate::failure::Failure;
use std::any::{TypeId, type_name};
use std::collections::HashMap;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// Addresses of objects, with their types. An address that is used again for another object of the same type
/// cannot be told from it.
static ALIVE: LazyLock<Mutex<HashMap<usize, TypeId>>> = LazyLock::new(Mutex::default);

fn alive<R>(function: impl FnOnce(&mut HashMap<usize, TypeId>) -> R) -> R {
    // Each use is one operation of the map, which a panic cannot leave half done
    function(&mut lock(&ALIVE))
}

/// What a panic leaves behind is still the object, good for being destroyed.
pub fn lock<T>(object: &Mutex<T>) -> MutexGuard<'_, T> {
    object.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Gives an object to the host.
pub fn give<T: 'static>(object: T) -> *mut T {
    let pointer = Box::into_raw(Box::new(object));
    alive(|map| map.insert(pointer as usize, TypeId::of::<T>()));
    pointer
}

/// The host's object.
///
/// # Safety
/// The object is not destroyed while the reference is used.
///
/// # Errors
/// [`Failure`] names `argument` where it is null, destroyed, or something else.
pub unsafe fn borrow<'a, T: 'static>(pointer: *const T, argument: &str) -> Result<&'a T, Failure> {
    arguments::refuse_null([(pointer.is_null(), argument)])?;
    if alive(|map| map.get(&(pointer as usize)) == Some(&TypeId::of::<T>())) {
        // SAFETY: the object is alive, of that type, and stays so by the contract.
        return Ok(unsafe { &*pointer });
    }
    let name = type_name::<T>().rsplit("::").next().unwrap_or_default();
    Err(Failure::argument(format!("{argument}: is no {name} that is alive; was it destroyed?")))
}

/// Takes an object back. Null is nothing.
///
/// # Safety
/// The object is not used elsewhere.
///
/// # Errors
/// As [`borrow`].
pub unsafe fn take<T: 'static>(pointer: *mut T, argument: &str) -> Result<Option<Box<T>>, Failure> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the same contract.
    unsafe { borrow(pointer, argument) }?;
    if alive(|map| map.remove(&(pointer as usize))).is_none() {
        return Err(Failure::argument(format!("{argument}: is being destroyed twice")));
    }
    // SAFETY: it was made by `give`, and was alive until now.
    Ok(Some(unsafe { Box::from_raw(pointer) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct One(u32);
    struct Other;

    #[test]
    fn objects_live_from_giving_to_taking() {
        let pointer = give(One(7));
        // SAFETY: the object is used by this thread alone, here and below.
        unsafe {
            assert_eq!(borrow(pointer, "one").unwrap().0, 7);
            let other = borrow(pointer.cast::<Other>(), "one").err().unwrap();
            assert_eq!(other.message, "one: is no Other that is alive; was it destroyed?");
            assert_eq!(take(pointer, "one").unwrap().unwrap().0, 7);
            assert!(borrow(pointer, "one").is_err() && take(pointer, "one").is_err());
            assert!(borrow(std::ptr::null::<One>(), "one").err().unwrap().message.contains("is null"));
            assert!(take(std::ptr::null_mut::<One>(), "one").unwrap().is_none());
        }
    }
}
