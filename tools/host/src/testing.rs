//! For the tests of the whole workspace: a device, or a skip that shows.
//!
//! A suite that returns early without a device proves nothing, so:
//! - with `AREALIGHT_REQUIRE_GPU=1` a missing device or validation layer fails the test;
//! - without, the test says `skipped: …`;
//! - where `AREALIGHT_GPU_TEST_LOG` names a file, each test appends a line to it, `ran …` or `skipped …`, so
//!   that a script can list those and insist on how many ran;
//! - what the validation layer says fails the test when the [`TestHost`] is dropped.
//!
//! `AREALIGHT_DEVICE` chooses the device, and `AREALIGHT_VALIDATION` (`off`, `core`, `synchronization` or
//! `gpu-assisted`) what is validated; synchronisation by default.

use crate::device::{Host, HostOptions};
use crate::error::HostError;
use crate::families::Driver;
use crate::validation::{Message, MessageLog, Validation};
use std::io::Write as _;
use std::sync::Arc;

/// A host that fails the test when the validation layer has said anything by the time it is dropped.
pub struct TestHost {
    /// `None` only while it is being dropped.
    host: Option<Host>,
    log: Arc<MessageLog>,
}

impl std::ops::Deref for TestHost {
    type Target = Host;

    fn deref(&self) -> &Host {
        let Some(host) = self.host.as_ref() else { unreachable!("the host is taken only by drop") };
        host
    }
}

impl Drop for TestHost {
    fn drop(&mut self) {
        // Let the device go first, so that the layer reports what was never destroyed.
        self.host = None;
        let messages = self.log.take();
        if !std::thread::panicking() {
            assert_silent(&messages);
        }
    }
}

/// A device for a test, validated as `AREALIGHT_VALIDATION` says. `None` where there is none: return then.
///
/// # Panics
/// Where `AREALIGHT_REQUIRE_GPU=1` and the device or the validation layer is missing; where Vulkan fails in
/// another way; where a variable has no known value.
pub fn device_or_skip() -> Option<TestHost> {
    device_with(validation_asked_for())
}

/// As [`device_or_skip`], with the queue and the version of Vulkan of these options.
pub fn device_of(options: &HostOptions) -> Option<TestHost> {
    let HostOptions { queue, newest_version, .. } = *options;
    let options = HostOptions { queue, newest_version, ..test_options(validation_asked_for()) };
    let host = made_or_skip(Host::new(options))?;
    Some(TestHost { log: host.message_log(), host: Some(host) })
}

fn validation_asked_for() -> Validation {
    match std::env::var("AREALIGHT_VALIDATION").as_deref() {
        Err(_) | Ok("synchronization") => Validation::Synchronization,
        Ok("core") => Validation::Core,
        Ok("gpu-assisted") => Validation::GpuAssisted,
        Ok("off") => Validation::Off,
        Ok(other) => {
            panic!("AREALIGHT_VALIDATION={other}: must be off, core, synchronization or gpu-assisted")
        }
    }
}

/// As [`device_or_skip`], validated in a way that the test insists on.
pub fn device_with(validation: Validation) -> Option<TestHost> {
    let host = made_or_skip(Host::new(test_options(validation)))?;
    Some(TestHost { log: host.message_log(), host: Some(host) })
}

/// As [`device_or_skip`], with `VK_KHR_push_descriptor`. None where the device has none, too.
pub fn device_with_push_descriptors() -> Option<TestHost> {
    let options = HostOptions { push_descriptors: true, ..test_options(validation_asked_for()) };
    let made = Host::new(options);
    if let Err(HostError::MissingFeature(feature)) = made {
        println!("skipped: the device has no {feature}");
        record("skipped");
        return None;
    }
    let host = made_or_skip(made)?;
    Some(TestHost { log: host.message_log(), host: Some(host) })
}

fn test_options(validation: Validation) -> HostOptions {
    HostOptions { device: std::env::var("AREALIGHT_DEVICE").ok(), validation, ..HostOptions::default() }
}

/// The driver whose compiler a test asks, for Navi 21 ([`crate::null_hardware`]). `None` where it is not
/// installed: return then. A test that runs says so by [`ran`].
///
/// # Panics
/// Where `AREALIGHT_REQUIRE_GPU=1` and it is missing.
pub fn radv_or_skip() -> Option<Driver> {
    Driver::of("navi21").map_err(|lack| skip(&lack.to_string())).ok()
}

/// Notes that a test had the driver that it needs.
pub fn ran() {
    record("ran");
}

/// Notes that a test had not.
///
/// # Panics
/// Where `AREALIGHT_REQUIRE_GPU=1`.
pub fn skip(reason: &str) {
    let required = std::env::var("AREALIGHT_REQUIRE_GPU").is_ok_and(|value| value == "1");
    assert!(!required, "AREALIGHT_REQUIRE_GPU=1, and: {reason}");
    println!("skipped: {reason}");
    record("skipped");
}

/// What was made, and a line in the log; `None` where there is no device and none is required.
fn made_or_skip<T>(made: Result<T, HostError>) -> Option<T> {
    match made {
        Ok(made) => {
            ran();
            Some(made)
        }
        Err(error @ (HostError::LoaderMissing(_) | HostError::NoDevice { .. })) => {
            skip(&format!("no Vulkan device ({error})"));
            None
        }
        Err(error @ HostError::ValidationLayerMissing) => {
            skip(&error.to_string());
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Fails with every message, unless there is none.
///
/// # Panics
/// Where there is a message.
pub fn assert_silent(messages: &[Message]) {
    let lines: Vec<_> = messages.iter().map(ToString::to_string).collect();
    assert!(lines.is_empty(), "the validation layer says:\n{}", lines.join("\n"));
}

/// Appends what became of the test to the log that `AREALIGHT_GPU_TEST_LOG` names.
fn record(outcome: &str) {
    let Some(path) = std::env::var_os("AREALIGHT_GPU_TEST_LOG") else { return };
    let binary = std::env::current_exe().ok();
    let binary = binary.as_deref().and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy();
    let name = std::env::var("NEXTEST_TEST_NAME")
        .unwrap_or_else(|_| std::thread::current().name().unwrap_or("unnamed").to_owned());
    let line = format!("{outcome} {binary} {name}\n");
    let file = std::fs::OpenOptions::new().create(true).append(true).open(&path);
    let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
    assert!(written.is_ok(), "AREALIGHT_GPU_TEST_LOG={}: {written:?}", path.display());
}
