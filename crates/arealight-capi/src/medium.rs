//! The pass that puts a medium before a picture.

use crate::device::Arealight;
use crate::failure::{ArealightResult, Failure, call};
use crate::options::{flag, level, shade_options};
use crate::pass::{blockers, bound, host_module, read_frame, read_resources, sampled, set_layout, stored};
use crate::types::{
    ArealightBuffer, ArealightFrame, ArealightImage, ArealightModule, ArealightPassOptions,
    ArealightResources, ArealightSetLayout,
};
use crate::{arguments, handles};
use arealight::plan::{MediumOptions, ShadeOptions};
use arealight_vk::ash::vk::{self, Handle as _};
use arealight_vk::{MediumFrame, MediumPass, MediumPassInfo, MediumResources, ShadeFrame};
use glam::{Mat4, Vec3};
use std::ffi::c_void;

/// Options of a medium's pass. All zero: at the middle of each froxel, without shadow rays.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightMediumOptions {
    /// 1: each sample has a ray over each light; 2: one ray alone, over a light that is drawn by how much of
    /// it is scattered there. 0: none.
    pub shadow_rays: u32,
    /// At how many points of a froxel light is scattered, each with rays of its own. 0 is 1.
    pub samples: u32,
    /// 1: scattering and extinction are read from ArealightMediumResources.medium. Else 0.
    pub by_image: u32,
    /// 1: a froxel's distance is drawn within it, by ArealightMediumFrame.seed. Else 0.
    pub jitter: u32,
    /// 1: froxels that surfaces hide from every pixel are filled, too. 0: they hold nothing, and positions
    /// are of the picture's size.
    pub fill_hidden: u32,
    /// `medium_scatter.comp` of the host's, as ArealightShadowOptions.module.
    pub module: ArealightModule,
}

/// The host's resources of a medium's pass beyond those of its shade pass.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightMediumResources {
    /// A 3D storage image (rgba16f) of ArealightMediumFrame.froxels, in VK_IMAGE_LAYOUT_GENERAL. The pass
    /// alone writes it: radiance up to a froxel's far side, in a the part that is let through.
    pub froxels: ArealightImage,
    /// With ArealightMediumOptions.by_image a 3D image of that size: per unit of length scattering in rgb,
    /// extinction in a. Else 0.
    pub medium: ArealightImage,
    /// With shadow rays ArealightBlockerArrays.nodes. 0 with a module of the host's.
    pub blocker_nodes: ArealightBuffer,
    /// ArealightBlockerArrays.triangles; without triangles, any buffer. 0 with a module of the host's.
    pub blocker_triangles: ArealightBuffer,
}

/// A frame of a medium's pass.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightMediumFrame {
    /// That of the shade pass, of a perspective camera, with `position_from_clip`; its size, camera, matrix
    /// and lights count.
    pub frame: *const ArealightFrame,
    /// VkDescriptorSet for set 1 of a module of the host's. Else 0.
    pub host_set: u64,
    /// Across, down and away from the camera, each from 1 to 65535: such as 160 x 90 x 64.
    pub froxels: [u32; 3],
    /// What is scattered per unit of length, a channel: extinction times albedo. From 0.
    pub scattering: [f32; 3],
    /// What is scattered or absorbed per unit of length. From 0.
    pub extinction: f32,
    /// The mean cosine of the angle by which light is turned, in (-1, 1).
    pub anisotropy: f32,
    /// Slices are even up to about this distance, then each is longer by a factor. Above 0.
    pub nearest: f32,
    /// Where the last slice ends. Above `nearest`.
    pub farthest: f32,
    /// Of random numbers: one more in each frame.
    pub seed: u32,
    /// Lights are left out of froxels that together add no more than this to a pixel's radiance, in the sum
    /// of the channels, for each unit of albedo. 0: only lights that nothing comes of. Frames of fewer than
    /// 32 lights leave none out.
    pub cull_radiance: f32,
}

/// A medium, such as fog, before what an ArealightPass shaded.
pub struct ArealightMediumPass {
    pass: MediumPass,
}

/// Makes a medium's pass, after shade passes of `options`: their position, radiance_format and quality are
/// read. Its rays meet ArealightMediumResources.blocker_nodes. `*out` is the host's to destroy.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_medium_pass_create(
    arealight: *const Arealight,
    options: *const ArealightPassOptions,
    medium: *const ArealightMediumOptions,
    out: *mut *mut ArealightMediumPass,
) -> ArealightResult {
    // SAFETY: the same contract; the host vouches for the module.
    call(|| unsafe {
        arguments::write(out, std::ptr::null_mut(), "out")?;
        let arealight = handles::borrow(arealight, "arealight")?;
        let shade = shade_options(arguments::read(options, "options")?)?;
        let medium = arguments::read(medium, "medium")?;
        let options = medium_options(shade, medium)?;
        let (module, host_set) = host_module(&medium.module)?;
        let pass = MediumPass::new(arealight.context(), MediumPassInfo { options, module, host_set })?;
        arguments::write(out, handles::give(ArealightMediumPass { pass }), "out")
    })
}

pub(crate) fn medium_options(
    shade: ShadeOptions,
    medium: &ArealightMediumOptions,
) -> Result<MediumOptions, Failure> {
    let rays = [(false, false), (true, false), (true, true)];
    let (shadow_rays, one_light) = level(medium.shadow_rays, &rays, "medium.shadow_rays")?;
    Ok(MediumOptions {
        shadow_rays,
        one_light,
        samples: medium.samples,
        by_image: flag(medium.by_image, "medium.by_image")?,
        jitter: flag(medium.jitter, "medium.jitter")?,
        fill_hidden: flag(medium.fill_hidden, "medium.fill_hidden")?,
        from_depth: shade.from_depth,
        format: shade.format,
        quality: shade.quality,
        ..MediumOptions::default()
    })
}

/// What descriptor sets of the pass are made with.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_medium_pass_set_layout(
    pass: *const ArealightMediumPass,
    out: *mut ArealightSetLayout,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        arguments::write(out, set_layout(pass.set_layout(), &pass.pool_sizes(1)), "out")
    })
}

/// Points a VkDescriptorSet, made with arealight_medium_pass_set_layout, at resources: of `shade` the lights,
/// AREALIGHT_PLANE_POSITION and the radiance that the medium is put before.
///
/// # Safety
/// Pointers are null or valid. No pending commands use the set, and the resources outlive those that will.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_medium_pass_write_set(
    pass: *const ArealightMediumPass,
    arealight: *const Arealight,
    set: u64,
    shade: *const ArealightResources,
    resources: *const ArealightMediumResources,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the set and the resources.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        let arealight = handles::borrow(arealight, "arealight")?;
        arguments::refuse_null([(set == 0, "set")])?;
        let shade = read_resources(arealight.table_resource()?, arguments::read(shade, "shade")?)?;
        let resources = arguments::read(resources, "resources")?;
        let resources = MediumResources {
            froxels: stored(resources.froxels),
            medium: (resources.medium.view != 0).then(|| sampled(resources.medium)),
            blockers: blockers(resources.blocker_nodes, resources.blocker_triangles),
        };
        Ok(pass.write_set(vk::DescriptorSet::from_raw(set), &shade, &resources)?)
    })
}

/// Makes the pipelines for frames whose lights need what this one's do, if they are not made yet: what
/// arealight_medium_pass_record would take a moment for otherwise.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_medium_pass_prepare(
    pass: *const ArealightMediumPass,
    frame: *const ArealightFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        Ok(pass.prepare(read_frame(arguments::read(frame, "frame")?)?.lights)?)
    })
}

/// Records the pass into a VkCommandBuffer, after the frame's radiance: three dispatches, with barriers
/// between them. The barrier for what was shaded is the host's, and so is one after.
///
/// # Safety
/// As arealight_pass_record.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_medium_pass_record(
    pass: *const ArealightMediumPass,
    command_buffer: *mut c_void,
    set: u64,
    frame: *const ArealightMediumFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the command buffer and the sets.
    call(|| unsafe {
        let (pass, given) = (&handles::borrow(pass, "pass")?.pass, arguments::read(frame, "frame")?);
        let (commands, bound) = bound(command_buffer, set, given.host_set)?;
        let shade = read_frame(arguments::read(given.frame, "frame.frame")?)?;
        Ok(pass.record(commands, bound, &medium_frame(&shade, given))?)
    })
}

pub(crate) fn medium_frame(shade: &ShadeFrame, medium: &ArealightMediumFrame) -> MediumFrame {
    MediumFrame {
        froxels: medium.froxels,
        size: shade.size,
        camera: shade.camera,
        position_from_clip: shade.position_from_clip.unwrap_or(Mat4::NAN), // which is refused
        lights: shade.lights,
        scattering: Vec3::from_array(medium.scattering),
        extinction: medium.extinction,
        anisotropy: medium.anisotropy,
        nearest: medium.nearest,
        farthest: medium.farthest,
        cull_radiance: medium.cull_radiance,
        seed: medium.seed,
    }
}

/// Destroys a pass, before or after the object that it was made from. Null is nothing.
///
/// # Safety
/// No commands of the pass are pending, the device is alive, and no other thread uses the pass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_medium_pass_destroy(pass: *mut ArealightMediumPass) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { handles::take(pass, "pass") }.map(drop))
}
