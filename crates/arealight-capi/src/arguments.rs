//! Pointers of the host, checked as far as they can be.

use crate::failure::Failure;

/// A struct of the host.
///
/// # Safety
/// `pointer` is null, or of a valid struct that nobody changes while the reference is used.
///
/// # Errors
/// [`Failure`] names `argument` where it is null or misaligned.
pub unsafe fn read<'a, T>(pointer: *const T, argument: &str) -> Result<&'a T, Failure> {
    check(pointer, argument)?;
    // SAFETY: not null, aligned, and valid by the contract.
    Ok(unsafe { &*pointer })
}

/// A place for the library's answer.
///
/// # Safety
/// `pointer` is null, or of memory for a `T` that nobody else uses meanwhile.
///
/// # Errors
/// As [`read`].
pub unsafe fn write<T>(pointer: *mut T, value: T, argument: &str) -> Result<(), Failure> {
    check(pointer, argument)?;
    // SAFETY: not null, aligned, and writable by the contract.
    unsafe { pointer.write(value) };
    Ok(())
}

/// An array of the host; null is an empty one.
///
/// # Safety
/// `pointer` is null, or of `count` valid items that nobody changes while the reference is used.
///
/// # Errors
/// [`Failure`] names `argument` where it is misaligned, or null though there should be items.
pub unsafe fn array<'a, T>(pointer: *const T, count: usize, argument: &str) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, argument)?;
    if count.checked_mul(size_of::<T>()).is_none_or(|bytes| bytes > isize::MAX as usize) {
        return Err(Failure::argument(format!("{argument}: {count} items are more than memory holds")));
    }
    // SAFETY: not null, aligned, of a possible size, and valid by the contract.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// Refuses the first handle or pointer that is null, by name.
///
/// # Errors
/// [`Failure`] names it.
pub fn refuse_null<const COUNT: usize>(handles: [(bool, &str); COUNT]) -> Result<(), Failure> {
    match handles.into_iter().find(|(is_null, _)| *is_null) {
        Some((_, name)) => Err(Failure::argument(format!("{name}: is null"))),
        None => Ok(()),
    }
}

/// Refuses a field that has no meaning yet, unless it is 0: so that it can get one.
///
/// # Errors
/// [`Failure`] names it.
pub fn refuse_reserved(reserved: u32, field: &str) -> Result<(), Failure> {
    match reserved {
        0 => Ok(()),
        other => Err(Failure::argument(format!("{field}: {other} must be 0"))),
    }
}

fn check<T>(pointer: *const T, argument: &str) -> Result<(), Failure> {
    refuse_null([(pointer.is_null(), argument)])?;
    if !pointer.is_aligned() {
        return Err(Failure::argument(format!("{argument}: is not aligned to {} bytes", align_of::<T>())));
    }
    Ok(())
}
