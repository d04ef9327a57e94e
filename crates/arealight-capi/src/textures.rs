//! Images that lights show: memory and sets are the host's, filtering is recorded here.

use crate::device::{Arealight, memory_of};
use crate::failure::{ArealightResult, Failure, call};
use crate::lights::read_lights;
use crate::options::{flag, level};
use crate::pass::{sampled, set_layout};
use crate::types::{ArealightImage, ArealightLight, ArealightMemory, ArealightSetLayout};
use crate::{arguments, handles};
use arealight::{PyramidSize, TexturePart, Wrap};
use arealight_vk::ash::vk::{self, Handle as _};
use arealight_vk::{LightTextures, Resource, TextureUpdate};
use glam::DVec2;
use std::ffi::c_void;
use std::sync::{Mutex, MutexGuard};

/// The lights' images: all of one size, each with its mips and with what lobes see of it.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTextureOptions {
    /// Width and height in texels: a power of two from 64 to 4096. Images of other sizes are resampled.
    pub side: u32,
    /// How many images, from 1 on.
    pub layers: u32,
}

/// What light textures need of the host.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ArealightTextureNeeds {
    /// Of the image.
    pub memory: ArealightMemory,
    /// Of a set for a level.
    pub level_set: ArealightSetLayout,
    /// Of a set for an image that is loaded.
    pub source_set: ArealightSetLayout,
    /// How many sets there are for levels.
    pub level_set_count: u32,
    /// 0
    pub reserved: u32,
}

/// What light textures are given once.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTextureSetup {
    /// VkDeviceMemory for ArealightTextureNeeds.memory; it is freed after arealight_textures_destroy.
    pub memory: u64,
    /// Where in it.
    pub memory_offset: u64,
    /// VkDescriptorSet each, made with ArealightTextureNeeds.level_set. They live as long as the textures.
    pub level_sets: *const u64,
    /// ArealightTextureNeeds.level_set_count.
    pub level_set_count: u32,
    /// 0
    pub reserved: u32,
    /// VkCommandBuffer that is being recorded, outside a render pass, on a queue with graphics or compute.
    pub command_buffer: *mut c_void,
}

/// An image that replaces a layer. Zero in `part_size` is the whole image, in `divisor` and `aspect` 1.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTextureUpdate {
    /// VkDescriptorSet that arealight_textures_write_source_set pointed at the image.
    pub source_set: u64,
    /// The texture coordinates of the image that the layer shows at (0, 0), the outer corner of its first
    /// texel.
    pub part_low: [f64; 2],
    /// What is added to them at (1, 1); positive.
    pub part_size: [f64; 2],
    /// Which layer.
    pub layer: u32,
    /// The image's width in texels, from 1 to 4096.
    pub source_width: u32,
    /// Its height.
    pub source_height: u32,
    /// 1: it holds sRGB in a format that does not decode by itself, such as rgba8.
    pub decode_srgb: u32,
    /// What is beyond 0 to 1 along u: one of AREALIGHT_WRAP_*.
    pub wrap_u: u32,
    /// Along v.
    pub wrap_v: u32,
    /// What texels are divided by, where they are brighter or dimmer than half floats hold well (6e-5 to
    /// 65,504); from 1e-30 to 1e30. The radiance of lights that show the layer is to be multiplied by it.
    pub divisor: f32,
    /// How many times as wide as high the light is that shows the layer, as texture coordinates run over it;
    /// from 1/1024 to 1024.
    pub aspect: f32,
    /// 1: a disk or ellipse shows it; what is beyond the ellipse that touches its edges counts nothing.
    pub is_ellipse: u32,
    /// 0
    pub reserved: u32,
}

/// The images of lights on a device, filtered for shading.
pub struct ArealightTextures {
    inner: Mutex<Inner>,
}

struct Inner {
    textures: LightTextures,
    setup: Option<Setup>,
}

/// What the host gave.
struct Setup {
    /// The memory that is bound, and where in it.
    place: (u64, u64),
    level_sets: Vec<vk::DescriptorSet>,
}

impl ArealightTextures {
    fn inner(&self) -> MutexGuard<'_, Inner> {
        handles::lock(&self.inner)
    }
}

impl Inner {
    /// What the host gave; an error before it did.
    fn setup(&self) -> Result<&Setup, Failure> {
        self.setup.as_ref().ok_or_else(|| {
            Failure::argument("textures: have no memory yet; call arealight_textures_setup first")
        })
    }
}

/// Makes an image for what lights show, without memory. `*out` is the host's to destroy.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_create(
    arealight: *const Arealight,
    options: *const ArealightTextureOptions,
    out: *mut *mut ArealightTextures,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, and destroys the textures.
    call(|| unsafe {
        arguments::write(out, std::ptr::null_mut(), "out")?;
        let arealight = handles::borrow(arealight, "arealight")?;
        let options = arguments::read(options, "options")?;
        let size = PyramidSize::new(options.side)
            .map_err(|error| Failure::argument(format!("options.side: {error}")))?;
        let textures = LightTextures::new(arealight.context(), size, options.layers)?;
        let made = ArealightTextures { inner: Mutex::new(Inner { textures, setup: None }) };
        arguments::write(out, handles::give(made), "out")
    })
}

/// What the textures need of the host: memory, and descriptor sets from pools of the host.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_needs(
    textures: *const ArealightTextures,
    out: *mut ArealightTextureNeeds,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let textures = &handles::borrow(textures, "textures")?.inner().textures;
        // A set's share of what those of all levels take
        let mut level = textures.level_pool_sizes();
        for size in &mut level {
            size.descriptor_count /= textures.level_sets();
        }
        let needs = ArealightTextureNeeds {
            memory: memory_of(textures.memory_requirements(), 0),
            level_set: set_layout(textures.level_set_layout(), &level),
            source_set: set_layout(textures.source_set_layout(), &textures.source_pool_sizes(1)),
            level_set_count: textures.level_sets(),
            reserved: 0,
        };
        arguments::write(out, needs, "out")
    })
}

/// Binds memory, writes the sets of the levels, and records that every layer is black. Needed once; the
/// commands run before any others that use the textures. Commands that were never run are made good by
/// another call with the same memory.
///
/// # Safety
/// Pointers are null or valid, and `setup` is as ArealightTextureSetup says. No pending commands use the
/// textures or sets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_setup(
    textures: *mut ArealightTextures,
    setup: *const ArealightTextureSetup,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, memory, sets and command buffer.
    call(|| unsafe {
        let textures = handles::borrow(textures, "textures")?;
        let setup = arguments::read(setup, "setup")?;
        arguments::refuse_reserved(setup.reserved, "setup.reserved")?;
        let sets = arguments::array(setup.level_sets, setup.level_set_count as usize, "setup.level_sets")?;
        arguments::refuse_null([
            (setup.memory == 0, "setup.memory"),
            (sets.contains(&0), "setup.level_sets"),
            (setup.command_buffer.is_null(), "setup.command_buffer"),
        ])?;
        let mut inner = textures.inner();
        let Inner { textures, setup: given } = &mut *inner;
        if sets.len() != textures.level_sets() as usize {
            let message =
                format!("setup.level_set_count: {}, but {} are needed", sets.len(), textures.level_sets());
            return Err(Failure::argument(message));
        }
        let place = (setup.memory, setup.memory_offset);
        if given.as_ref().is_some_and(|given| given.place != place) {
            return Err(Failure::argument(
                "setup.memory: the textures have other memory already; call again with that, or make others",
            ));
        }

        let level_sets: Vec<_> = sets.iter().map(|set| vk::DescriptorSet::from_raw(*set)).collect();
        if given.is_none() {
            textures.bind_memory(vk::DeviceMemory::from_raw(setup.memory), setup.memory_offset)?;
        }
        textures.write_level_sets(&level_sets)?;
        textures.record_clear(vk::CommandBuffer::from_raw(setup.command_buffer as u64));
        *given = Some(Setup { place, level_sets });
        Ok(())
    })
}

/// Points a VkDescriptorSet, made with ArealightTextureNeeds.source_set, at an image to load: a 2D view with
/// VK_IMAGE_USAGE_SAMPLED_BIT, of a format that is sampled as numbers, whose first level is read.
///
/// # Safety
/// The pointer is null or valid. No pending commands use the set, and the image outlives those that will.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_write_source_set(
    textures: *const ArealightTextures,
    set: u64,
    source: ArealightImage,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointer, the set and the image.
    call(|| unsafe {
        let inner = handles::borrow(textures, "textures")?.inner();
        arguments::refuse_null([(set == 0, "set")])?;
        inner.setup()?;
        Ok(inner.textures.write_source_set(vk::DescriptorSet::from_raw(set), sampled(source))?)
    })
}

/// Records that images replace layers and are filtered, with the barriers between and around: afterwards they
/// are visible to shaders. The cost is that of the layers given. The host's barriers make the images visible
/// to compute shaders before. Frames that are recorded later on the same queue see the new layers, those
/// before the old ones; nothing waits.
///
/// # Safety
/// Pointers are null or valid. The command buffer is being recorded, outside a render pass, on a queue that
/// computes, after the commands of arealight_textures_setup.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_update(
    textures: *const ArealightTextures,
    command_buffer: *mut c_void,
    updates: *const ArealightTextureUpdate,
    update_count: u32,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the command buffer and the sets.
    call(|| unsafe {
        let inner = handles::borrow(textures, "textures")?.inner();
        let updates = arguments::array(updates, update_count as usize, "updates")?;
        let setup = inner.setup()?;
        arguments::refuse_null([(command_buffer.is_null(), "command_buffer")])?;
        let updates = updates.iter().enumerate().map(|(index, update)| read_update(index, update));
        let commands = vk::CommandBuffer::from_raw(command_buffer as u64);
        let updates = updates.collect::<Result<Vec<_>, _>>()?;
        Ok(inner.textures.record_update(commands, &setup.level_sets, &updates)?)
    })
}

fn read_update(index: usize, update: &ArealightTextureUpdate) -> Result<TextureUpdate, Failure> {
    let field = |name| format!("updates[{index}].{name}");
    arguments::refuse_reserved(update.reserved, &field("reserved"))?;
    arguments::refuse_null([(update.source_set == 0, &field("source_set"))])?;
    let wrap = |wrap, name| level(wrap, &[Wrap::Clamp, Wrap::Repeat, Wrap::Mirror], &field(name));
    let size = match update.part_size {
        [0.0, 0.0] => DVec2::ONE,
        size => DVec2::from_array(size),
    };
    Ok(TextureUpdate {
        layer: update.layer,
        source_set: vk::DescriptorSet::from_raw(update.source_set),
        source_size: [update.source_width, update.source_height],
        part: TexturePart {
            low: DVec2::from_array(update.part_low),
            size,
            wrap: [wrap(update.wrap_u, "wrap_u")?, wrap(update.wrap_v, "wrap_v")?],
            divisor: if update.divisor == 0.0 { 1.0 } else { update.divisor },
            aspect: if update.aspect == 0.0 { 1.0 } else { update.aspect },
            is_ellipse: flag(update.is_ellipse, &field("is_ellipse"))?,
        },
        decode_srgb: flag(update.decode_srgb, &field("decode_srgb"))?,
    })
}

/// The textures as ArealightResources.light_textures takes them.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_image(
    textures: *const ArealightTextures,
    out: *mut ArealightImage,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let inner = handles::borrow(textures, "textures")?.inner();
        inner.setup()?;
        let Resource::FilteredImage { view, layout } = inner.textures.resource() else {
            unreachable!("light textures are filtered")
        };
        let image =
            ArealightImage { view: view.as_raw(), layout: layout.as_raw().cast_unsigned(), reserved: 0 };
        arguments::write(out, image, "out")
    })
}

/// Checks that the layer of every textured light is there: passes do not know what will be bound.
///
/// # Safety
/// Pointers are null or valid, with as many items as their counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_check_lights(
    textures: *const ArealightTextures,
    lights: *const ArealightLight,
    light_count: u32,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let inner = handles::borrow(textures, "textures")?.inner();
        Ok(inner.textures.check_lights(&read_lights(lights, light_count)?)?)
    })
}

/// Destroys textures, before or after the object that they were made from. Null is nothing.
///
/// # Safety
/// No commands that use them are pending, the device is alive, and no other thread uses the object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_textures_destroy(textures: *mut ArealightTextures) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { handles::take(textures, "textures") }.map(drop))
}
