//! Textured lights: a layer of the light textures, mapped onto a polygon or disk.

use crate::LightShape;
use crate::light_fault::LightFault;
use glam::{DMat2, DVec2, DVec3};

/// An image that multiplies a light's radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct LightTexture {
    /// The layer of the light textures (see [`crate::pyramid`]).
    pub layer: u32,
    /// A texture coordinate for each vertex of a polygon, in [0, 1]; (0, 0) is the outer corner of the first
    /// texel of the top row. They are an affine function of the vertices' positions, as those of a triangle
    /// always are.
    ///
    /// None for a disk: seen from its front, the image's rows run along `axis_u` and the top row is where
    /// `axis_v` points to; the disk is what is seen of it within the parallelogram of both, which touches its
    /// edges.
    ///
    /// What lies outside of an image, when it is repeated, is loaded into a layer of its own.
    pub uvs: Vec<DVec2>,
}

/// A texture's place in the world: `corner + axis_u s + axis_v t` shows the texture coordinate
/// `low + size (s, t)`.
///
/// `s` and `t` are *box coordinates*: from 0 to 1 over the box around what the light shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TextureMap {
    /// Where the box begins.
    pub corner: DVec3,
    /// Along the image's rows, as long as the box.
    pub axis_u: DVec3,
    /// Along its columns.
    pub axis_v: DVec3,
    /// Texture coordinates of the box's corner.
    pub low: DVec2,
    /// Its extent in them.
    pub size: DVec2,
}

/// How far a coordinate may be off the affine map: a quarter of a texel of the largest texture.
const STRAIGHT: f64 = 0.25 / crate::pyramid::PyramidSize::LARGEST as f64;

/// How far a coordinate may be outside of [0, 1], from rounding in files.
const OUTSIDE: f64 = 1e-5;

impl TextureMap {
    /// How many times as wide as high the whole layer is on the light.
    pub fn aspect(&self) -> f64 {
        self.axis_u.length() / self.size.x / (self.axis_v.length() / self.size.y)
    }

    /// The longer side of the whole layer on the light, in roots of its area; at least 1.
    pub fn longer(&self) -> f64 {
        self.aspect().max(self.aspect().recip()).sqrt()
    }

    /// The texture coordinate of a position in the light's plane.
    pub fn coordinate(&self, position: DVec3) -> DVec2 {
        // Dual axes in the plane
        let normal = self.axis_u.cross(self.axis_v);
        let offset = position - self.corner;
        let along = DVec2::new(offset.cross(self.axis_v).dot(normal), self.axis_u.cross(offset).dot(normal));
        self.low + self.size * (along / normal.length_squared())
    }
}

impl LightTexture {
    /// Checks the coordinates, and maps them onto `shape`, whose vertices are valid.
    ///
    /// # Errors
    /// [`LightFault`] says what is wrong with them.
    pub fn map(&self, shape: &LightShape) -> Result<TextureMap, LightFault> {
        match *shape {
            LightShape::Mesh { .. } if shape.is_mesh() => return Err(LightFault::TextureOfMesh),
            LightShape::Polygon(_) | LightShape::Mesh { .. } => {}
            LightShape::Disk { center, axis_u, axis_v } => {
                return Ok(TextureMap {
                    corner: center - axis_u + axis_v,
                    axis_u: axis_u * 2.0,
                    axis_v: axis_v * -2.0,
                    low: DVec2::ZERO,
                    size: DVec2::ONE,
                });
            }
            LightShape::Sphere { .. } | LightShape::Tube { .. } => return Err(LightFault::TextureOfSolid),
        }
        let (uvs, vertices) = (&self.uvs, shape.vertices());
        if uvs.len() != vertices.len() {
            return Err(LightFault::TextureCount { uvs: uvs.len(), vertices: vertices.len() });
        }
        let inside = |uv: &DVec2| uv.min_element() >= -OUTSIDE && uv.max_element() <= 1.0 + OUTSIDE;
        if let Some(index) = uvs.iter().position(|uv| !inside(uv)) {
            return Err(LightFault::TextureOutside { index, value: uvs[index] });
        }

        // Work in the polygon's plane, in units of its size
        let center = shape.center();
        let scale = vertices.iter().map(|vertex| vertex.distance(center)).fold(0.0, f64::max);
        let normal = shape.area_vector().try_normalize().ok_or(LightFault::TextureFlat)?;
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        let flat = |vertex: &DVec3| {
            let offset = (*vertex - center) / scale;
            DVec2::new(offset.dot(tangent), offset.dot(bitangent))
        };

        // Fit uv = mean_uv + to_uv (p - mean_p) by least squares
        let count = vertices.len() as f64;
        let mean_p = vertices.iter().map(flat).sum::<DVec2>() / count;
        let mean_uv = uvs.iter().sum::<DVec2>() / count;
        let (mut spread, mut cross) = (DMat2::ZERO, DMat2::ZERO);
        for (vertex, uv) in vertices.iter().zip(uvs) {
            let (p, uv) = (flat(vertex) - mean_p, *uv - mean_uv);
            spread += DMat2::from_cols(p * p.x, p * p.y);
            cross += DMat2::from_cols(uv * p.x, uv * p.y);
        }
        let to_uv = cross * spread.inverse();
        let from_uv = to_uv.inverse();
        if !to_uv.is_finite() || !from_uv.is_finite() || to_uv.determinant().abs() < 1e-12 {
            return Err(LightFault::TextureFlat);
        }
        let off = |index: usize| (mean_uv + to_uv * (flat(&vertices[index]) - mean_p)).distance(uvs[index]);
        let worst = (0..uvs.len()).max_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(0);
        if off(worst) > STRAIGHT {
            return Err(LightFault::TextureBent { index: worst, off: off(worst) });
        }

        // The box around the coordinates, back in the world
        let low = uvs.iter().copied().fold(DVec2::INFINITY, DVec2::min).clamp(DVec2::ZERO, DVec2::ONE);
        let high = uvs.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max).clamp(DVec2::ZERO, DVec2::ONE);
        let world = |flat: DVec2| (tangent * flat.x + bitangent * flat.y) * scale;
        let size = high - low;
        Ok(TextureMap {
            corner: center + world(mean_p + from_uv * (low - mean_uv)),
            axis_u: world(from_uv * DVec2::new(size.x, 0.0)),
            axis_v: world(from_uv * DVec2::new(0.0, size.y)),
            low,
            size,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Light;
    use glam::Vec3;

    fn screen() -> Light {
        let corner = |x: f64, y: f64| DVec3::new(x, y, 3.0);
        Light {
            name: "screen".into(),
            shape: LightShape::Polygon(vec![
                corner(0.0, 0.0),
                corner(2.0, 0.0),
                corner(2.0, 1.0),
                corner(0.0, 1.0),
            ]),
            radiance: Vec3::ONE,
            texture: Some(LightTexture {
                layer: 0,
                uvs: vec![DVec2::new(0.0, 1.0), DVec2::ONE, DVec2::new(1.0, 0.5), DVec2::new(0.0, 0.5)],
            }),
            ..Light::default()
        }
    }

    fn map(light: &Light) -> Result<TextureMap, LightFault> {
        light.texture.as_ref().unwrap().map(&light.shape)
    }

    #[test]
    fn a_rectangle_shows_the_part_that_its_coordinates_say() {
        let map = map(&screen()).unwrap();
        assert!((map.corner - DVec3::new(0.0, 1.0, 3.0)).length() < 1e-12, "{map:?}");
        assert!((map.axis_u - DVec3::new(2.0, 0.0, 0.0)).length() < 1e-12, "{map:?}");
        assert!((map.axis_v - DVec3::new(0.0, -1.0, 0.0)).length() < 1e-12, "{map:?}");
        assert_eq!((map.low, map.size), (DVec2::new(0.0, 0.5), DVec2::new(1.0, 0.5)));
    }

    #[test]
    fn a_triangle_has_the_box_around_its_coordinates() {
        let mut light = screen();
        light.shape = LightShape::Polygon(light.shape.vertices()[..3].to_vec());
        light.texture.as_mut().unwrap().uvs = vec![DVec2::ZERO, DVec2::X, DVec2::new(0.5, 1.0)];
        let map = map(&light).unwrap();
        // The apex, (2, 1), is half way along u and all along v
        let apex = map.corner + map.axis_u * 0.5 + map.axis_v;
        assert!((apex - DVec3::new(2.0, 1.0, 3.0)).length() < 1e-12, "{map:?}");
    }

    #[test]
    fn what_cannot_be_mapped_is_named() {
        let with = |uvs: &[[f64; 2]]| {
            let mut light = screen();
            light.texture.as_mut().unwrap().uvs = uvs.iter().map(|uv| DVec2::from_array(*uv)).collect();
            light
        };
        let light = with(&[[0.0, 0.0]]);
        assert_eq!(map(&light), Err(LightFault::TextureCount { uvs: 1, vertices: 4 }));
        assert_eq!(
            light.validate().unwrap_err().to_string(),
            "texture: uvs: 1 given for 4 vertices; give one each"
        );
        let outside = with(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]);
        assert!(matches!(map(&outside), Err(LightFault::TextureOutside { index: 1, .. })));
        let not_a_number = with(&[[0.0, 0.0], [1.0, 0.0], [1.0, f64::NAN], [0.0, 1.0]]);
        assert!(matches!(map(&not_a_number), Err(LightFault::TextureOutside { index: 2, .. })));
        let bent = with(&[[0.0, 0.0], [1.0, 0.0], [0.7, 0.7], [0.0, 1.0]]);
        assert!(matches!(map(&bent), Err(LightFault::TextureBent { .. })));
        let line = with(&[[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 0.0]]);
        assert_eq!(map(&line), Err(LightFault::TextureFlat));
    }
}
