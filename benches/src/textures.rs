//! What filtering a light's texture costs on a device, as a ratio to a plain chain of mips in the same run.
//!
//! Of a GPU, time is what its timestamps say. Of a software device it is the processor's time, of all its
//! threads: on a shared machine the clock tells who else is there, and more so in the longer run.

use crate::ladder::Spread;
use crate::ladder::timing::quantile;
use crate::table::Table;
use arealight::kernels::Kernel;
use arealight::{PyramidSize, TexturePart};
use arealight_engine::host::{Host, Image, ImageDescription, Usage};
use arealight_engine::{
    BoundSet, EngineError, Passes, SharedPass, SourceImage, SourceTexels, TextureArray, TextureSource,
};
use arealight_vk::Resource;
use ash::vk;
use serde::Serialize;
use std::time::Instant;

/// A level of a chain of mips.
pub static BOX_MIPS: Kernel = Kernel::new("box_mips", include_bytes!("../spirv/box_mips.spv"));

/// The constant of [`BOX_MIPS`]: texels of the level before to a side.
const SIDE: u32 = 0;

/// What was measured at a size.
#[derive(Debug, Clone, Serialize)]
pub struct TextureCost {
    /// Texels a side.
    pub side: u32,
    /// Milliseconds of the mips, and of the pyramid.
    pub milliseconds: [f64; 2],
    /// The rounds' ratios, pyramid to mips.
    pub ratio: Spread,
    /// Bytes of a layer, as a ratio to those of the source in the same format.
    pub memory: f64,
}

/// A chain of mips, of an image a level: the image, then a copy of it, then each half of the one before.
struct Mips {
    levels: Vec<Image>,
    copy: SharedPass,
    halve: SharedPass,
    sets: Vec<BoundSet>,
}

impl Mips {
    fn new(passes: &Passes, texels: &[[f32; 4]], side: u32) -> Result<Self, EngineError> {
        let level = |side: u32, format: vk::Format, usage: vk::ImageUsageFlags| {
            let name = "mip";
            passes.host().image(&ImageDescription { name, extent: [side; 2], layers: 1, format, usage })
        };
        let source = level(side, vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::SAMPLED)?;
        source.upload(texels, Usage::COMPUTE_READ)?;
        let mut levels = vec![source];
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::STORAGE;
        for halvings in 0..=side.ilog2() {
            levels.push(level(side >> halvings, vk::Format::R16G16B16A16_SFLOAT, usage)?);
        }
        passes.host().submit(|commands| {
            for level in &levels[1..] {
                level.transition(commands, Usage::UNDEFINED, Usage::COMPUTE_WRITE);
            }
        })?;

        let [copy, halve] = [1, 2].map(|side| passes.pass(&BOX_MIPS, &[(SIDE, side)]));
        let (copy, halve) = (copy?, halve?);
        let mut sets = vec![];
        for (index, pair) in levels.windows(2).enumerate() {
            let layout =
                if index == 0 { vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL } else { vk::ImageLayout::GENERAL };
            let finer = Resource::SampledImage { view: pair[0].array_view(), layout };
            let coarser = Resource::StorageImage { view: pair[1].array_view() };
            let pass = if index == 0 { &copy } else { &halve };
            // SAFETY: The levels live as long as the sets, and submissions are waited for.
            sets.push(unsafe { passes.bind(pass, &[finer, coarser]) }?);
        }
        Ok(Self { levels, copy, halve, sets })
    }

    fn record(&self, host: &Host, commands: vk::CommandBuffer) -> Result<(), EngineError> {
        for (index, set) in self.sets.iter().enumerate() {
            let pass = if index == 0 { &self.copy } else { &self.halve };
            let [width, height] = self.levels[index + 1].extent();
            // SAFETY: `commands` is being recorded, outside a render pass.
            unsafe { set.record(pass, commands, &(), [width, height, 1]) }?;
            host.barrier(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
        }
        Ok(())
    }
}

/// Measures both on an image of `side` × `side` texels, a power of two, in `rounds` rounds after one that
/// warms up.
///
/// # Panics
/// Where `side` is no size of a light's texture.
pub fn measure(host: &Host, side: u32, rounds: usize) -> Result<TextureCost, EngineError> {
    let passes = Passes::new(host.clone())?;
    let texels: Vec<[f32; 4]> =
        (0..side * side).map(|i| [i % 7, i % 11, i % 13, 1].map(|value| value as f32)).collect();
    let mips = Mips::new(&passes, &texels, side)?;
    let size = PyramidSize::new(side).expect("a size of light textures");
    let array = TextureArray::new(&passes, size, 1)?;
    let image =
        SourceImage { texels: SourceTexels::Linear(&texels), size: [side; 2], part: TexturePart::default() };
    let sources = [array.source(0, &image)?];

    let mut seconds = [vec![], vec![]];
    for round in 0..=rounds {
        let mips = timed(host, |commands| mips.record(host, commands))?;
        let pyramid = timed(host, |commands| record(&array, commands, &sources))?;
        if round > 0 {
            seconds[0].push(mips);
            seconds[1].push(pyramid);
        }
    }
    Ok(TextureCost {
        side,
        milliseconds: [0, 1].map(|i| 1e3 * quantile(&seconds[i], 0.5)),
        ratio: Spread::of_ratios(&seconds[1], &seconds[0]),
        memory: size.texels() as f64 / f64::from(side).powi(2),
    })
}

fn record(
    array: &TextureArray,
    commands: vk::CommandBuffer,
    sources: &[TextureSource],
) -> Result<(), EngineError> {
    // SAFETY: `commands` is being recorded by the host, which waits.
    unsafe { array.record(commands, sources) }
}

/// Whether the device is the processor.
pub(crate) fn is_software(host: &Host) -> bool {
    host.properties().device_type == vk::PhysicalDeviceType::CPU
}

/// Seconds that the device took.
pub(crate) fn timed(
    host: &Host,
    record: impl FnOnce(vk::CommandBuffer) -> Result<(), EngineError>,
) -> Result<f64, EngineError> {
    clocked(host, || host.try_submit_timed(record))
}

/// Seconds of what says how long the device took.
pub(crate) fn clocked<E>(
    host: &Host,
    run: impl FnOnce() -> Result<Option<std::time::Duration>, E>,
) -> Result<f64, E> {
    let start = (Instant::now(), processor_seconds());
    let took = run()?;
    Ok(match (start.1, processor_seconds()) {
        (Some(before), Some(after)) if is_software(host) => after - before,
        _ => took.unwrap_or_else(|| start.0.elapsed()).as_secs_f64(),
    })
}

/// Seconds that this process's threads have run, to the nanosecond; `None` where the system does not tell.
fn processor_seconds() -> Option<f64> {
    let nanoseconds = |thread: std::fs::DirEntry| -> Option<u64> {
        std::fs::read_to_string(thread.path().join("schedstat")).ok()?.split(' ').next()?.parse().ok()
    };
    let threads = std::fs::read_dir("/proc/self/task").ok()?;
    let total: Option<u64> = threads.map(|thread| nanoseconds(thread.ok()?)).sum();
    Some(total? as f64 * 1e-9)
}

/// The costs as a Markdown table.
pub fn markdown(costs: &[TextureCost]) -> String {
    let row = |cost: &TextureCost| {
        let [mips, pyramid] = cost.milliseconds.map(|time| time * 1e6 / f64::from(cost.side).powi(2));
        let ([ratio, quartiles], side) = (cost.ratio.cells(), cost.side);
        let size = format!("{side} x {side}");
        vec![
            size,
            format!("{mips:.1}"),
            format!("{pyramid:.1}"),
            ratio,
            quartiles,
            format!("{:.2}", cost.memory),
        ]
    };
    let heads = "texels | plain mips, ms per megapixel | pyramid | time, mips = 1 | quartiles | \
        memory, source = 1";
    Table::new(heads, costs.iter().map(row)).to_markdown()
}
