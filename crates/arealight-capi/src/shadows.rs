//! The shadow pass, and what blocks its rays.

use crate::device::Arealight;
use crate::failure::{ArealightResult, Failure, call};
use crate::lights::fill;
use crate::options::{level, shade_options};
use crate::pass::{
    ArealightPass, blockers, bound, given, host_module, read_frame, read_resources, set_layout, stored,
};
use crate::types::{
    ArealightBlockerArrays, ArealightFrame, ArealightPassOptions, ArealightResources, ArealightSetLayout,
    ArealightShadowFrame, ArealightShadowOptions, ArealightShadowResources,
};
use crate::{arguments, handles};
use arealight::plan::{self, Output, ShadowFilter, ShadowHistory};
use arealight::{BlockerError, Blockers};
use arealight_vk::ash::vk::{self, Handle as _};
use arealight_vk::{ShadowFrame, ShadowOptions, ShadowPass, ShadowPassInfo, ShadowResources};
use bytemuck::cast_slice;
use glam::Vec3;
use std::ffi::c_void;

/// Triangles that block shadow rays, in a hierarchy of boxes, for hosts that have none of their own.
pub struct ArealightBlockers {
    pub(crate) blockers: Blockers,
}

/// Builds the hierarchy of triangles: nine numbers each, relative to the origin that lights are packed with,
/// in any vertex order. It takes a microsecond or two a triangle. `alphas`, or null, holds of each triangle
/// the number by which shadow rays ask the host what is there of it (arealight_bridge_alpha of a module
/// compiled with AREALIGHT_HOST_ALPHA); 0: all of it, as without such a module. `*out` is the host's to
/// destroy.
///
/// # Safety
/// Pointers are null or valid, with as many items as the count says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_blockers_create(
    vertices: *const f32,
    alphas: *const u32,
    triangle_count: u32,
    out: *mut *mut ArealightBlockers,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let count = triangle_count as usize;
        arguments::write(out, std::ptr::null_mut(), "out")?;
        let alphas = if alphas.is_null() { &[] } else { arguments::array(alphas, count, "alphas")? };
        let numbers = arguments::array(vertices, 9 * count, "vertices")?;
        let triangle = |numbers: &[f32]| [0, 3, 6].map(|first| Vec3::from_slice(&numbers[first..]));
        let triangles: Vec<[Vec3; 3]> = numbers.chunks_exact(9).map(triangle).collect();
        let number = |index: u32| alphas.get(index as usize).copied().unwrap_or_default();
        let refused = |error: BlockerError| Failure::argument(error.to_string());
        let blockers = Blockers::new(&triangles).map_err(refused)?.with_alpha(number);
        arguments::write(out, handles::give(ArealightBlockers { blockers }), "out")
    })
}

/// Copies the hierarchy into arrays of the host, which uploads them to its buffers. With null arrays, only
/// says how large they must be.
///
/// # Safety
/// Pointers are null or valid, with as many bytes as their sizes say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_blockers_read(
    blockers: *const ArealightBlockers,
    arrays: *mut ArealightBlockerArrays,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let blockers = &handles::borrow(blockers, "blockers")?.blockers;
        let mut sizes = *arguments::read(arrays.cast_const(), "arrays")?;
        let parts: [(_, _, &[u8], _); 2] = [
            (sizes.nodes, sizes.nodes_size, cast_slice(&blockers.nodes), "arrays.nodes_size"),
            (sizes.triangles, sizes.triangles_size, cast_slice(&blockers.triangles), "arrays.triangles_size"),
        ];
        [sizes.nodes_size, sizes.triangles_size] = parts.map(|(_, _, bytes, _)| bytes.len() as u64);
        arguments::write(arrays, sizes, "arrays")?;
        fill(parts)
    })
}

/// Destroys a hierarchy, whose copies stay. Null is nothing.
///
/// # Safety
/// No other thread uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_blockers_destroy(blockers: *mut ArealightBlockers) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { handles::take(blockers, "blockers") }.map(drop))
}

/// Shadow rays after a shade pass whose ArealightPassOptions have them.
pub struct ArealightShadowPass {
    pass: ShadowPass,
}

/// Makes a shadow pass, after shade passes of `options`; its rays meet
/// ArealightShadowResources.blocker_nodes. `*out` is the host's to destroy.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_shadow_pass_create(
    arealight: *const Arealight,
    options: *const ArealightPassOptions,
    shadows: *const ArealightShadowOptions,
    out: *mut *mut ArealightShadowPass,
) -> ArealightResult {
    // SAFETY: the same contract; the host vouches for the module.
    call(|| unsafe {
        arguments::write(out, std::ptr::null_mut(), "out")?;
        let arealight = handles::borrow(arealight, "arealight")?;
        let options = shade_options(arguments::read(options, "options")?)?;
        let shadows = arguments::read(shadows, "shadows")?;
        let (module, host_set) = host_module(&shadows.module)?;
        let shadows = shadow_options(shadows)?;
        let info = ShadowPassInfo { options, shadows, module, host_set };
        let pass = ShadowPass::new(arealight.context(), info)?;
        arguments::write(out, handles::give(ArealightShadowPass { pass }), "out")
    })
}

/// By AREALIGHT_SHADOW_FILTER_*.
pub(crate) const FILTERS: [ShadowFilter; 2] = [ShadowFilter::Off, ShadowFilter::Gather];

/// By AREALIGHT_SHADOW_HISTORY_*.
pub(crate) const HISTORIES: [ShadowHistory; 3] =
    [ShadowHistory::Off, ShadowHistory::Camera, ShadowHistory::MotionVectors];

fn shadow_options(options: &ArealightShadowOptions) -> Result<ShadowOptions, Failure> {
    Ok(ShadowOptions {
        filter: level(options.filter, &FILTERS, "options.filter")?,
        history: level(options.history, &HISTORIES, "options.history")?,
        output: level(options.output, &[Output::Overwrite, Output::Add], "options.output")?,
    })
}

/// How many bytes ArealightResources.shadow_picks needs, for images of `width` x `height` pixels; 0 for a
/// pass without shadow rays.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_shadow_picks_size(
    pass: *const ArealightPass,
    width: u32,
    height: u32,
    out: *mut u64,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let size = handles::borrow(pass, "pass")?.pass.picks_size([width, height]);
        arguments::write(out, size, "out")
    })
}

/// How many bytes ArealightShadowResources.history needs, for images of `width` x `height` pixels.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_shadow_history_size(
    width: u32,
    height: u32,
    out: *mut u64,
) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { arguments::write(out, plan::shadow_history_size([width, height]), "out") })
}

/// What descriptor sets of the pass are made with.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_shadow_pass_set_layout(
    pass: *const ArealightShadowPass,
    out: *mut ArealightSetLayout,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        arguments::write(out, set_layout(pass.set_layout(), &pass.pool_sizes(1)), "out")
    })
}

/// Points a VkDescriptorSet, made with arealight_shadow_pass_set_layout, at resources: `shade` are those of
/// the shade pass before.
///
/// # Safety
/// Pointers are null or valid. No pending commands use the set, and the resources outlive those that will.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_shadow_pass_write_set(
    pass: *const ArealightShadowPass,
    arealight: *const Arealight,
    set: u64,
    shade: *const ArealightResources,
    resources: *const ArealightShadowResources,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the set and the resources.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        let arealight = handles::borrow(arealight, "arealight")?;
        arguments::refuse_null([(set == 0, "set")])?;
        let shade = read_resources(arealight.table_resource()?, arguments::read(shade, "shade")?)?;
        let resources = read_shadow_resources(arguments::read(resources, "resources")?);
        Ok(pass.write_set(vk::DescriptorSet::from_raw(set), &shade, &resources)?)
    })
}

fn read_shadow_resources(resources: &ArealightShadowResources) -> ShadowResources {
    ShadowResources {
        shadow: stored(resources.shadow),
        radiance: (resources.radiance.view != 0).then(|| stored(resources.radiance)),
        history: given(resources.history),
        blockers: blockers(resources.blocker_nodes, resources.blocker_triangles),
    }
}

/// Makes the pipelines for frames whose lights need what this one's do, if they are not made yet: what
/// arealight_shadow_pass_record would take a moment for otherwise.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_shadow_pass_prepare(
    pass: *const ArealightShadowPass,
    frame: *const ArealightFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        Ok(pass.prepare(read_frame(arguments::read(frame, "frame")?)?.lights)?)
    })
}

/// Records the pass into a VkCommandBuffer, for the frame that the shade pass recorded: two dispatches, or
/// three with a history, with barriers between them. The barrier for what the shade pass wrote is the host's,
/// and so is one after. `resources` are those that the set was written with.
///
/// # Safety
/// Pointers are null or valid. As arealight_pass_record; with a history, the frame before of this view was
/// recorded earlier on the same queue.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_shadow_pass_record(
    pass: *const ArealightShadowPass,
    command_buffer: *mut c_void,
    set: u64,
    resources: *const ArealightShadowResources,
    frame: *const ArealightShadowFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the command buffer and the sets.
    call(|| unsafe {
        let pass = &handles::borrow(pass, "pass")?.pass;
        let resources = read_shadow_resources(arguments::read(resources, "resources")?);
        let given = arguments::read(frame, "frame")?;
        let (commands, bound) = bound(command_buffer, set, given.host_set)?;
        arguments::refuse_reserved(given.reserved, "frame.reserved")?;
        let shade = read_frame(arguments::read(given.frame, "frame.frame")?)?;
        let frame = ShadowFrame { shade: &shade, origin_shift: Vec3::from_array(given.origin_shift) };
        Ok(pass.record(commands, bound, &resources, &frame)?)
    })
}

/// Destroys a pass, before or after the object that it was made from. Null is nothing.
///
/// # Safety
/// No commands of the pass are pending, the device is alive, and no other thread uses the pass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_shadow_pass_destroy(pass: *mut ArealightShadowPass) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { handles::take(pass, "pass") }.map(drop))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::*;
    use std::ptr::{null, null_mut};

    #[test]
    fn constants_are_those_of_the_vocabulary() {
        let made = |filter, history| {
            let options = ArealightShadowOptions { filter, history, ..Default::default() };
            shadow_options(&options).map(|made| (made.filter, made.history)).unwrap()
        };
        let found = made(AREALIGHT_SHADOW_FILTER_GATHER, AREALIGHT_SHADOW_HISTORY_CAMERA);
        assert_eq!(found, (ShadowFilter::Gather, ShadowHistory::Camera));
        let found = made(AREALIGHT_SHADOW_FILTER_OFF, AREALIGHT_SHADOW_HISTORY_MOTION);
        assert_eq!(found, (ShadowFilter::Off, ShadowHistory::MotionVectors));
        let zero = ArealightShadowOptions::default();
        for (wrong, field) in [
            (ArealightShadowOptions { filter: 2, ..zero }, "options.filter"),
            (ArealightShadowOptions { history: 3, ..zero }, "options.history"),
            (ArealightShadowOptions { output: 2, ..zero }, "options.output"),
        ] {
            let message = shadow_options(&wrong).err().unwrap().message;
            assert!(message.starts_with(field), "{message}");
        }
    }

    #[test]
    fn blockers_are_copied_where_there_is_room() {
        let vertices = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let (mut blockers, mut sizes) = (null_mut(), ArealightBlockerArrays::default());
        // SAFETY: the pointers are valid, and the arrays as large as they say.
        unsafe {
            let create =
                |vertices: &[f32; 9], out| arealight_blockers_create(vertices.as_ptr(), null(), 1, out);
            assert_eq!(create(&[f32::NAN; 9], &raw mut blockers), ArealightResult::ErrorArgument);
            assert!(blockers.is_null());
            assert_eq!(create(&vertices, &raw mut blockers), ArealightResult::Ok);
            assert_eq!(arealight_blockers_read(blockers, &raw mut sizes), ArealightResult::Ok);
            assert_eq!((sizes.nodes_size, sizes.triangles_size), (32, 48));
            let mut triangles = [7.0_f32; 12];
            sizes.triangles = triangles.as_mut_ptr().cast();
            sizes.triangles_size = 44;
            assert_eq!(arealight_blockers_read(blockers, &raw mut sizes), ArealightResult::ErrorTooSmall);
            assert_eq!((sizes.triangles_size, triangles[0]), (48, 7.0));
            assert_eq!(arealight_blockers_read(blockers, &raw mut sizes), ArealightResult::Ok);
            assert_eq!(triangles, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
            assert_eq!(arealight_blockers_destroy(blockers), ArealightResult::Ok);
            assert_eq!(arealight_blockers_read(blockers, &raw mut sizes), ArealightResult::ErrorArgument);
        }
    }
}
