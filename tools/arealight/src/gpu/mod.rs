//! The commands' way to a device.

pub mod eval;

use crate::failure::Failure;
use crate::progress;
use arealight::LightTable;
use arealight_engine::{Engine, EngineError, Host, HostOptions};
use ash::vk;
use std::path::Path;

/// Which device a command runs on.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Device")]
pub struct DeviceArgument {
    /// The Vulkan device: a part of its name, or its number, as `arealight devices` lists them.
    #[arg(long, value_name = "NAME|NUMBER")]
    pub device: Option<String>,
}

/// The device of that name, or the best one.
pub fn host(device: Option<&str>) -> Result<Host, Failure> {
    let options = HostOptions { device: device.map(str::to_owned), ..HostOptions::default() };
    let host = Host::new(options).map_err(|error| Failure::Device(error.to_string()))?;
    progress::say(|| {
        let properties = host.properties();
        let [major, minor] =
            [vk::api_version_major, vk::api_version_minor].map(|part| part(properties.api_version));
        let kind = properties.device_type;
        format!("device: {}, {kind:?}, Vulkan {major}.{minor}", host.device_name())
    });
    Ok(host)
}

/// An engine on the device of that name, or on the best one.
pub fn engine(device: Option<&str>, table: &LightTable) -> Result<Engine, Failure> {
    let host = host(device)?;
    let (size, format) = (table.size(), arealight_vk::TableFormat::default());
    progress::say(|| format!("table: {}, {size} x {size}, {format:?}", table.description().brdf));
    Engine::new(host, table, format).map_err(|error| Failure::Device(error.to_string()))
}

/// An engine that is made when the first case needs it: without work no device is needed.
pub struct LazyEngine<'a> {
    table: &'a LightTable,
    device: Option<&'a str>,
    engine: Option<Engine>,
}

impl<'a> LazyEngine<'a> {
    /// Makes nothing yet.
    pub fn new(device: Option<&'a str>, table: &'a LightTable) -> Self {
        Self { table, device, engine: None }
    }

    /// The engine, the same each time.
    pub fn get(&mut self) -> Result<&mut Engine, Failure> {
        let made = match self.engine.take() {
            Some(engine) => engine,
            None => engine(self.device, self.table)?,
        };
        Ok(self.engine.insert(made))
    }
}

/// An error of the engine as a command reports it: a light of the input that cannot be shaded is the input's
/// fault, all else the device's.
pub fn failure(error: EngineError, input: &Path) -> Failure {
    match error {
        EngineError::Recorder(arealight_vk::Error::Light(error)) => Failure::input(input, error),
        error @ (EngineError::BufferTooLarge { .. } | EngineError::Scene(_)) => Failure::input(input, error),
        error => Failure::Device(error.to_string()),
    }
}
