//! Results, what they mean in words, and panics that stay inside.

use arealight::LightFault;
use arealight_vk::Error;
use std::cell::Cell;
use std::ffi::c_char;
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
        ("ShadePassInfo::descriptors", "ArealightPassOptions.descriptors"),
        ("Descriptors::LightOffsets", "AREALIGHT_DESCRIPTORS_LIGHT_OFFSETS"),
        ("Bound::Pushed", "arealight_pass_record_pushed"),
        ("ShadeOptions::reads", "AREALIGHT_PLANE_* and ArealightResources.planes"),
        ("ShadeOptions::", "ArealightPassOptions."),
        ("ShadowOptions::", "ArealightShadowOptions."),
        ("MediumOptions::", "ArealightMediumOptions."),
        ("gpu_allocator::Allocator::allocate", "vkAllocateMemory"),
    ];
    names.into_iter().fold(message.to_owned(), |text, (rust, c)| text.replace(rust, c))
}

impl From<arealight::LightError> for Failure {
    fn from(error: arealight::LightError) -> Self {
        // A tube is by its middle in C, a mesh's faces by their counts
        let text = error.to_string();
        let text = match &error.fault {
            LightFault::NoAxis { .. } => text.replace("p0 and p1:", "axis_u: is zero:"),
            _ => text.replace(": faces", ": face_vertex_counts"),
        };
        Self::new(ArealightResult::ErrorLight, text)
    }
}

/// The most bytes of a message, with the zero at its end.
const LONGEST: usize = 4096;

thread_local! {
    /// One place a thread: it stays where it is, whatever is written into it.
    static MESSAGE: [Cell<u8>; LONGEST] = const { [const { Cell::new(0) }; LONGEST] };
}

fn remember(message: &str) {
    // A message ends at its first zero byte, as C has it, or where there is no more room
    let text = message.split('\0').next().unwrap_or_default();
    let end = (0..=text.len().min(LONGEST - 1)).rfind(|end| text.is_char_boundary(*end));
    let text = &text[..end.unwrap_or_default()];
    // The thread's end may have taken the message away; then nobody can read it
    let _ = MESSAGE.try_with(|last| {
        for (place, byte) in last.iter().zip(text.bytes().chain([0])) {
            place.set(byte);
        }
    });
}

/// The message of this thread's last failed call, in UTF-8: what is wrong, where, and what to do. Empty where
/// none has. At most 4,095 bytes, in a buffer that the thread keeps until it ends: the next call of this
/// thread that fails writes its own message there.
#[unsafe(no_mangle)]
pub extern "C" fn arealight_last_error() -> *const c_char {
    MESSAGE.try_with(|last| last.as_ptr().cast()).unwrap_or(c"".as_ptr())
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
    fn no_text_of_the_recorder_has_a_name_of_rust() {
        let sources = concat!(env!("CARGO_MANIFEST_DIR"), "/../arealight-vk/src");
        let (mut folders, mut named) = (vec![std::path::PathBuf::from(sources)], 0);
        while let Some(folder) = folders.pop() {
            for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let text = std::fs::read_to_string(&path).unwrap().replace("\\\"", "");
                    let code: Vec<&str> =
                        text.lines().filter(|l| !l.trim_start().starts_with("//")).collect();
                    for text in code.join("\n").split('"').skip(1).step_by(2) {
                        named += usize::from(text.contains("::"));
                        let said = in_words_of_c(text);
                        assert!(!said.contains("::"), "{}: {said}", path.display());
                    }
                }
            }
        }
        assert!(named > 5, "{named} texts have names");
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
        // What C evaluates from the right is the message of the call on the left
        let before = arealight_last_error();
        assert_eq!(call(|| Err(Failure::argument("é".repeat(5000)))), ArealightResult::ErrorArgument);
        assert_eq!((before, last()), (arealight_last_error(), "é".repeat(2047)));
        // Each thread has its own
        assert_eq!(std::thread::spawn(last).join().unwrap(), "");
    }
}
