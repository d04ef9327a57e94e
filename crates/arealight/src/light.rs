//! Polygon lights.

use crate::Effects;
use crate::holes::HoleError;
use crate::light_texture::{LightTexture, TextureError, TextureMap};
use crate::mesh::{FaceError, area_of};
use glam::{DVec3, Vec3};

/// How far a vertex of a flat polygon may be off its plane, as a part of its size.
pub(crate) const FLAT: f64 = 1e-4;

/// A flat polygon that emits constant radiance, or shows an image; or several that are one light ([`crate::mesh`]).
///
/// Any number of vertices from three on, convex or concave; its edges do not cross. Holes are cut by
/// [`PolygonLight::cut_holes`]. The front is the right-hand side of the vertex order: seen from the front, the vertices run counter-clockwise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PolygonLight {
    /// A name for messages; it need not be unique.
    pub name: String,
    /// World positions, in the scene's unit of length.
    pub vertices: Vec<DVec3>,
    /// How many of the vertices each face has, one after another; empty for one polygon.
    pub faces: Vec<u32>,
    /// Radiance of the front, W/(m² sr), linear Rec. 709, not negative.
    pub radiance: Vec3,
    /// Whether the back emits too.
    pub two_sided: bool,
    /// An image that multiplies the radiance; the back shows it mirrored, as a slide does.
    pub texture: Option<LightTexture>,
}

/// Why a light cannot be used. The light is named, and nothing is packed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LightError {
    /// A polygon has three vertices or more.
    #[error("light '{light}': vertices: {count} given, a polygon has at least 3")]
    TooFewVertices {
        /// The light's name.
        light: String,
        /// How many vertices it has.
        count: usize,
    },
    /// A vertex is NaN, infinite, or farther from the origin than float32 reaches.
    #[error("light '{light}': vertices[{index}]: {value} is not a finite float32 position")]
    VertexNotFinite {
        /// The light's name.
        light: String,
        /// The vertex.
        index: usize,
        /// Its position.
        value: DVec3,
    },
    /// Radiance is NaN, infinite or negative.
    #[error("light '{light}': radiance: {value} must be finite and not negative")]
    BadRadiance {
        /// The light's name.
        light: String,
        /// The radiance given.
        value: Vec3,
    },
    /// A hole cannot be cut into it.
    #[error("light '{light}': holes[{hole}]: {reason}")]
    BadHole {
        /// The light's name.
        light: String,
        /// The hole.
        hole: usize,
        /// What is wrong.
        reason: HoleError,
    },
    /// Its vertices are not shared out among its faces.
    #[error("light '{light}': {reason}")]
    BadFaces {
        /// The light's name.
        light: String,
        /// What is wrong.
        reason: FaceError,
    },
    /// Its texture cannot be mapped onto it.
    #[error("light '{light}': texture: {reason}")]
    BadTexture {
        /// The light's name.
        light: String,
        /// What is wrong.
        reason: TextureError,
    },
    /// It shows a layer that the lights' textures do not have.
    #[error("light '{light}': texture: layer {layer} is not there: there are {layers}")]
    NoTextureLayer {
        /// The light's name.
        light: String,
        /// The layer that it refers to.
        layer: u32,
        /// How many layers there are.
        layers: u32,
    },
    /// More vertices or lights than a 32-bit index reaches.
    #[error("{count} light vertices: at most {} fit one buffer", u32::MAX)]
    TooMany {
        /// How many there are.
        count: usize,
    },
}

impl PolygonLight {
    /// Checks that the light can be shaded.
    ///
    /// # Errors
    /// [`LightError`] names the light and the field that is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        self.mapped().map(drop)
    }

    /// Checks that the light can be shaded, and maps its texture.
    pub(crate) fn mapped(&self) -> Result<Option<TextureMap>, LightError> {
        let light = || self.name.clone();
        if self.vertices.len() < 3 {
            return Err(LightError::TooFewVertices { light: light(), count: self.vertices.len() });
        }
        for (index, &value) in self.vertices.iter().enumerate() {
            if !value.as_vec3().is_finite() {
                return Err(LightError::VertexNotFinite { light: light(), index, value });
            }
        }
        self.check_faces().map_err(|reason| LightError::BadFaces { light: light(), reason })?;
        if !self.radiance.is_finite() || self.radiance.min_element() < 0.0 {
            return Err(LightError::BadRadiance { light: light(), value: self.radiance });
        }
        let map = self.texture.as_ref().map(|texture| texture.map(self)).transpose();
        map.map_err(|reason| LightError::BadTexture { light: light(), reason })
    }

    /// Area times normal, by Newell's sum over the vertices: its direction is the front, its length the area
    /// (unit of length squared). Zero for a degenerate polygon. Of a mesh the sum over its faces, which is zero for a closed one.
    pub fn area_vector(&self) -> DVec3 {
        self.outlines().map(area_of).sum()
    }

    /// The middle of the area; of the vertices' box for a degenerate polygon. Zero without finite vertices.
    pub fn center(&self) -> DVec3 {
        if self.vertices.is_empty() || !self.vertices.iter().all(|vertex| vertex.is_finite()) {
            return DVec3::ZERO;
        }
        let (low, high) = self
            .vertices
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
        let middle = (low + high) * 0.5;
        // Weigh the triangles of a fan about a vertex of each face, which is in its plane, by their signed areas
        let (mut area, mut moment) = (0.0, DVec3::ZERO);
        let apex = self.vertices[0];
        for outline in self.outlines() {
            let normal = area_of(outline).normalize_or_zero();
            let start = outline.first().copied().unwrap_or_default();
            let next = outline.iter().cycle().skip(1);
            for (a, b) in outline.iter().zip(next) {
                let (a, b) = (*a - start, *b - start);
                let weight = a.cross(b).dot(normal);
                area += weight;
                moment += (a + b + (start - apex) * 3.0) * (weight / 3.0);
            }
        }
        let center = if area > 0.0 { apex + moment / area } else { middle };
        // Rounding has its way with slivers; their middle stays within their box
        if center.is_finite() { center.clamp(low, high) } else { middle }
    }

    /// Whether the outline is convex and flat, both to a ten-thousandth of its size, and has at most four vertices:
    /// what is shaded without [`Effects::POLYGON`], as if its vertices were moved by that much.
    pub fn is_convex_quad(&self) -> bool {
        if self.vertices.len() > 4 || self.is_mesh() {
            return false;
        }
        let normal = self.area_vector().normalize_or_zero();
        // Every corner turns the outline's way, or not at all
        let count = self.vertices.len();
        let convex = (0..count).all(|i| {
            let [a, b, c] = [i, i + 1, i + 2].map(|j| self.vertices[j % count]);
            (b - a).cross(c - b).dot(normal) >= -FLAT * (b - a).length() * (c - b).length()
        });
        convex && self.is_flat()
    }

    /// Whether every vertex lies in one plane, to a ten-thousandth of the outline's size, and every face of a mesh faces one way.
    pub fn is_flat(&self) -> bool {
        let normal = self.area_vector().normalize_or_zero();
        if self.is_mesh() && !self.outlines().all(|outline| area_of(outline).dot(normal) > 0.0) {
            return false;
        }
        let center = self.center();
        let size = self.vertices.iter().map(|v| v.distance(center)).fold(0.0, f64::max);
        self.vertices.iter().all(|v| (*v - center).dot(normal).abs() <= FLAT * size)
    }

    /// Checks that a light that shows an image has its layer among `layers`.
    ///
    /// # Errors
    /// [`LightError::NoTextureLayer`] where it has not: the device would show another.
    pub fn check_texture_layer(&self, layers: u32) -> Result<(), LightError> {
        match &self.texture {
            Some(texture) if texture.layer >= layers => {
                Err(LightError::NoTextureLayer { light: self.name.clone(), layer: texture.layer, layers })
            }
            _ => Ok(()),
        }
    }

    /// What the light calls for.
    pub fn effects(&self) -> Effects {
        let mut effects = Effects::empty();
        effects.set(Effects::TWO_SIDED, self.two_sided);
        effects.set(Effects::POLYGON, !self.is_convex_quad());
        effects.set(Effects::TEXTURED, self.texture.is_some());
        effects.set(Effects::MESH, self.is_mesh());
        effects
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::PackedLights;

    pub(crate) fn arrow() -> PolygonLight {
        // A concave quad in the plane z = 2, counter-clockwise from above, so it emits upwards
        PolygonLight {
            name: "arrow".into(),
            vertices: vec![
                DVec3::new(0.0, 0.0, 2.0),
                DVec3::new(2.0, 1.0, 2.0),
                DVec3::new(0.0, 2.0, 2.0),
                DVec3::new(1.0, 1.0, 2.0),
            ],
            radiance: Vec3::new(1.0, 2.0, 3.0),
            ..PolygonLight::default()
        }
    }

    #[test]
    fn the_front_is_the_right_hand_side() {
        assert_eq!(arrow().area_vector(), DVec3::new(0.0, 0.0, 1.0));
    }

    #[test]
    fn the_center_of_a_tilted_polygon_is_in_its_plane() {
        // The middle of its box is not
        let light = PolygonLight {
            vertices: vec![DVec3::X, DVec3::Y * 2.0, DVec3::Z * 3.0],
            radiance: Vec3::ONE,
            ..PolygonLight::default()
        };
        assert!((light.center() - DVec3::new(1.0, 2.0, 3.0) / 3.0).length() < 1e-15);
    }

    #[test]
    fn bad_lights_are_named_and_refused() {
        let mut light = arrow();
        light.vertices.truncate(2);
        let error = PackedLights::new(&[arrow(), light], DVec3::ZERO).unwrap_err();
        assert_eq!(error.to_string(), "light 'arrow': vertices: 2 given, a polygon has at least 3");
        let mut light = arrow();
        light.vertices[2].y = f64::NAN;
        assert!(matches!(light.validate(), Err(LightError::VertexNotFinite { index: 2, .. })));
        light = arrow();
        light.vertices[1].x = 1e39;
        assert!(matches!(light.validate(), Err(LightError::VertexNotFinite { index: 1, .. })));
        assert_eq!(
            Effects::empty().missing_for(std::slice::from_ref(&light)),
            None,
            "its numbers come first"
        );
        light = arrow();
        light.vertices[0].x = -3e38;
        light.vertices[2].x = 3e38;
        let error = PackedLights::new(&[light], DVec3::ZERO).unwrap_err();
        assert!(matches!(error, LightError::VertexNotFinite { .. }), "{error}");
        light = arrow();
        light.radiance.y = -1.0;
        assert!(matches!(light.validate(), Err(LightError::BadRadiance { .. })));
    }
}
