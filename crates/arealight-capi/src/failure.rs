//! Results, what they mean in words, and panics that stay inside.

use arealight_vk::Error;
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What became of a call. Whatever is not AREALIGHT_RESULT_OK comes with a message: arealight_last_error.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArealightResult {
    /// Done.
    Ok = 0,
    /// An argument is null, out of range, NaN, or of an object that is not alive; the message names it.
    ErrorArgument = 1,
    /// The host was compiled for another version of the library.
    ErrorAbiVersion = 2,
    /// The device or its Vulkan lacks something; the message names it.
    ErrorMissingFeature = 3,
    /// A call of Vulkan failed; the message names it and its result.
    ErrorVulkan = 4,
    /// A light cannot be shaded; the message names it and its field.
    ErrorLight = 5,
    /// The bytes hold no light table, or one of another version.
    ErrorTable = 6,
    /// An array of the host is too small; the size that is needed was written.
    ErrorTooSmall = 7,
    /// A fault of the library, which is worth a report. The object of the call is good only for being
    /// destroyed.
    ErrorInternal = 8,
}

/// A result that is not OK, with its message.
#[derive(Debug)]
pub struct Failure {
    pub result: ArealightResult,
    pub message: String,
}

impl Failure {
    pub fn new(result: ArealightResult, message: impl Into<String>) -> Self {
        Self { result, message: message.into() }
    }

    pub fn argument(message: impl Into<String>) -> Self {
        Self::new(ArealightResult::ErrorArgument, message)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let result = match &error {
            Error::Vulkan { .. } => ArealightResult::ErrorVulkan,
            Error::MissingFeature { .. } => ArealightResult::ErrorMissingFeature,
            Error::Light(_) => ArealightResult::ErrorLight,
            _ => ArealightResult::ErrorArgument,
        };
        Self::new(result, in_words_of_c(&error.to_string()))
    }
}

/// A message of the recorder with the names that the header has.
fn in_words_of_c(message: &str) -> String {
    let names = [
        ("ShadeOptions::MOST_SHADOW_RAYS", "4"),
        ("ShadeOptions::reads", "AREALIGHT_PLANE_* and ArealightResources.planes"),
        ("ShadeOptions::", "ArealightPassOptions."),
        ("ShadowOptions::", "ArealightShadowOptions."),
    ];
    names.into_iter().fold(message.to_owned(), |text, (rust, c)| text.replace(rust, c))
}

impl From<arealight::LightError> for Failure {
    fn from(error: arealight::LightError) -> Self {
        Self::new(ArealightResult::ErrorLight, error.to_string())
    }
}

thread_local! {
    static MESSAGE: RefCell<CString> = RefCell::default();
}

fn remember(message: &str) {
    // A message ends at its first zero byte, as C has it
    let text = message.split('\0').next().unwrap_or_default();
    let text = CString::new(text).unwrap_or_default();
    // The thread's end may have taken the message away; then nobody can read it
    let _ = MESSAGE.try_with(|last| last.replace(text));
}

/// The message of this thread's last failed call, in UTF-8: what is wrong, where, and what to do. Empty where
/// none has. Valid until the next call of this thread that fails.
#[unsafe(no_mangle)]
pub extern "C" fn arealight_last_error() -> *const c_char {
    MESSAGE.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// Runs a call of the host: keeps its message, and its panics.
pub fn call(function: impl FnOnce() -> Result<(), Failure>) -> ArealightResult {
    let failure = match catch_unwind(AssertUnwindSafe(function)) {
        Ok(Ok(())) => return ArealightResult::Ok,
        Ok(Err(failure)) => failure,
        Err(panic) => {
            let said = panic.downcast_ref::<String>().map(String::as_str);
            let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
            Failure::new(ArealightResult::ErrorInternal, format!("a fault of Arealight: {said}"))
        }
    };
    remember(&failure.message);
    failure.result
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    fn last() -> String {
        // SAFETY: the message is this thread's, and lives until the next failure.
        unsafe { CStr::from_ptr(arealight_last_error()) }.to_str().unwrap().to_owned()
    }

    #[test]
    fn messages_have_the_headers_names() {
        let failure = |message: &str| {
            Failure::from(Error::InvalidArgument { field: "offset", message: message.into() }).message
        };
        let text = failure(
            "made without ShadeOptions::rectangle; see ShadeOptions::reads and ShadowOptions::output",
        );
        assert!(
            text.contains(
                "ArealightPassOptions.rectangle; see AREALIGHT_PLANE_* and \
                 ArealightResources.planes and ArealightShadowOptions.output"
            ),
            "{text}"
        );
        assert!(!text.contains("::"), "{text}");
    }

    #[test]
    fn failures_have_messages_and_panics_stay_inside() {
        assert_eq!(last(), "");
        assert_eq!(call(|| Err(Failure::argument("lights: wrong\0rest"))), ArealightResult::ErrorArgument);
        assert_eq!(last(), "lights: wrong");
        assert_eq!(call(|| Ok(())), ArealightResult::Ok);
        assert_eq!(last(), "lights: wrong", "success changes nothing");
        assert_eq!(call(|| panic!("on purpose")), ArealightResult::ErrorInternal);
        assert!(last().contains("on purpose"));
        // Each thread has its own
        assert_eq!(std::thread::spawn(last).join().unwrap(), "");
    }
}
