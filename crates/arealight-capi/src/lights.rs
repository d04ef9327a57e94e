//! Lights of the host, packed into arrays of the host.

use crate::failure::{ArealightResult, Failure, call};
use crate::pass::ArealightPass;
use crate::types::{
    AREALIGHT_SHAPE_ELLIPSE, AREALIGHT_SHAPE_SPHERE, AREALIGHT_SHAPE_TUBE, AREALIGHT_TUBE_FLAT,
    AREALIGHT_TUBE_OPEN, AREALIGHT_TUBE_ROUND, ArealightLight, ArealightPackedLights, ArealightShape,
};
use crate::{arguments, handles};
use arealight::{LightTexture, PolygonLight, Shape, ShapeLight, TubeEnds};
use glam::{DVec2, DVec3, Vec3};
use std::ffi::{CStr, c_char, c_void};

/// Packs lights for the pass, relative to `origin` (three numbers, in world positions), into arrays of the host, which
/// uploads them to its buffers. With null arrays, only says how large they must be.
///
/// # Safety
/// Pointers are null or valid, with as many items as their counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_pack_lights(
    pass: *const ArealightPass,
    lights: *const ArealightLight,
    light_count: u32,
    origin: *const f64,
    packed: *mut ArealightPackedLights,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointers, here and below.
        let (pass, lights, origin, mut arrays) = unsafe {
            (
                handles::borrow(pass, "pass")?,
                arguments::array(lights, light_count as usize, "lights")?,
                read_origin(origin)?,
                *arguments::read(packed.cast_const(), "packed")?,
            )
        };
        // SAFETY: as above.
        let made = pass.shade().pack_lights(&unsafe { read_lights(lights) }?, origin)?;

        // Copy, or say what is needed
        let bytes: [&[u8]; 2] = [bytemuck::cast_slice(&made.lights), bytemuck::cast_slice(&made.vertices)];
        let given = [(arrays.lights, arrays.lights_size), (arrays.vertices, arrays.vertices_size)];
        [arrays.lights_size, arrays.vertices_size] = bytes.map(|bytes| bytes.len() as u64);
        (arrays.quad_count, arrays.unused) = (made.quad_count, made.unused.bits());
        // SAFETY: as above.
        unsafe { arguments::write(packed, arrays, "packed") }?;
        let fields = ["packed.lights_size", "packed.vertices_size"];
        let arrays =
            || given.into_iter().zip(bytes.into_iter().zip(fields)).filter(|((to, _), _)| !to.is_null());
        for ((_, size), (bytes, field)) in arrays() {
            check_size(bytes, size, field)?;
        }
        for ((to, _), (bytes, _)) in arrays() {
            // SAFETY: as above; there is room.
            unsafe { copy(bytes, to) };
        }
        Ok(())
    })
}

/// Packs disks, spheres and tubes for the pass, relative to `origin`, into an array of the host, 64 bytes each and aligned to 4.
/// `*size` is the array's in bytes, and becomes what is needed. With a null array, only says so.
///
/// # Safety
/// Pointers are null or valid, with as many items as their counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pass_pack_shapes(
    pass: *const ArealightPass,
    shapes: *const ArealightShape,
    shape_count: u32,
    origin: *const f64,
    packed: *mut c_void,
    size: *mut u64,
) -> ArealightResult {
    call(|| {
        // SAFETY: the caller vouches for the pointers, here and below.
        let (pass, shapes, origin, given) = unsafe {
            (
                handles::borrow(pass, "pass")?,
                arguments::array(shapes, shape_count as usize, "shapes")?,
                read_origin(origin)?,
                *arguments::read(size.cast_const(), "size")?,
            )
        };
        // SAFETY: as above.
        let shapes = shapes.iter().enumerate().map(|(index, shape)| unsafe { read_shape(index, shape) });
        let made = pass.shade().pack_shapes(&shapes.collect::<Result<Vec<_>, _>>()?, origin)?;
        let bytes: &[u8] = bytemuck::cast_slice(&made);
        // SAFETY: as above.
        unsafe { arguments::write(size, bytes.len() as u64, "size") }?;
        if !packed.is_null() {
            check_size(bytes, given, "size")?;
            // SAFETY: as above; there is room.
            unsafe { copy(bytes, packed) };
        }
        Ok(())
    })
}

/// # Safety
/// `origin` is null or of three numbers.
unsafe fn read_origin(origin: *const f64) -> Result<DVec3, Failure> {
    // SAFETY: the same contract.
    let origin = DVec3::from_slice(unsafe { arguments::array(origin, 3, "origin") }?);
    if origin.is_finite() {
        Ok(origin)
    } else {
        Err(Failure::argument(format!("origin: {origin} is not finite")))
    }
}

/// The name that messages call a light by.
///
/// # Safety
/// `name` is null or a string of C.
unsafe fn read_name(name: *const c_char, otherwise: String) -> String {
    if name.is_null() {
        return otherwise;
    }
    // SAFETY: the same contract.
    unsafe { CStr::from_ptr(name) }.to_string_lossy().into_owned()
}

/// 0 or 1 as they are meant.
pub(crate) fn read_flag(flag: u32, field: &str) -> Result<bool, Failure> {
    match flag {
        0 | 1 => Ok(flag == 1),
        other => Err(Failure::argument(format!("{field}: {other} must be 0 or 1"))),
    }
}

fn check_size(bytes: &[u8], size: u64, field: &str) -> Result<(), Failure> {
    if size < bytes.len() as u64 {
        let message = format!("{field}: {size}, but {} are needed", bytes.len());
        return Err(Failure::new(ArealightResult::ErrorTooSmall, message));
    }
    Ok(())
}

/// # Safety
/// `to` has as many bytes, that nobody else uses.
unsafe fn copy(bytes: &[u8], to: *mut c_void) {
    // SAFETY: the same contract; both are as long as is copied.
    unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), to.cast(), bytes.len()) };
}

/// # Safety
/// The lights' pointers are null or valid.
pub(crate) unsafe fn read_lights(lights: &[ArealightLight]) -> Result<Vec<PolygonLight>, Failure> {
    // SAFETY: the same contract.
    lights.iter().enumerate().map(|(index, light)| unsafe { read_light(index, light) }).collect()
}

/// # Safety
/// The light's pointers are null or valid.
unsafe fn read_light(index: usize, light: &ArealightLight) -> Result<PolygonLight, Failure> {
    let count = light.vertex_count as usize;
    let field = |name| format!("lights[{index}].{name}");
    // SAFETY: the same contract, for all five.
    let (name, hole_counts, face_counts, vertices, coordinates) = unsafe {
        let name = read_name(light.name, format!("lights[{index}]"));
        let counts = |counts, number: u32, name| arguments::array(counts, number as usize, &field(name));
        let holes = counts(light.hole_vertex_counts, light.hole_count, "hole_vertex_counts")?;
        let faces = counts(light.face_vertex_counts, light.face_count, "face_vertex_counts")?;
        let all = holes.iter().fold(count, |sum, more| sum.saturating_add(*more as usize));
        let vertices = arguments::array(light.vertices, all.saturating_mul(3), &field("vertices"))?;
        let uvs = light.texture_coordinates;
        let uvs = (!uvs.is_null()).then(|| arguments::array(uvs, 2 * count, &field("texture_coordinates")));
        (name, holes, faces, vertices, uvs.transpose()?)
    };
    let mut vertices = vertices.chunks_exact(3).map(DVec3::from_slice);
    let mut made = PolygonLight {
        name,
        vertices: vertices.by_ref().take(count).collect(),
        faces: face_counts.to_vec(),
        radiance: Vec3::from_array(light.radiance),
        two_sided: read_flag(light.two_sided, &field("two_sided"))?,
        texture: coordinates.map(|uvs| LightTexture {
            layer: light.texture_layer,
            uvs: uvs.chunks_exact(2).map(DVec2::from_slice).collect(),
        }),
    };
    if !hole_counts.is_empty() {
        let hole = |count: &u32| vertices.by_ref().take(*count as usize).collect();
        let holes: Vec<Vec<DVec3>> = hole_counts.iter().map(hole).collect();
        made.cut_holes(&holes).map_err(arealight_vk::Error::from)?;
    }
    Ok(made)
}

/// # Safety
/// The shape's name is null or a string of C.
unsafe fn read_shape(index: usize, shape: &ArealightShape) -> Result<ShapeLight, Failure> {
    let field = |name| format!("shapes[{index}].{name}");
    let [center, axis_u, axis_v] = [shape.center, shape.axis_u, shape.axis_v].map(DVec3::from_array);
    let radius = shape.radius;
    let kind = match shape.kind {
        AREALIGHT_SHAPE_ELLIPSE => Shape::Ellipse { center, axis_u, axis_v },
        AREALIGHT_SHAPE_SPHERE => Shape::Sphere { center, radius },
        AREALIGHT_SHAPE_TUBE => {
            let ends = match shape.ends {
                AREALIGHT_TUBE_OPEN => TubeEnds::Open,
                AREALIGHT_TUBE_FLAT => TubeEnds::Flat,
                AREALIGHT_TUBE_ROUND => TubeEnds::Round,
                other => {
                    return Err(Failure::argument(format!(
                        "{}: {other} is no AREALIGHT_TUBE_*",
                        field("ends")
                    )));
                }
            };
            Shape::Tube { p0: center - axis_u, p1: center + axis_u, radius, ends }
        }
        other => {
            return Err(Failure::argument(format!("{}: {other} is no AREALIGHT_SHAPE_*", field("kind"))));
        }
    };
    Ok(ShapeLight {
        // SAFETY: the same contract.
        name: unsafe { read_name(shape.name, format!("shapes[{index}]")) },
        radiance: Vec3::from_array(shape.radiance),
        two_sided: read_flag(shape.two_sided, &field("two_sided"))?,
        texture: read_flag(shape.textured, &field("textured"))?.then_some(shape.texture_layer),
        shape: kind,
    })
}
