//! Polygon lights as the GPU reads them.

use crate::Effects;
use crate::gpu::GpuLight;
use crate::light::{LightError, PolygonLight};
use crate::light_texture::TextureMap;
use crate::mesh::area_of;
use glam::DVec3;

/// Rows of a texture's place in the vertex buffer.
const TEXTURE_ROWS: usize = 4;

fn flags(light: &PolygonLight) -> u32 {
    let flag = |on: bool, flag: u32| if on { flag } else { 0 };
    flag(light.two_sided, GpuLight::TWO_SIDED)
        | flag(light.is_flat(), GpuLight::FLAT)
        | flag(light.is_mesh(), GpuLight::MESH)
        | flag(light.is_convex_quad(), GpuLight::QUAD)
}

/// Lights as the GPU reads them, relative to an origin.
#[derive(Debug, Clone, PartialEq)]
pub struct PackedLights {
    /// One record a light: convex quads without an image first, else in the given order.
    pub lights: Vec<GpuLight>,
    /// Of each light its vertices' positions relative to its center, in xyz. A mesh has before each face's vertices a row with the
    /// face's unit normal in xyz and their count in w. After the vertices of a light with a texture come four rows, its place:
    /// (corner, lowest u), (axis of u, lowest v), (axis of v, extent in u), (extent in v, 0, 0, 0), see
    /// [`TextureMap`].
    pub vertices: Vec<[f32; 4]>,
    /// Which of the given lights each record is of.
    pub order: Vec<u32>,
    /// How many records come first that are convex quads without an image.
    pub quad_count: u32,
    /// What none of the lights calls for, of [`Effects::TWO_SIDED`] and [`Effects::BEYOND_QUADS`].
    pub unused: Effects,
}

impl Default for PackedLights {
    fn default() -> Self {
        let unused = Effects::TWO_SIDED | Effects::BEYOND_QUADS;
        Self { lights: vec![], vertices: vec![], order: vec![], quad_count: 0, unused }
    }
}

impl PackedLights {
    /// Packs `lights` relative to `origin`: the subtraction is made in float64, so that a scene far from the
    /// world's origin shades as well as one at it. Use the same origin for the G-buffer's positions.
    ///
    /// # Errors
    /// The first light that [`PolygonLight::validate`] refuses.
    pub fn new(lights: &[PolygonLight], origin: DVec3) -> Result<Self, LightError> {
        let rows = |light: &PolygonLight| light.vertices.len() + light.faces.len() + TEXTURE_ROWS;
        let count = lights.iter().map(rows).sum::<usize>();
        if u32::try_from(count).is_err() {
            return Err(LightError::TooMany { count });
        }
        let maps = lights.iter().map(PolygonLight::mapped).collect::<Result<Vec<_>, _>>()?;
        let effects: Vec<Effects> = lights.iter().map(PolygonLight::effects).collect();
        let (quads, others): (Vec<usize>, Vec<usize>) =
            (0..lights.len()).partition(|index| !effects[*index].intersects(Effects::BEYOND_QUADS));
        let mut packed = Self { quad_count: quads.len() as u32, ..Self::default() };
        for index in quads.into_iter().chain(others) {
            packed.push(&lights[index], maps[index], origin)?;
            packed.order.push(index as u32);
            packed.unused -= effects[index];
        }
        Ok(packed)
    }

    /// Adds the lights of `other`, which may be packed relative to another origin, after those that are here. Their quads are
    /// counted as such only where none but quads are here.
    ///
    /// # Errors
    /// [`LightError::TooMany`] where a 32-bit index does not reach; then nothing is added.
    pub fn append(&mut self, other: Self) -> Result<(), LightError> {
        let count = (self.vertices.len() + other.vertices.len()).max(self.lights.len() + other.lights.len());
        if u32::try_from(count).is_err() {
            return Err(LightError::TooMany { count });
        }
        if self.quad_count as usize == self.lights.len() {
            self.quad_count += other.quad_count;
        }
        self.unused &= other.unused;
        let before = self.lights.len() as u32;
        self.order.extend(other.order.into_iter().map(|index| before + index));
        let shift = self.vertices.len() as u32;
        self.lights.extend(other.lights.into_iter().map(|mut light| {
            light.first_vertex += shift;
            light
        }));
        self.vertices.extend(other.vertices);
        Ok(())
    }

    fn push(
        &mut self,
        light: &PolygonLight,
        map: Option<TextureMap>,
        origin: DVec3,
    ) -> Result<(), LightError> {
        let first_vertex = self.vertices.len() as u32;
        for (index, &value) in light.vertices.iter().enumerate() {
            if !(value - origin).as_vec3().is_finite() {
                return Err(LightError::VertexNotFinite { light: light.name.clone(), index, value });
            }
        }
        // Subtract the origin in float64, then round once: the center for all, the vertices about the rounded center
        let center = (light.center() - origin).as_vec3();
        let offsets: Vec<DVec3> =
            light.vertices.iter().map(|vertex| *vertex - origin - center.as_dvec3()).collect();
        // The middle lies between the vertices, but two of them may be farther apart than float32 reaches
        if let Some(index) = offsets.iter().position(|offset| !(offset.length() as f32 * 2.0).is_finite()) {
            let value = light.vertices[index];
            return Err(LightError::VertexNotFinite { light: light.name.clone(), index, value });
        }
        let mut radius = offsets.iter().map(|offset| offset.length()).fold(0.0, f64::max);
        if light.is_mesh() {
            radius = radius.max(light.covering_radius());
        }
        self.push_outlines(light, &offsets);
        let vertex_count = self.vertices.len() as u32 - first_vertex;
        if let Some(map) = map {
            // The texture's axes keep their precision as the vertices do
            self.push_texture(map, map.corner - origin - center.as_dvec3());
        }
        let area_vector = light.area_vector();
        let area = area_vector.length() / radius.powi(2);
        self.lights.push(GpuLight {
            radiance: light.radiance.to_array(),
            first_vertex,
            center: center.to_array(),
            radius: (radius as f32).next_up(),
            normal: area_vector.normalize_or_zero().as_vec3().to_array(),
            area: if area.is_finite() { area as f32 } else { 0.0 },
            vertex_count,
            flags: flags(light),
            texture_layer: light.texture.as_ref().map_or(GpuLight::NO_TEXTURE, |texture| texture.layer),
            reserved: 0,
        });
        Ok(())
    }

    /// The rows of an outline, or of the faces of a mesh.
    fn push_outlines(&mut self, light: &PolygonLight, offsets: &[DVec3]) {
        let mut first = 0;
        for face in light.outlines() {
            let vertices = &offsets[first..first + face.len()];
            if light.is_mesh() {
                let normal = area_of(vertices).normalize_or_zero().as_vec3();
                self.vertices.push(normal.extend(face.len() as f32).to_array());
            }
            self.vertices.extend(vertices.iter().map(|offset| offset.as_vec3().extend(0.0).to_array()));
            first += face.len();
        }
    }

    /// The rows of a texture's place, whose corner is `corner` from the light's center.
    fn push_texture(&mut self, map: TextureMap, corner: DVec3) {
        let row = |vector: DVec3, number: f64| vector.as_vec3().extend(number as f32).to_array();
        self.vertices.extend([
            row(corner, map.low.x),
            row(map.axis_u, map.low.y),
            row(map.axis_v, map.size.x),
            [map.size.y as f32, 0.0, 0.0, 0.0],
        ]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::tests::arrow;

    #[test]
    fn quads_come_first_and_every_record_says_whose_it_is() {
        let light = |x: f64, concave: bool, two_sided: bool| {
            let mut light = arrow();
            light.vertices[3].x = if concave { 1.0 } else { -1.0 };
            light.vertices.iter_mut().for_each(|vertex| vertex.x += x);
            PolygonLight { two_sided, ..light }
        };
        let lights = [
            light(0.0, true, false),
            light(1.0, false, false),
            light(2.0, true, true),
            light(3.0, false, false),
        ];
        let mut packed = PackedLights::new(&lights, DVec3::ZERO).unwrap();
        assert_eq!((&packed.order[..], packed.quad_count), (&[1, 3, 0, 2][..], 2));
        assert_eq!(packed.unused, Effects::TEXTURED | Effects::MESH);
        for (record, index) in packed.lights.iter().zip(&packed.order) {
            let first = packed.vertices[record.first_vertex as usize][0] + record.center[0];
            assert!((f64::from(first) - lights[*index as usize].vertices[0].x).abs() < 1e-6);
        }
        // What comes after other lights is not among the first quads
        let quads = || PackedLights::new(&lights[1..2], DVec3::ZERO).unwrap();
        packed.append(quads()).unwrap();
        assert_eq!((&packed.order[..], packed.quad_count), (&[1, 3, 0, 2, 4][..], 2));
        let mut two = quads();
        two.append(quads()).unwrap();
        assert_eq!((two.quad_count, two.unused), (2, Effects::TWO_SIDED | Effects::BEYOND_QUADS));
        assert_eq!(PackedLights::new(&[], DVec3::ZERO).unwrap(), PackedLights::default());
    }

    #[test]
    fn packing_keeps_precision_far_from_the_world_origin() {
        let offset = DVec3::splat(1e7);
        let mut far = arrow();
        for v in &mut far.vertices {
            *v = *v + offset + DVec3::new(1e-3, 0.0, 0.0);
        }
        let packed = PackedLights::new(&[far], offset).unwrap();
        assert!((packed.lights[0].center[0] + packed.vertices[1][0] - 2.001).abs() < 1e-6);
    }
}
