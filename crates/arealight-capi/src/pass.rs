//! The shade pass.

use crate::device::Arealight;
use crate::failure::{ArealightResult, Failure, call};
use crate::lights::read_summary;
use crate::options::{level, shade_options, tile_options};
use crate::types::{
    ArealightBuffer, ArealightFrame, ArealightImage, ArealightModule, ArealightPassOptions,
    ArealightResources, ArealightSetLayout, ArealightTileMemory, ArealightViewport,
};
use crate::{arguments, handles};
use arealight::{Plane, Planes};
use arealight_vk::ash::vk::{self, Handle as _};
use arealight_vk::{
    BlockerResources, Bound, Descriptors, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources,
    StencilTest, Viewport,
};
use glam::{Mat4, Vec3};
use std::ffi::c_void;

/// A shade pass, specialised for surfaces and a quality.
pub struct ArealightPass {
    pub(crate) pass: ShadePass,
}

/// Makes a pass. Its pipelines are made when the first frame is recorded whose lights need them, or ahead by
/// arealight_pass_prepare. `*out` is the host's to destroy.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_create(
    arealight: *const Arealight,
    options: *const ArealightPassOptions,
    out: *mut *mut ArealightPass,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers and the module, and says that its device has the extension.
    call(|| unsafe {
        arguments::write(out, std::ptr::null_mut(), "out")?;
        let arealight = handles::borrow(arealight, "arealight")?;
        let options = arguments::read(options, "options")?;
        let ways = [Descriptors::Sets, Descriptors::LightOffsets, Descriptors::Pushed];
        let descriptors = level(options.descriptors, &ways, "options.descriptors")?;
        let (module, host_set) = host_module(&options.module)?;
        let tiles = tile_options(options);
        if tiles.is_some() && module.is_some() {
            let why = "must be 0, since tiles are not classified by a G-buffer of the host's own";
            return Err(Failure::argument(format!("options.tile_capacity: {why}")));
        }
        let table_size = arealight.table_size();
        let options = shade_options(options)?.into();
        let info = ShadePassInfo { tiles, table_size, descriptors, module, host_set, ..options };
        let pass = ShadePass::new(arealight.context(), info)?;
        arguments::write(out, handles::give(ArealightPass { pass }), "out")
    })
}

/// A module of the host's, if it has one, and the layout of set 1.
pub(crate) type HostModule = (Option<Vec<u32>>, Option<vk::DescriptorSetLayout>);

/// What was given of a module.
///
/// # Safety
/// The pointer is null or valid.
pub(crate) unsafe fn host_module(module: &ArealightModule) -> Result<HostModule, Failure> {
    let ArealightModule { words, size, host_set_layout } = *module;
    if words.is_null() && size == 0 {
        return Ok(HostModule::default());
    }
    if !size.is_multiple_of(4) {
        return Err(Failure::argument(format!("module.size: {size} bytes are no whole words of SPIR-V")));
    }
    // SAFETY: the same contract.
    let words = unsafe { arguments::array(words, size / 4, "module.words") }?.to_vec();
    let layout = (host_set_layout != 0).then(|| vk::DescriptorSetLayout::from_raw(host_set_layout));
    Ok((Some(words), layout))
}

/// What descriptor sets of the pass are made with.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_set_layout(
    pass: *const ArealightPass,
    out: *mut ArealightSetLayout,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        arguments::write(out, set_layout(pass.set_layout(), &pass.pool_sizes(1)), "out")
    })
}

/// A layout with what a set of it takes from its pool.
pub(crate) fn set_layout(
    layout: vk::DescriptorSetLayout,
    sizes: &[vk::DescriptorPoolSize],
) -> ArealightSetLayout {
    let count = |kind| sizes.iter().find(|size| size.ty == kind).map_or(0, |size| size.descriptor_count);
    ArealightSetLayout {
        layout: layout.as_raw(),
        sampled_images: count(vk::DescriptorType::SAMPLED_IMAGE),
        combined_image_samplers: count(vk::DescriptorType::COMBINED_IMAGE_SAMPLER),
        storage_images: count(vk::DescriptorType::STORAGE_IMAGE),
        storage_buffers: count(vk::DescriptorType::STORAGE_BUFFER),
        dynamic_storage_buffers: count(vk::DescriptorType::STORAGE_BUFFER_DYNAMIC),
        reserved: 0,
    }
}

/// Points a VkDescriptorSet, made with arealight_pass_set_layout, at resources; `arealight` is the one with
/// the table, which was uploaded.
///
/// # Safety
/// Pointers are null or valid. No pending commands use the set, and the resources outlive those that will.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_write_set(
    pass: *const ArealightPass,
    arealight: *const Arealight,
    set: u64,
    resources: *const ArealightResources,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the set and the resources.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        let arealight = handles::borrow(arealight, "arealight")?;
        arguments::refuse_null([(set == 0, "set")])?;
        let resources = resources_of(pass, arealight, resources)?;
        Ok(pass.write_set(vk::DescriptorSet::from_raw(set), &resources)?)
    })
}

/// The host's resources of a pass.
///
/// # Safety
/// `resources` is null or valid.
unsafe fn resources_of(
    pass: &ShadePass,
    arealight: &Arealight,
    resources: *const ArealightResources,
) -> Result<ShadeResources, Failure> {
    // SAFETY: the same contract.
    let resources = unsafe { arguments::read(resources, "resources") }?;
    Ok(ShadeResources {
        lobe_horizons: pass.tiles().map(|_| buffer(resources.lobe_horizons)),
        tile_lists: pass.tiles().map(|_| buffer(resources.tile_lists)),
        ..read_resources(arealight.table_resource()?, resources)?
    })
}

/// The host's resources but those of tiles.
pub(crate) fn read_resources(
    table: Resource,
    resources: &ArealightResources,
) -> Result<ShadeResources, Failure> {
    let planes = Plane::ALL.map(|plane| (resources.planes[plane as usize], plane.name()));
    for (image, field) in planes.into_iter().chain([
        (resources.light_textures, "light_textures"),
        (resources.radiance, "radiance"),
        (resources.glossy, "glossy"),
    ]) {
        arguments::refuse_reserved(image.reserved, &format!("resources.{field}.reserved"))?;
    }
    Ok(ShadeResources {
        table,
        lights: buffer(resources.lights),
        light_vertices: buffer(resources.light_vertices),
        shapes: given(resources.shapes),
        light_textures: (resources.light_textures.view != 0).then(|| filtered(resources.light_textures)),
        planes: Planes::from_fn(|plane| {
            let image = resources.planes[plane as usize];
            (image.view != 0).then(|| sampled(image))
        }),
        radiance: stored(resources.radiance),
        glossy: (resources.glossy.view != 0).then(|| stored(resources.glossy)),
        light_counts: given(resources.light_counts),
        picks: given(resources.shadow_picks),
        ..ShadeResources::default()
    })
}

pub(crate) fn sampled(image: ArealightImage) -> Resource {
    let layout = vk::ImageLayout::from_raw(image.layout.cast_signed());
    Resource::SampledImage { view: vk::ImageView::from_raw(image.view), layout }
}

pub(crate) fn stored(image: ArealightImage) -> Resource {
    Resource::StorageImage { view: vk::ImageView::from_raw(image.view) }
}

fn filtered(image: ArealightImage) -> Resource {
    let layout = vk::ImageLayout::from_raw(image.layout.cast_signed());
    Resource::FilteredImage { view: vk::ImageView::from_raw(image.view), layout }
}

fn buffer(buffer: ArealightBuffer) -> Resource {
    let ArealightBuffer { buffer, offset, range } = buffer;
    Resource::StorageBuffer { buffer: vk::Buffer::from_raw(buffer), offset, range }
}

/// A hierarchy's two buffers, unless one is 0.
pub(crate) fn blockers(nodes: ArealightBuffer, triangles: ArealightBuffer) -> Option<BlockerResources> {
    given(nodes).zip(given(triangles)).map(|(nodes, triangles)| BlockerResources { nodes, triangles })
}

/// A buffer that may be 0.
pub(crate) fn given(range: ArealightBuffer) -> Option<Resource> {
    (range.buffer != 0).then(|| buffer(range))
}

/// A command buffer and its sets. The host's may be 0.
pub(crate) fn bound(
    command_buffer: *mut c_void,
    set: u64,
    host_set: u64,
) -> Result<(vk::CommandBuffer, Bound<'static>), Failure> {
    arguments::refuse_null([(command_buffer.is_null(), "command_buffer"), (set == 0, "set")])?;
    let sets = [set, host_set].map(vk::DescriptorSet::from_raw);
    let bound = if host_set == 0 { Bound::Set(sets[0]) } else { Bound::Sets(sets) };
    Ok((vk::CommandBuffer::from_raw(command_buffer as u64), bound))
}

/// What the buffer of the lists of tiles needs, for radiance images of `width` x `height` pixels.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_tile_memory(
    pass: *const ArealightPass,
    width: u32,
    height: u32,
    out: *mut ArealightTileMemory,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let needed = handles::borrow(pass, "pass")?.pass.tile_memory([width, height]);
        let (size, usage) = needed.map_or((0, 0), |needed| (needed.size, needed.usage.as_raw()));
        arguments::write(out, ArealightTileMemory { size, usage, reserved: 0 }, "out")
    })
}

/// Records the pass into a VkCommandBuffer: binding, push constants, one dispatch; with tiles, what begins
/// their lists, a dispatch that classifies them, one for each class, and the barriers between. Barriers
/// before and after are the host's.
///
/// # Safety
/// Pointers are null or valid. The command buffer is being recorded, outside a render pass, on a queue that
/// computes. The set was written, with images of the frame's size and buffers of the lights that
/// `frame.lights` is of.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_record(
    pass: *const ArealightPass,
    command_buffer: *mut c_void,
    set: u64,
    frame: *const ArealightFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the command buffer and the set.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        let given = arguments::read(frame, "frame")?;
        let frame = read_frame_of(pass, given)?;
        let (commands, bound) = bound(command_buffer, set, given.host_set)?;
        Ok(pass.record(commands, bound, &frame)?)
    })
}

/// As arealight_pass_record, of a pass with AREALIGHT_DESCRIPTORS_PUSHED: the resources, with the table of
/// `arealight`, are pushed, and no descriptor set is needed.
///
/// # Safety
/// As arealight_pass_record. The resources outlive the commands.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_record_pushed(
    pass: *const ArealightPass,
    arealight: *const Arealight,
    command_buffer: *mut c_void,
    resources: *const ArealightResources,
    frame: *const ArealightFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the command buffer and the resources.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        let arealight = handles::borrow(arealight, "arealight")?;
        let resources = resources_of(pass, arealight, resources)?;
        let given = arguments::read(frame, "frame")?;
        let frame = read_frame_of(pass, given)?;
        arguments::refuse_null([(command_buffer.is_null(), "command_buffer")])?;
        let command_buffer = vk::CommandBuffer::from_raw(command_buffer as u64);
        let host_set = (given.host_set != 0).then(|| vk::DescriptorSet::from_raw(given.host_set));
        let bound = Bound::Pushed { resources: &resources, host_set };
        Ok(pass.record(command_buffer, bound, &frame)?)
    })
}

/// A frame of a pass, with nothing that the pass would not read.
///
/// # Safety
/// As [`read_frame`].
pub(crate) unsafe fn read_frame_of(pass: &ShadePass, frame: &ArealightFrame) -> Result<ShadeFrame, Failure> {
    let options = pass.options();
    let stencil = u64::from(frame.stencil_compare_mask | frame.stencil_reference);
    for (is_read, value, field) in [
        (options.shadow_rays > 0, u64::from(frame.seed), "seed: without shadow rays"),
        (pass.tiles().is_some(), frame.tile_lists.buffer, "tile_lists: without tiles"),
        (options.stencil, stencil, "stencil_compare_mask and stencil_reference: without a stencil"),
    ] {
        if !is_read && value != 0 {
            return Err(Failure::argument(format!("frame.{field} in the pass must be 0, not {value}")));
        }
    }
    // SAFETY: the same contract.
    unsafe { read_frame(frame) }
}

/// # Safety
/// The frame's pointer is null or valid.
pub(crate) unsafe fn read_frame(frame: &ArealightFrame) -> Result<ShadeFrame, Failure> {
    let matrix = frame.position_from_clip;
    let matrix = (!matrix.is_null()).then_some(matrix);
    // SAFETY: the same contract.
    let matrix = matrix.map(|matrix| unsafe { arguments::array(matrix, 16, "frame.position_from_clip") });
    Ok(ShadeFrame {
        size: [frame.width, frame.height],
        camera: Vec3::from_array(frame.camera),
        position_from_clip: matrix.transpose()?.map(Mat4::from_cols_slice),
        lights: read_summary(frame.lights)?,
        tile_lists: given(frame.tile_lists),
        seed: frame.seed,
        offset: frame.offset,
        rows: (frame.rows != [0, 0]).then_some(frame.rows),
        viewport: (frame.viewport != ArealightViewport::default()).then(|| viewport(frame.viewport)),
        stencil: StencilTest {
            compare_mask: byte(frame.stencil_compare_mask, "frame.stencil_compare_mask")?,
            reference: byte(frame.stencil_reference, "frame.stencil_reference")?,
        },
        light_offsets: frame.light_offsets,
    })
}

/// Eight bits of a stencil.
fn byte(number: u32, field: &str) -> Result<u8, Failure> {
    u8::try_from(number).map_err(|_| Failure::argument(format!("{field}: {number} must be from 0 to 255")))
}

fn viewport(viewport: ArealightViewport) -> Viewport {
    let ArealightViewport { x, y, width, height, min_depth, max_depth } = viewport;
    Viewport { x, y, width, height, min_depth, max_depth }
}

/// Makes the pipeline for frames whose lights need what this one's do, if it is not made yet: what
/// arealight_pass_record would take a moment for otherwise.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_prepare(
    pass: *const ArealightPass,
    frame: *const ArealightFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        Ok(pass.prepare(&read_frame_of(pass, arguments::read(frame, "frame")?)?)?)
    })
}

/// Destroys a pass, before or after the object that it was made from. Null is nothing.
///
/// # Safety
/// No commands of the pass are pending, the device is alive, and no other thread uses the pass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_destroy(pass: *mut ArealightPass) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { handles::take(pass, "pass") }.map(drop))
}
