//! Files of shading points: what is at each, which light shines on it, and what of that is supported yet.
//!
//! The format is described in `tests/data/reference/README.md`. Reading is strict: what is wrong is named by
//! case and field. A field that is not known does not fail the file, but its case counts as not supported,
//! for an answer that ignores a field would look like an answer to it.

mod coat;
mod fields;
mod material;
mod strict;
mod supported;

use arealight::{Light, LightShape, LightTexture, Opening, Profile, TubeEnds};
use arealight_oracle::material::Surface;
use arealight_oracle::texture::Texture;
use arealight_oracle::visibility::Blocker;
pub use coat::CaseCoat;
pub(crate) use fields::json;
use fields::{Fields, each};
use glam::DVec3;
pub use material::CaseMaterial;
use std::sync::Arc;

/// Why a file of cases or answers cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError {
    /// The text is not JSON.
    #[error("not JSON: {message}")]
    NotJson {
        /// What the parser found, and where.
        message: String,
    },
    /// The outermost value is not what the format says.
    #[error("{field}: {message}")]
    File {
        /// The field.
        field: String,
        /// What is wrong with it.
        message: String,
    },
    /// A case has a field that is missing or has a wrong value.
    #[error("case '{case}': {field}: {message}")]
    Case {
        /// The case's name, or its place in the file if it has none.
        case: String,
        /// The field, for example `light.vertices[2]`.
        field: String,
        /// What is wrong with it.
        message: String,
    },
}

/// A shading point: a surface, a viewer and a light.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The name, unique in its file.
    pub name: String,
    /// Position of the shading point.
    pub position: DVec3,
    /// Surface normal, not zero, of any length; in a medium, which has none, where light goes on to.
    pub normal: DVec3,
    /// Direction that `alpha_x` runs along, once projected onto the surface.
    pub tangent: Option<DVec3>,
    /// Direction from the point to the viewer, not zero, of any length.
    pub view: DVec3,
    /// What the surface is made of.
    pub material: CaseMaterial,
    /// The light in the world; the layer of its image is 0.
    pub light: Light,
    /// Its radiance in all digits, W/(m² sr), not negative.
    pub radiance: DVec3,
    /// Path beside the file of cases of the image that the radiance is multiplied with.
    pub image: Option<String>,
    /// Triangles in the world that block light from both sides and reflect nothing.
    pub blockers: Vec<Blocker>,
    /// Fields of the file that the format does not know, in words: what each is, and is like.
    pub unknown_fields: Vec<String>,
}

/// A case that can be answered, relative to its point: the inputs of [`arealight_oracle::shading`] and of the
/// GPU's eval kernels.
#[derive(Debug, Clone, PartialEq)]
pub struct SupportedCase {
    /// The case's name.
    pub name: String,
    /// What the point is on; without lobes where it is in a medium.
    pub surface: Surface,
    /// Surface normal, not zero, of any length.
    pub normal: DVec3,
    /// Henyey and Greenstein's g, where the point is in a medium.
    pub medium: Option<f64>,
    /// Direction to the viewer, not zero, of any length.
    pub view: DVec3,
    /// The light; the layer of its image is 0.
    pub light: Light,
    /// Its radiance in all digits, which float64 answers have.
    pub radiance: DVec3,
    /// The image that it shows.
    pub image: Option<Arc<Texture>>,
    /// What blocks the light.
    pub blockers: Vec<Blocker>,
}

/// Reads a file of cases.
///
/// # Errors
/// [`CaseError`] says which case and field is wrong.
pub fn read_cases(text: &str) -> Result<Vec<Case>, CaseError> {
    let mut cases = vec![];
    each(text, "cases", "a file of cases is {\"cases\": [...]}", |index, value| {
        cases.push(read_case(index, value)?);
        Ok(())
    })?;
    // Answers are found by name, so no two cases may share one
    let mut seen = std::collections::HashSet::new();
    match cases.iter().find(|case| !seen.insert(case.name.as_str())) {
        None => Ok(cases),
        Some(case) => Err(CaseError::Case {
            case: case.name.clone(),
            field: "name".into(),
            message: "another case has the same name".into(),
        }),
    }
}

fn read_case(index: usize, value: &serde_json::Value) -> Result<Case, CaseError> {
    let fields = Fields::of_case(index, value)?;
    let of_light = fields.object("light")?;
    let (light, image, unknown_of_light) = read_light(&of_light)?;
    let material = CaseMaterial::read(&fields)?;
    let view = fields.direction("view")?;
    let case = Case {
        name: fields.name().to_owned(),
        position: fields.vector("position")?,
        normal: match material {
            CaseMaterial::Medium { .. } => -view,
            _ => fields.direction("normal")?,
        },
        tangent: fields.optional("tangent", Fields::direction)?,
        view,
        material,
        light: Light { name: fields.name().to_owned(), ..light },
        radiance: of_light.color("radiance", f64::INFINITY)?,
        image,
        blockers: fields
            .optional("occluders", |f, field| f.list(field, Fields::triangle_at))?
            .unwrap_or_default(),
        unknown_fields: [fields.unread(), unknown_of_light].concat(),
    };
    Ok(case)
}

/// A light, the path of its image, and the fields that are not known.
fn read_light(fields: &Fields) -> Result<(Light, Option<String>, Vec<String>), CaseError> {
    let radiance = fields.color("radiance", f64::INFINITY)?.as_vec3();
    let two_sided = fields.optional("two_sided", Fields::boolean)?.unwrap_or(false);
    let kind = fields.text("type")?;
    let mut image = None;
    if ["polygon", "disk"].contains(&kind) {
        image = fields.optional("texture", Fields::text)?.map(str::to_owned);
    }
    let mut uvs = vec![];
    let shape = match kind {
        "polygon" => {
            let vertices = read_vertices(fields)?;
            if image.is_some() {
                uvs = fields.list("uv", Fields::pair_at)?;
                if uvs.len() != vertices.len() {
                    let message = format!("{} given for {} vertices", uvs.len(), vertices.len());
                    return Err(fields.error("uv", &message));
                }
            }
            LightShape::Polygon(vertices)
        }
        "disk" => LightShape::Disk {
            center: fields.vector("center")?,
            axis_u: fields.direction("axis_u")?,
            axis_v: fields.direction("axis_v")?,
        },
        "sphere" => LightShape::Sphere { center: fields.vector("center")?, radius: fields.length("radius")? },
        "cylinder" => LightShape::Tube {
            p0: fields.vector("p0")?,
            p1: fields.vector("p1")?,
            radius: fields.length("radius")?,
            // It emits outwards, whatever is said of its sides
            ends: match fields.optional("caps", Fields::boolean)? {
                Some(true) => TubeEnds::Flat,
                _ => TubeEnds::Open,
            },
        },
        other => {
            let message =
                format!("\"{other}\" is not known; \"polygon\", \"disk\", \"sphere\" and \"cylinder\" are");
            return Err(fields.error("type", &message));
        }
    };
    let opening = fields.has("opening").then(|| fields.object("opening")).transpose()?;
    let light = Light {
        radiance,
        two_sided,
        texture: image.as_ref().map(|_| LightTexture { layer: 0, uvs }),
        profile: read_profile(fields)?,
        opening: opening.as_ref().map(read_opening).transpose()?,
        shape,
        ..Light::default()
    };
    Ok((light, image, [fields.unread(), opening.map_or_else(Vec::new, |it| it.unread())].concat()))
}

fn read_opening(fields: &Fields) -> Result<Opening, CaseError> {
    Ok(Opening {
        center: fields.vector("center")?,
        axis_u: fields.direction("axis_u")?,
        axis_v: fields.direction("axis_v")?,
        housed: fields.optional("housed", Fields::boolean)?.unwrap_or(false),
    })
}

/// Levels of a profile where a case says nothing of them.
const LEVELS: f64 = 4.0;

fn read_profile(fields: &Fields) -> Result<Option<Profile>, CaseError> {
    let levels = fields.optional("profile_levels", Fields::number)?.unwrap_or(LEVELS);
    if levels.fract() != 0.0 {
        return Err(fields.error("profile_levels", &format!("{levels} must be a whole number")));
    }
    let rows = fields.optional("profile", |f, field| f.list(field, Fields::row_at))?;
    let profile = rows.map(|rows| Profile::new(&rows, levels as u32)).transpose();
    profile.map_err(|fault| fields.error("profile", &fault.to_string()))
}

fn read_vertices(fields: &Fields) -> Result<Vec<DVec3>, CaseError> {
    let vertices: Vec<DVec3> = fields.list("vertices", Fields::vector_at)?;
    if vertices.len() < 3 {
        let message = format!("{} given, a polygon has at least 3", vertices.len());
        return Err(fields.error("vertices", &message));
    }
    if let Some((index, distance)) = vertex_off_plane(&vertices) {
        let message = format!("{distance:.3e} off the plane of the others; a polygon light is flat");
        return Err(fields.error(&format!("vertices[{index}]"), &message));
    }
    Ok(vertices)
}

/// The vertex that lies farthest off the polygon's plane, if that is more than a thousandth of its size: far
/// more than the rounding of positions in float32 makes, and enough to see.
fn vertex_off_plane(vertices: &[DVec3]) -> Option<(usize, f64)> {
    let center = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
    let offsets: Vec<DVec3> = vertices.iter().map(|v| *v - center).collect();
    let next = offsets.iter().cycle().skip(1);
    let normal = offsets.iter().zip(next).map(|(a, b)| a.cross(*b)).sum::<DVec3>().normalize_or_zero();
    let size = offsets.iter().map(|o| o.length()).fold(0.0, f64::max);
    let distances = offsets.iter().map(|o| o.dot(normal).abs()).enumerate();
    distances.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, distance)| *distance > 1e-3 * size)
}

#[cfg(test)]
mod tests;
