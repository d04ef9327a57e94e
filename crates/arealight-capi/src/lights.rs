//! Lights of the host, packed into arrays of the host.

use crate::arguments;
use crate::constants::{
    AREALIGHT_LIGHT_DISK, AREALIGHT_LIGHT_MESH, AREALIGHT_LIGHT_POLYGON, AREALIGHT_LIGHT_SPHERE,
    AREALIGHT_LIGHT_TUBE,
};
use crate::failure::{ArealightResult, Failure, call};
use crate::options::{flag, level};
use crate::types::{ArealightLight, ArealightLightSummary, ArealightPackedLights, ArealightReach};
use arealight::{
    Effects, Light, LightError, LightShape, LightSummary, LightTexture, Opening, PackedLights, Profile,
    TubeEnds, reach,
};
use bytemuck::cast_slice;
use glam::{DVec2, DVec3, Vec3};
use std::ffi::{CStr, c_char, c_void};

/// Packs lights relative to `origin` (three numbers, in world positions) into arrays of the host, which
/// uploads them to its buffers, and says what a frame needs to know of them. With null arrays, only says how
/// large they must be.
///
/// # Safety
/// Pointers are null or valid, with as many items as their counts say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_pack_lights(
    lights: *const ArealightLight,
    light_count: u32,
    origin: *const f64,
    packed: *mut ArealightPackedLights,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let lights = read_lights(lights, light_count)?;
        let (origin, given) = (read_origin(origin)?, *arguments::read(packed.cast_const(), "packed")?);
        let made = PackedLights::new(&lights, origin)?;
        let parts: [(_, _, &[u8], _); 3] = [
            (given.lights, given.lights_size, cast_slice(&made.lights), "packed.lights_size"),
            (given.vertices, given.vertices_size, cast_slice(&made.vertices), "packed.vertices_size"),
            (given.shapes, given.shapes_size, cast_slice(&made.shapes), "packed.shapes_size"),
        ];
        let [lights_size, vertices_size, shapes_size] = parts.map(|(_, _, bytes, _)| bytes.len() as u64);
        let summary = write_summary(made.summary());
        let needed = ArealightPackedLights { lights_size, vertices_size, shapes_size, summary, ..given };
        arguments::write(packed, needed, "packed")?;
        fill(parts)
    })
}

/// Says how far a light is of any matter, for hosts with clusters of their own: outside of `*out` no surface
/// reflects more of it than `threshold`, in W/(m² sr), in any channel. `density`, a steradian, is of the
/// surfaces' lobes times their albedos where they are densest: 1/pi for surfaces without specular lobe, else
/// that and arealight_lobe_density of the least roughness. What several lights add up to may be more.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_light_reach(
    light: *const ArealightLight,
    threshold: f64,
    density: f64,
    out: *mut ArealightReach,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let light = read_light(0, arguments::read(light, "light")?)?;
        light.validate().map_err(|fault| LightError { index: 0, name: light.name.clone(), fault })?;
        for (value, field) in [(threshold, "threshold"), (density, "density")] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Failure::argument(format!("{field}: {value} must be finite and not negative")));
            }
        }
        let radius = reach::radius(&light, threshold, density);
        let [low, high] = reach::bounds(&light, radius).map(|corner| corner.to_array());
        let found = ArealightReach { center: light.shape.center().to_array(), radius, low, high };
        arguments::write(out, found, "out")
    })
}

fn write_summary(summary: LightSummary) -> ArealightLightSummary {
    let LightSummary { light_count, quad_count, shape_count, effects } = summary;
    ArealightLightSummary { light_count, quad_count, shape_count, effects: effects.bits() }
}

pub(crate) fn read_summary(summary: ArealightLightSummary) -> Result<LightSummary, Failure> {
    let ArealightLightSummary { light_count, quad_count, shape_count, effects } = summary;
    let effects = read_effects(effects, "frame.lights.effects")?;
    Ok(LightSummary { light_count, quad_count, shape_count, effects })
}

pub(crate) fn read_effects(bits: u32, field: &str) -> Result<Effects, Failure> {
    Effects::from_bits(bits).ok_or_else(|| {
        let unknown = bits & !Effects::all().bits();
        Failure::argument(format!("{field}: {unknown:#x} are no AREALIGHT_EFFECT_*"))
    })
}

/// # Safety
/// `origin` is null or of three numbers.
pub(crate) unsafe fn read_origin(origin: *const f64) -> Result<DVec3, Failure> {
    // SAFETY: the same contract.
    let origin = DVec3::from_slice(unsafe { arguments::array(origin, 3, "origin") }?);
    if origin.is_finite() {
        Ok(origin)
    } else {
        Err(Failure::argument(format!("origin: {origin} is not finite")))
    }
}

/// The name that messages call a light by: none where it is null.
///
/// # Safety
/// `name` is null or a string of C.
unsafe fn read_name(name: *const c_char) -> String {
    if name.is_null() {
        return String::new();
    }
    // SAFETY: the same contract.
    unsafe { CStr::from_ptr(name) }.to_string_lossy().into_owned()
}

pub(crate) fn check_size(bytes: &[u8], size: u64, field: &str) -> Result<(), Failure> {
    if size < bytes.len() as u64 {
        let message = format!("{field}: {size}, but {} are needed", bytes.len());
        return Err(Failure::new(ArealightResult::ErrorTooSmall, message));
    }
    Ok(())
}

/// # Safety
/// `to` has as many bytes, that nobody else uses.
pub(crate) unsafe fn copy(bytes: &[u8], to: *mut c_void) {
    // SAFETY: the same contract; both are as long as is copied.
    unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), to.cast(), bytes.len()) };
}

/// Copies to arrays that are not null, if each has room: where to, how many bytes there are, what, and which
/// field says so.
///
/// # Safety
/// Arrays have as many bytes, that nobody else uses.
pub(crate) unsafe fn fill<const COUNT: usize>(
    parts: [(*mut c_void, u64, &[u8], &str); COUNT],
) -> Result<(), Failure> {
    let given = || parts.iter().filter(|(to, ..)| !to.is_null());
    given().try_for_each(|(_, size, bytes, field)| check_size(bytes, *size, field))?;
    // SAFETY: the same contract; there is room.
    given().for_each(|(to, _, bytes, _)| unsafe { copy(bytes, *to) });
    Ok(())
}

/// # Safety
/// The pointers are null or valid, with as many items.
pub(crate) unsafe fn read_lights(lights: *const ArealightLight, count: u32) -> Result<Vec<Light>, Failure> {
    // SAFETY: the same contract.
    unsafe {
        let lights = arguments::array(lights, count as usize, "lights")?.iter().enumerate();
        lights.map(|(index, light)| read_light(index, light)).collect()
    }
}

/// # Safety
/// The light's pointers are null or valid.
unsafe fn read_light(index: usize, light: &ArealightLight) -> Result<Light, Failure> {
    let field = |name| format!("lights[{index}].{name}");
    let wrong = |name, number, known| Failure::argument(format!("{}: {number} is not {known}", field(name)));
    let [center, axis_u, axis_v] = [light.center, light.axis_u, light.axis_v].map(DVec3::from_array);
    let radius = light.radius;
    let error = f64::from(light.cluster_error);
    if !(error >= 0.0 && error.is_finite()) {
        let message = format!("{}: {error} is not finite and 0 or more", field("cluster_error"));
        return Err(Failure::argument(message));
    }
    // SAFETY: the same contract, here and below.
    let outlines = || unsafe { read_outlines(light, &field) };
    let (mut uvs, mut holes) = (vec![], vec![]);
    let shape = match light.kind {
        AREALIGHT_LIGHT_POLYGON => {
            let mut outlines = outlines()?;
            holes = outlines.split_off(1);
            // SAFETY: as above.
            uvs = unsafe { read_coordinates(light, &field) }?;
            LightShape::Polygon(outlines.remove(0))
        }
        AREALIGHT_LIGHT_MESH => {
            let (count, counts) = (light.face_count as usize, light.face_vertex_counts);
            // SAFETY: as above.
            let faces = unsafe { arguments::array(counts, count, &field("face_vertex_counts")) }?.to_vec();
            LightShape::mesh(outlines()?.remove(0), faces).clustered(error)
        }
        AREALIGHT_LIGHT_DISK => LightShape::Disk { center, axis_u, axis_v },
        AREALIGHT_LIGHT_SPHERE => LightShape::Sphere { center, radius },
        AREALIGHT_LIGHT_TUBE => {
            let ends = level(light.ends, &[TubeEnds::Open, TubeEnds::Flat, TubeEnds::Round], &field("ends"))?;
            LightShape::Tube { p0: center - axis_u, p1: center + axis_u, radius, ends }
        }
        other => return Err(wrong("kind", other, "one of AREALIGHT_LIGHT_*")),
    };
    let textured = flag(light.textured, &field("textured"))?;
    // SAFETY: as above.
    let (name, numbers) = unsafe { (read_name(light.name), read_profile(light, &field)?) };
    let refused = |fault| LightError { index, name: name.clone(), fault };
    let rows = numbers.map(|numbers| numbers.chunks(row_length(light)).collect::<Vec<_>>());
    let profile = rows.map(|rows| Profile::new(&rows, light.profile_levels)).transpose().map_err(refused)?;
    let has_opening = flag(light.has_opening, &field("has_opening"))?;
    let [opening_center, opening_u, opening_v] =
        [light.opening_center, light.opening_axis_u, light.opening_axis_v].map(DVec3::from_array);
    let housed = has_opening && flag(light.opening_housed, &field("opening_housed"))?;
    let opening = Opening { center: opening_center, axis_u: opening_u, axis_v: opening_v, housed };
    let mut made = Light {
        name,
        radiance: Vec3::from_array(light.radiance),
        two_sided: flag(light.two_sided, &field("two_sided"))?,
        texture: textured.then_some(LightTexture { layer: light.texture_layer, uvs }),
        profile,
        opening: has_opening.then_some(opening),
        links: u8::try_from(light.links).map_err(|_| wrong("links", light.links, "from 0 to 255"))?,
        shape,
    };
    if !holes.is_empty() {
        made.cut_holes(&holes).map_err(|fault| LightError { index, name: made.name.clone(), fault })?;
    }
    Ok(made)
}

/// Numbers in a row of a light's profile.
fn row_length(light: &ArealightLight) -> usize {
    1 + light.profile_azimuth_count.max(1) as usize
}

/// The rows of a light's profile, where it has one.
///
/// # Safety
/// As [`read_light`].
unsafe fn read_profile<'a>(
    light: &'a ArealightLight,
    field: &impl Fn(&'static str) -> String,
) -> Result<Option<&'a [f64]>, Failure> {
    let count = (light.profile_row_count as usize).saturating_mul(row_length(light));
    // SAFETY: the same contract.
    let numbers = unsafe { arguments::array(light.profile, count, &field("profile")) }?;
    Ok((!light.profile.is_null()).then_some(numbers))
}

/// The most vertices of a light, its holes' among them: a count beyond it is not what the host meant.
const MOST_VERTICES: usize = 1 << 24;

fn check_count(count: usize, field: impl Fn() -> String) -> Result<(), Failure> {
    if count > MOST_VERTICES {
        let message = format!("{}: {count} vertices, at most {MOST_VERTICES} a light", field());
        return Err(Failure::argument(message));
    }
    Ok(())
}

/// The outline of a polygon or the vertices of a mesh, and the outlines of a polygon's holes.
///
/// # Safety
/// As [`read_light`].
unsafe fn read_outlines(
    light: &ArealightLight,
    field: &impl Fn(&'static str) -> String,
) -> Result<Vec<Vec<DVec3>>, Failure> {
    let count = light.vertex_count as usize;
    check_count(count, || field("vertex_count"))?;
    let hole_count = if light.kind == AREALIGHT_LIGHT_POLYGON { light.hole_count as usize } else { 0 };
    // SAFETY: the same contract.
    let (holes, vertices) = unsafe {
        let holes = arguments::array(light.hole_vertex_counts, hole_count, &field("hole_vertex_counts"))?;
        let all = holes.iter().fold(count, |sum, more| sum.saturating_add(*more as usize));
        check_count(all, || field("hole_vertex_counts"))?;
        (holes, arguments::array(light.vertices, all.saturating_mul(3), &field("vertices"))?)
    };
    let mut vertices = vertices.chunks_exact(3).map(DVec3::from_slice);
    let counts = std::iter::once(count).chain(holes.iter().map(|count| *count as usize));
    Ok(counts.map(|count| vertices.by_ref().take(count).collect()).collect())
}

/// The texture coordinates of a textured polygon; none of others.
///
/// # Safety
/// As [`read_light`].
unsafe fn read_coordinates(
    light: &ArealightLight,
    field: &impl Fn(&'static str) -> String,
) -> Result<Vec<DVec2>, Failure> {
    let count = if light.textured == 0 { 0 } else { 2 * light.vertex_count as usize };
    // SAFETY: the same contract.
    let uvs = unsafe { arguments::array(light.texture_coordinates, count, &field("texture_coordinates")) }?;
    Ok(uvs.chunks_exact(2).map(DVec2::from_slice).collect())
}
