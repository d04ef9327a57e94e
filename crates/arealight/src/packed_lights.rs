//! Polygon lights as the GPU reads them.

use crate::Effects;
use crate::gpu::GpuLight;
use crate::light::{LightError, PolygonLight};
use crate::light_texture::TextureMap;
use glam::DVec3;

fn flags(light: &PolygonLight) -> u32 {
    let flag = |on: bool, flag: u32| if on { flag } else { 0 };
    flag(light.two_sided, GpuLight::TWO_SIDED) | flag(light.is_flat(), GpuLight::FLAT)
}

/// Lights as the GPU reads them, relative to an origin.
#[derive(Debug, Clone, PartialEq)]
pub struct PackedLights {
    /// One record a light: convex quads without an image first, else in the given order.
    pub lights: Vec<GpuLight>,
    /// Vertex positions relative to their light's center, in xyz; w is zero, but with the first vertex of a face of a mesh how many
    /// vertices the face has.
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
        let count = lights.iter().map(|light| light.vertices.len()).sum::<usize>().max(lights.len());
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
        self.vertices.extend(offsets.iter().map(|offset| offset.as_vec3().extend(0.0).to_array()));
        // The middle lies between the vertices, but two of them may be farther apart than float32 reaches
        if let Some(index) = offsets.iter().position(|offset| !(offset.length() as f32 * 2.0).is_finite()) {
            self.vertices.truncate(first_vertex as usize);
            let value = light.vertices[index];
            return Err(LightError::VertexNotFinite { light: light.name.clone(), index, value });
        }
        let mut radius = offsets.iter().map(|offset| offset.length()).fold(0.0, f64::max);
        if light.is_mesh() {
            radius = radius.max(light.covering_radius());
            let mut first = first_vertex as usize;
            for &count in &light.faces {
                self.vertices[first][3] = count as f32;
                first += count as usize;
            }
        }
        let area = light.area_vector() / radius.powi(2);
        // The texture's axes keep their precision as the vertices do
        let corner = map.map(|map| map.corner - origin - center.as_dvec3()).unwrap_or_default();
        let map = map.unwrap_or_default();
        self.lights.push(GpuLight {
            radiance: light.radiance.to_array(),
            first_vertex,
            center: center.to_array(),
            radius: (radius as f32).next_up(),
            area: if area.is_finite() { area.as_vec3().to_array() } else { [0.0; 3] },
            vertex_count: light.vertices.len() as u32,
            flags: flags(light),
            texture_layer: light.texture.as_ref().map_or(GpuLight::NO_TEXTURE, |texture| texture.layer),
            reserved: [0; 2],
            texture_corner: corner.as_vec3().to_array(),
            reserved_corner: 0,
            texture_axis_u: map.axis_u.as_vec3().to_array(),
            reserved_axis_u: 0,
            texture_axis_v: map.axis_v.as_vec3().to_array(),
            reserved_axis_v: 0,
            texture_low: map.low.as_vec2().to_array(),
            texture_size: map.size.as_vec2().to_array(),
        });
        Ok(())
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
