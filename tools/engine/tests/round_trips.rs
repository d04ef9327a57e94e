//! What goes in comes out: buffers, images, commands, errors.

use arealight_engine::host::testing::device_or_skip;
use arealight_engine::host::{Host, HostError, HostOptions, ImageDescription, Location, Usage, devices};
use ash::vk;
use std::time::Duration;

/// Numbers that no initialisation makes by chance.
fn numbers(count: usize) -> Vec<f32> {
    (0..count).map(|i| (i as f32 * 0.37).sin() * 1e3).collect()
}

#[test]
fn a_buffer_gives_back_what_was_put_in_wherever_it_is() {
    let Some(host) = device_or_skip() else { return };
    let items = numbers(1000);
    for location in [Location::Device, Location::Upload, Location::Readback] {
        let buffer = host.buffer("numbers", 4000, vk::BufferUsageFlags::STORAGE_BUFFER, location).unwrap();
        buffer.upload(&items).unwrap();
        assert_eq!(buffer.download::<f32>().unwrap(), items, "{location:?}");
        // An upload of fewer items leaves the others.
        buffer.upload(&[7.0_f32]).unwrap();
        let back = buffer.download::<f32>().unwrap();
        assert_eq!((back[0], &back[1..]), (7.0, &items[1..]), "{location:?}");
    }
}

#[test]
fn an_empty_list_still_makes_a_buffer_to_bind() {
    let Some(host) = device_or_skip() else { return };
    let buffer = host.storage_buffer::<f32>("nothing", &[]).unwrap();
    assert_eq!(buffer.size(), 16);
}

#[test]
fn arguments_that_do_not_fit_are_refused_by_name() {
    let Some(host) = device_or_skip() else { return };
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let refused = |error: HostError, part: &str| {
        assert!(matches!(error, HostError::InvalidArgument { .. }), "{error}");
        assert!(error.to_string().contains(part), "{error}");
    };
    refused(host.buffer("empty", 0, usage, Location::Device).unwrap_err(), "empty: a buffer of 0 bytes");
    let buffer = host.buffer("small", 10, usage, Location::Upload).unwrap();
    refused(buffer.upload(&[0.0_f32; 3]).unwrap_err(), "small: 12 bytes do not fit into 10");
    refused(buffer.download::<f32>().unwrap_err(), "small: 10 bytes are not a number of items of 4");
    let mut description = ImageDescription {
        name: "picture",
        extent: [0, 4],
        layers: 1,
        format: vk::Format::R32G32B32A32_SFLOAT,
        usage: vk::ImageUsageFlags::STORAGE,
    };
    refused(host.image(&description).unwrap_err(), "picture: 0×4 texels");
    description.extent = [1 << 30, 4];
    refused(host.image(&description).unwrap_err(), "picture: 1073741824×4 texels, 1 layers: the device has");
    description.extent = [4, 4];
    let image = host.image(&description).unwrap();
    refused(image.upload(&[0.0_f32; 4], Usage::COMPUTE_READ).unwrap_err(), "16 bytes given for 256");
    // Validation has nothing to say: none of these reached Vulkan.
}

#[test]
fn an_image_gives_back_what_was_put_in() {
    let Some(host) = device_or_skip() else { return };
    // Odd sizes, so that a confused row length shows
    for (layers, usage, after) in [
        (1, vk::ImageUsageFlags::STORAGE, Usage::COMPUTE_WRITE),
        (3, vk::ImageUsageFlags::SAMPLED, Usage::COMPUTE_READ),
    ] {
        let image = host
            .image(&ImageDescription {
                name: "picture",
                extent: [13, 7],
                layers,
                format: vk::Format::R32G32B32A32_SFLOAT,
                usage,
            })
            .unwrap();
        let texels = numbers(13 * 7 * 4 * layers as usize);
        image.upload(&texels, after).unwrap();
        assert_eq!(image.download::<f32>(after).unwrap(), texels);
        // Downloading leaves the layout as it was.
        assert_eq!(image.download::<f32>(after).unwrap(), texels);
        assert_ne!(image.view(), vk::ImageView::null());
        assert_ne!(image.array_view(), vk::ImageView::null());
    }
}

#[test]
fn depth_goes_in_and_out() {
    let Some(host) = device_or_skip() else { return };
    let image = host
        .image(&ImageDescription {
            name: "depth",
            extent: [5, 3],
            layers: 1,
            format: vk::Format::D32_SFLOAT,
            usage: vk::ImageUsageFlags::SAMPLED,
        })
        .unwrap();
    let depths: Vec<f32> = (0..15).map(|i| i as f32 / 16.0).collect();
    image.upload(&depths, Usage::COMPUTE_READ).unwrap();
    assert_eq!(image.download::<f32>(Usage::COMPUTE_READ).unwrap(), depths);
}

#[test]
fn a_recording_that_fails_submits_nothing() {
    let Some(host) = device_or_skip() else { return };
    let buffer = host.storage_buffer("kept", &[1_u32; 4]).unwrap();
    let result: Result<(), HostError> = host.try_submit(|commands| {
        // SAFETY: The commands are being recorded, and the buffer can be filled.
        unsafe { host.device().cmd_fill_buffer(commands, buffer.handle(), 0, vk::WHOLE_SIZE, 9) };
        Err(HostError::MissingFeature("patience"))
    });
    assert!(matches!(result, Err(HostError::MissingFeature("patience"))));
    assert_eq!(buffer.download::<u32>().unwrap(), [1; 4]);
}

#[test]
fn commands_are_timed_where_there_are_timestamps() {
    let Some(host) = device_or_skip() else { return };
    let buffer = host.storage_buffer("filled", &vec![0_u32; 1 << 20]).unwrap();
    let time = host
        .try_submit_timed(|commands| {
            // SAFETY: The commands are being recorded, and the buffer can be filled.
            unsafe { host.device().cmd_fill_buffer(commands, buffer.handle(), 0, vk::WHOLE_SIZE, 9) };
            Ok::<_, HostError>(())
        })
        .unwrap();
    assert_eq!(time.is_some(), host.timestamp_valid_bits() > 0);
    // No bound on the time itself: only that it is one, and not garbage.
    assert!(time.is_none_or(|time| time < Duration::from_secs(600)), "{time:?}");
    assert!(buffer.download::<u32>().unwrap().iter().all(|&item| item == 9));
}

#[test]
fn work_that_does_not_finish_is_an_error_and_dropping_everything_is_safe() {
    let Some(tested) = device_or_skip() else { return };
    let options = HostOptions {
        device: Some(tested.device_name()),
        timeout: Duration::from_millis(50),
        ..HostOptions::default()
    };
    let host = Host::new(options).unwrap();
    let buffer = host.storage_buffer("busy", &[1_u32; 4]).unwrap();
    let device = host.device().clone();
    // SAFETY: The device is alive.
    let event = unsafe { device.create_event(&vk::EventCreateInfo::default(), None) }.unwrap();
    // The GPU waits for the CPU, and the CPU for the GPU.
    let waited = host.submit(|commands| {
        let (host_stage, all) = (vk::PipelineStageFlags::HOST, vk::PipelineStageFlags::ALL_COMMANDS);
        // SAFETY: The commands are being recorded, and the event is of this device.
        unsafe { device.cmd_wait_events(commands, &[event], host_stage, all, &[], &[], &[]) };
    });
    assert!(matches!(waited, Err(HostError::TimedOut { .. })), "{waited:?}");
    // From then on it is of no more use, and says so.
    assert!(matches!(host.submit(|_| ()), Err(HostError::TimedOut { .. })));
    drop((buffer, host));
    // SAFETY: What was pending is never destroyed; so the device and its event are still there.
    unsafe { device.set_event(event) }.unwrap();
}

#[test]
fn buffers_may_outlive_the_host_they_came_from() {
    let Some(host) = device_or_skip() else { return };
    let options = HostOptions { device: Some(host.device_name()), ..HostOptions::default() };
    let other = Host::new(options).unwrap();
    let buffer = other.storage_buffer("survivor", &[5_u32]).unwrap();
    drop(other);
    assert_eq!(buffer.download::<u32>().unwrap()[0], 5);
}

#[test]
fn nothing_optional_is_enabled_unless_asked_for() {
    let Some(host) = device_or_skip() else { return };
    assert_eq!(host.enabled_features().robust_buffer_access, vk::FALSE);
    let listed = devices().unwrap().into_iter().find(|one| one.name == host.device_name()).unwrap();
    assert_eq!(listed.lack, None);
    if listed.robust_buffer_access {
        let options = HostOptions {
            device: Some(listed.index.to_string()),
            robust_buffer_access: true,
            ..HostOptions::default()
        };
        let robust = Host::new(options).unwrap();
        assert_eq!(robust.device_name(), host.device_name());
        assert_eq!(robust.enabled_features().robust_buffer_access, vk::TRUE);
    }
}

#[test]
fn a_device_that_is_not_there_is_refused_with_those_that_are() {
    let Some(host) = device_or_skip() else { return };
    let options = HostOptions { device: Some("no such device".to_owned()), ..HostOptions::default() };
    let error = Host::new(options).unwrap_err();
    assert!(matches!(error, HostError::DeviceNotFound { .. }), "{error}");
    assert!(error.to_string().contains(&host.device_name()), "{error}");
}
