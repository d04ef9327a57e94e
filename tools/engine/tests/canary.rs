//! Wrong on purpose: what the validation layer must report, each beside a right twin on which it is silent.
//! Were one of these to pass unseen, the silence of every other GPU test would mean nothing.

mod common;

use arealight_engine::host::testing::{TestHost, device_with};
use arealight_engine::host::{Message, Severity, Usage, Validation};
use ash::vk;
use common::Kernel;

const WRITE: &[u8] = include_bytes!("canary/write.spv");
const READ: &[u8] = include_bytes!("canary/read.spv");
const OUT_OF_BOUNDS: &[u8] = include_bytes!("canary/out_of_bounds.spv");

/// Takes the errors, of which there must be one whose id or text has `part`.
fn expect_error(host: &TestHost, part: &str) {
    let messages = host.take_validation_messages();
    let matches = |message: &Message| {
        message.severity == Severity::Error && (message.id.contains(part) || message.text.contains(part))
    };
    assert!(messages.iter().any(matches), "no error with `{part}` among {messages:#?}");
}

fn make_raw_buffer(host: &TestHost, size: u64) {
    let info = vk::BufferCreateInfo::default().size(size).usage(vk::BufferUsageFlags::STORAGE_BUFFER);
    // SAFETY: The device is alive. A size of 0 is invalid, which is the point; no driver crashes on it.
    unsafe {
        if let Ok(buffer) = host.device().create_buffer(&info, None) {
            host.device().destroy_buffer(buffer, None);
        }
    }
}

#[test]
fn an_invalid_argument_is_reported() {
    let Some(host) = device_with(Validation::Core) else { return };
    make_raw_buffer(&host, 0);
    expect_error(&host, "VUID-VkBufferCreateInfo-size-00912");
    make_raw_buffer(&host, 16);
    assert_eq!(host.validation_messages(), []);
}

#[test]
fn an_object_that_is_never_destroyed_fails_the_test() {
    let Some(host) = device_with(Validation::Core) else { return };
    let info = vk::FenceCreateInfo::default();
    // SAFETY: The device is alive. The fence leaks, which is the point.
    unsafe { host.device().create_fence(&info, None) }.unwrap();
    let dropped = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| drop(host)));
    let panic = dropped.expect_err("the leak was not reported");
    let text = panic.downcast_ref::<String>().cloned().unwrap_or_default();
    assert!(text.contains("the validation layer says") && text.contains("Fence"), "{text}");
}

/// Writes 64 items and reads them in a second dispatch, with or without the barrier between.
fn write_then_read(host: &TestHost, with_barrier: bool) -> Vec<u32> {
    let between = host.storage_buffer("between", &[0_u32; 64]).unwrap();
    let result = host.storage_buffer("result", &[0_u32; 64]).unwrap();
    let write = Kernel::new(host, WRITE, &[&between]);
    let read = Kernel::new(host, READ, &[&between, &result]);
    host.submit(|commands| {
        write.dispatch(commands, 0);
        if with_barrier {
            host.barrier(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_READ);
        }
        read.dispatch(commands, 0);
    })
    .unwrap();
    result.download().unwrap()
}

#[test]
fn a_missing_barrier_between_two_dispatches_is_reported() {
    let Some(host) = device_with(Validation::Synchronization) else { return };
    let expected: Vec<u32> = (0..64).map(|i| i * 2 + 1).collect();
    assert_eq!(write_then_read(&host, true), expected);
    assert_eq!(host.validation_messages(), []);
    write_then_read(&host, false);
    expect_error(&host, "SYNC-HAZARD-READ");
}

/// Without synchronisation validation the same fault goes unseen: it is this mode that finds it.
#[test]
fn core_validation_alone_does_not_see_a_missing_barrier() {
    let Some(host) = device_with(Validation::Core) else { return };
    write_then_read(&host, false);
    assert_eq!(host.validation_messages(), []);
}

#[test]
fn a_store_out_of_bounds_is_reported() {
    let Some(host) = device_with(Validation::GpuAssisted) else { return };
    let buffer = host.storage_buffer("bounded", &[0_u32; 64]).unwrap();
    // Neighbours in the same block of memory take the stray stores; nothing else is there to be hurt.
    let _neighbour = host.storage_buffer("neighbour", &[0_u32; 4096]).unwrap();
    let kernel = Kernel::new(&host, OUT_OF_BOUNDS, &[&buffer]);
    host.submit(|commands| kernel.dispatch(commands, 0)).unwrap();
    assert_eq!(host.validation_messages(), []);
    assert_eq!(buffer.download::<u32>().unwrap(), [1; 64]);
    host.submit(|commands| kernel.dispatch(commands, 256)).unwrap();
    expect_error(&host, "out of bounds");
}
