//! A loader without a driver: an error that says what to install, and no crash.

use arealight_engine::host::testing::device_or_skip;
use arealight_engine::host::{Host, HostError, HostOptions, devices};
use std::process::Command;

const MARK: &str = "AREALIGHT_TEST_WITHOUT_DRIVER";

#[test]
fn without_a_driver_the_error_says_what_to_install() {
    // The loader reads these variables, so another process must have them from its start.
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "the_child_without_a_driver", "--nocapture"])
        .env(MARK, "1")
        .env("VK_ICD_FILENAMES", "/nonexistent.json")
        .env("VK_DRIVER_FILES", "/nonexistent.json")
        .env_remove("AREALIGHT_REQUIRE_GPU")
        .env_remove("AREALIGHT_GPU_TEST_LOG")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stdout) + String::from_utf8_lossy(&child.stderr);
    assert!(child.status.success(), "{said}");
    assert!(said.contains("skipped: no Vulkan device"), "{said}");
}

#[test]
fn the_child_without_a_driver() {
    if std::env::var_os(MARK).is_none() {
        return; // The test above runs this one in another process.
    }
    let error = Host::new(HostOptions::default()).unwrap_err();
    assert!(matches!(error, HostError::NoDevice { .. } | HostError::LoaderMissing(_)), "{error}");
    assert!(error.to_string().contains("apt-get install"), "{error}");
    assert!(devices().map_or(true, |found| found.is_empty()));
    assert!(device_or_skip().is_none());
}
