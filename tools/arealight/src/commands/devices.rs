//! `arealight devices`

use crate::failure::Failure;
use crate::output::print;
use arealight::kernels::{self, BindingKind, Kernel};
use arealight_engine::host::{DeviceSummary, HostError, devices};
use ash::vk::PhysicalDeviceLimits;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::process::ExitCode;

/// List the Vulkan devices here, and what of them would be used.
#[derive(clap::Args)]
pub struct Arguments {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let found = devices().map_err(|error| Failure::Device(error.to_string()))?;
    let text = if arguments.json {
        format!("{:#}\n", Value::Array(found.iter().map(to_json).collect()))
    } else {
        found.iter().map(|device| to_text(device) + "\n").collect()
    };
    let printed = print(&text)?;
    if found.iter().any(|device| device.lack.is_none()) {
        return Ok(printed);
    }
    let describe =
        |one: &DeviceSummary| format!("{} ({})", one.name, one.lack.as_deref().unwrap_or_default());
    Err(Failure::Device(HostError::NoDevice { found: found.iter().map(describe).collect() }.to_string()))
}

/// A limit of Vulkan: what the kernels need of it, and what the device has.
struct Limit {
    name: &'static str,
    needed: u32,
    offered: u32,
}

/// The limits that the kernels come near, by what the kernels' manifest says.
fn limits(device: &PhysicalDeviceLimits) -> [Limit; 5] {
    let all = || kernels::ALL.into_iter().chain(arealight_tool_kernels::kernels::ALL);
    let most = |kinds: &[BindingKind]| {
        let count =
            |kernel: &Kernel| kernel.bindings().iter().filter(|one| kinds.contains(&one.kind)).count();
        all().map(count).max().unwrap_or(0) as u32
    };
    let group = all().map(|kernel| kernel.local_size().iter().product()).max();
    let constants = all().map(Kernel::push_constant_size).max();
    let limit = |name, needed, offered| Limit { name, needed, offered };
    [
        limit(
            "maxComputeWorkGroupInvocations",
            group.unwrap_or(0),
            device.max_compute_work_group_invocations,
        ),
        limit("maxPushConstantsSize", constants.unwrap_or(0), device.max_push_constants_size),
        limit(
            "maxPerStageDescriptorSampledImages",
            most(&[BindingKind::SampledImage, BindingKind::FilteredImage]),
            device.max_per_stage_descriptor_sampled_images,
        ),
        limit(
            "maxPerStageDescriptorStorageImages",
            most(&[BindingKind::StorageImage]),
            device.max_per_stage_descriptor_storage_images,
        ),
        limit(
            "maxPerStageDescriptorStorageBuffers",
            most(&[BindingKind::StorageBuffer]),
            device.max_per_stage_descriptor_storage_buffers,
        ),
    ]
}

fn to_text(device: &DeviceSummary) -> String {
    let state = match &device.lack {
        Some(lack) => format!("cannot be used: {lack}"),
        None if device.is_default => "used unless --device says otherwise".to_owned(),
        None => format!("used with --device {}", device.index),
    };
    let timestamps = if device.timestamp_valid_bits == 0 {
        "none: GPU times are not reported".to_owned()
    } else {
        let (bits, period) = (device.timestamp_valid_bits, device.limits.timestamp_period);
        format!("{bits} bits of {period} ns: GPU times are reported")
    };
    let limits: Vec<String> = limits(&device.limits)
        .iter()
        .map(|limit| {
            let enough = if limit.offered < limit.needed { ", TOO SMALL" } else { "" };
            format!("{} {} (needed: {}{enough})", limit.name, limit.offered, limit.needed)
        })
        .collect();
    let mut text = String::new();
    let mut line = |name: &str, value: &str| _ = writeln!(text, "   {name:<11} {value}");
    line("kind", &device.kind.to_string());
    line("driver", &device.driver);
    line("Vulkan", &device.api_version);
    line("queue", &format!("family {}", device.queue_family));
    line("timestamps", &timestamps);
    line("features", "none optional: compute of Vulkan 1.1");
    line("buffers", &format!("up to {} bytes", device.limits.max_storage_buffer_range));
    line(
        "images",
        &format!(
            "up to {} texels a side, {} layers",
            device.limits.max_image_dimension2_d, device.limits.max_image_array_layers
        ),
    );
    line("limits", &limits.join("\n               "));
    format!("{}: {}: {state}\n{text}", device.index, device.name)
}

fn to_json(device: &DeviceSummary) -> Value {
    let limits: Vec<Value> = limits(&device.limits)
        .iter()
        .map(|limit| json!({ "name": limit.name, "needed": limit.needed, "offered": limit.offered }))
        .collect();
    json!({
        "index": device.index,
        "name": device.name,
        "kind": device.kind.to_string(),
        "driver": device.driver,
        "api_version": device.api_version,
        "default": device.is_default,
        "usable": device.lack.is_none(),
        "lack": device.lack,
        "queue_family": device.queue_family,
        "timestamp_valid_bits": device.timestamp_valid_bits,
        "timestamp_period_ns": device.limits.timestamp_period,
        "optional_features_used": [],
        "max_storage_buffer_range": device.limits.max_storage_buffer_range,
        "max_image_dimension_2d": device.limits.max_image_dimension2_d,
        "max_image_array_layers": device.limits.max_image_array_layers,
        "limits": limits,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_engine::host::DeviceKind;

    fn device(invocations: u32) -> DeviceSummary {
        DeviceSummary {
            index: 3,
            name: "Example".to_owned(),
            kind: DeviceKind::Discrete,
            driver: "driver 1".to_owned(),
            api_version: "1.3.0".to_owned(),
            is_default: false,
            lack: None,
            queue_family: 2,
            timestamp_valid_bits: 0,
            robust_buffer_access: true,
            limits: PhysicalDeviceLimits {
                max_compute_work_group_invocations: invocations,
                ..PhysicalDeviceLimits::default()
            },
        }
    }

    #[test]
    fn the_text_says_how_to_take_the_device_and_what_it_lacks() {
        let text = to_text(&device(64));
        assert!(text.starts_with("3: Example: used with --device 3\n"), "{text}");
        assert!(text.contains("none: GPU times are not reported"), "{text}");
        assert!(text.contains("maxComputeWorkGroupInvocations 64 (needed: 64)"), "{text}");
        let text = to_text(&device(63));
        assert!(text.contains("maxComputeWorkGroupInvocations 63 (needed: 64, TOO SMALL)"), "{text}");
        let text = to_text(&DeviceSummary { lack: Some("only Vulkan 1.0".to_owned()), ..device(64) });
        assert!(text.starts_with("3: Example: cannot be used: only Vulkan 1.0\n"), "{text}");
    }

    #[test]
    fn the_json_has_what_a_script_asks_for() {
        let value = to_json(&device(64));
        assert_eq!(value["usable"], true);
        assert_eq!(value["default"], false);
        assert_eq!(
            value["limits"][0],
            json!({
                "name": "maxComputeWorkGroupInvocations", "needed": 64, "offered": 64,
            })
        );
    }
}
