//! What the GPU tests share: an engine that is validated, random shading points, and a comparison that
//! counts what it compared.

#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // what the types say

pub mod c_library;
mod cases;
mod compare;
pub mod floor;
pub mod frame;
pub mod globe;
pub mod kernel;
mod levels;
pub mod lobe;
pub mod materials;
pub mod multisampled;
pub mod one_pixel;
pub mod pass;
mod points;
pub mod prelude;
mod property;
pub mod scenes;
pub mod shadow_patch;
pub mod shapes;
pub mod spirv;

pub use cases::Cases;
pub use compare::{Comparison, rounding};
pub use levels::{Level, Path};
pub use points::{Numbers, Random, glossy_surface, lambert_surface, point};
pub use property::Property;

use arealight_engine::host::testing::TestHost;
use arealight_engine::{Engine, Host};
use arealight_vk::TableFormat;
use ash::vk::PhysicalDeviceType;

/// A device with the built-in table. Fields go in this order, so that the host hears what was left behind.
pub struct TestEngine {
    engine: Engine,
    host: TestHost,
}

impl std::ops::Deref for TestEngine {
    type Target = Engine;

    fn deref(&self) -> &Engine {
        &self.engine
    }
}

impl std::ops::DerefMut for TestEngine {
    fn deref_mut(&mut self) -> &mut Engine {
        &mut self.engine
    }
}

/// Whether a device rounds each operation once, to the nearest, as drivers that run on the processor do.
/// Others may contract a product and a sum, each piece of code in its own way, and their divisions and roots
/// are up to five units off.
pub fn rounds_as_oracle(host: &Host) -> bool {
    host.properties().device_type == PhysicalDeviceType::CPU
}

impl TestEngine {
    /// The engine on a validated device; `None` where there is no device and none is required.
    pub fn new() -> Option<Self> {
        Self::with_format(TableFormat::default())
    }

    /// As the function [`rounds_as_oracle`].
    pub fn rounds_as_oracle(&self) -> bool {
        rounds_as_oracle(self.host())
    }

    /// How far the same sums may differ by other code around them, over the brightest: nothing where each
    /// operation has one result, else the error of a form factor.
    pub fn rounding(&self) -> f32 {
        if self.rounds_as_oracle() { 0.0 } else { 1e-6 }
    }

    /// As [`TestEngine::new`], with the table in another format.
    pub fn with_format(format: TableFormat) -> Option<Self> {
        Some(Self::of_host(arealight_engine::host::testing::device_or_skip()?, format))
    }

    /// As [`TestEngine::new`], on a device with `VK_KHR_push_descriptor`; `None` where it has none, too.
    pub fn with_push_descriptors() -> Option<Self> {
        let host = arealight_engine::host::testing::device_with_push_descriptors()?;
        Some(Self::of_host(host, TableFormat::default()))
    }

    fn of_host(host: TestHost, format: TableFormat) -> Self {
        let engine =
            Engine::new((*host).clone(), &arealight::LightTable::ggx(), format).expect("the table uploads");
        Self { engine, host }
    }

    /// As [`TestEngine::new`], with modules handed to the driver as they are.
    pub fn with_whole_modules() -> Option<Self> {
        let Self { engine, host } = Self::new()?;
        Some(Self { engine: engine.with_whole_modules(), host })
    }
}
