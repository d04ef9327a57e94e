//! Lights as the GPU reads them.

use crate::azimuth::{HARMONICS, PLACES};
use crate::gpu::{GpuLight, GpuShape};
use crate::light_fault::{LightError, LightFault};
use crate::light_shape::area_of;
use crate::light_texture::TextureMap;
use crate::{Effects, Light, LightShape, Profile, face_clusters};
use glam::DVec3;

mod shapes;

/// Rows of a texture's place in the vertex buffer.
const TEXTURE_ROWS: usize = 4;

/// The most rows of an opening and a profile, and of the disk that has them.
const SHAPING_ROWS: usize = 11
    + Profile::MAX_LEVELS as usize
    + Profile::PIECES
    + (PLACES + 1) * HARMONICS / 2
    + Light::DISK_CORNERS as usize;

/// Lights as the GPU reads them, relative to an origin. The arrays are uploaded to a buffer each;
/// [`PackedLights::summary`] goes to the frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PackedLights {
    /// One record per polygon or mesh: convex quads without a texture first, else in the given order.
    pub lights: Vec<GpuLight>,
    /// Of each of these its vertices' positions relative to its center, in xyz. A mesh has before each face's
    /// vertices a row with the face's unit normal in xyz and their count in w. After the vertices of a
    /// textured light come four rows, its image's place: (corner, lowest u), (axis of u, lowest v), (axis of
    /// v, extent in u), (extent in v, 0, 0, 0), see [`TextureMap`]. After those come the rows of its opening
    /// (`lights/opening.glsl`), and then of its profile (`lights/profile.glsl`).
    pub vertices: Vec<[f32; 4]>,
    /// One record per disk, sphere or tube: by kind in this order, else in the given one.
    pub shapes: Vec<GpuShape>,
    /// Which of the given lights each record of [`PackedLights::lights`] is of.
    pub order: Vec<u32>,
    /// Which of the given lights each record of [`PackedLights::shapes`] is of.
    pub shape_order: Vec<u32>,
    quad_count: u32,
    effects: Effects,
}

/// What a frame needs to know of its packed lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct LightSummary {
    /// How many records [`PackedLights::lights`] has.
    pub light_count: u32,
    /// How many of the first are convex quads without a texture, which have a loop of their own.
    pub quad_count: u32,
    /// How many records [`PackedLights::shapes`] has.
    pub shape_count: u32,
    /// The effects that the lights need, and so which kinds there are.
    pub effects: Effects,
}

impl LightSummary {
    /// Whether there are polygons or meshes beyond the quads.
    pub fn has_polygons(self) -> bool {
        self.light_count > self.quad_count
    }

    /// The quads alone.
    #[must_use]
    pub fn quads(self) -> Self {
        let effects = self.effects & Effects::OF_ANY_KIND;
        Self { light_count: self.quad_count, shape_count: 0, effects, ..self }
    }
}

impl PackedLights {
    /// Checks and packs `lights` relative to `origin`: the subtraction is made in float64, so that a scene
    /// far from the world's origin shades as well as one at it. Use the same origin for the G-buffer's
    /// positions.
    ///
    /// # Errors
    /// [`LightError`] names a light that cannot be shaded, by its index, and the field that is wrong.
    pub fn new(lights: &[Light], origin: DVec3) -> Result<Self, LightError> {
        check_rows(lights)?;
        let effects: Vec<Effects> = lights.iter().map(Light::effects).collect();
        let mut indices: Vec<usize> = (0..lights.len()).collect();
        indices.sort_by_key(|index| rank(effects[*index]));
        let mut packed = Self::default();
        for index in indices {
            let light = &*lights[index].outlined();
            let pushed = if light.shape.is_polygonal() {
                packed.order.push(index as u32);
                packed.push(light, origin)
            } else {
                packed.shape_order.push(index as u32);
                light.pack_shape(origin).map(|shape| packed.shapes.push(shape))
            };
            pushed.map_err(|fault| fault.of(index, &light.name))?;
            packed.quad_count += u32::from(rank(effects[index]) == QUAD);
            packed.effects |= effects[index];
        }
        Ok(packed)
    }

    /// The row of [`PackedLights::vertices`] of each vertex of a record, in the order of
    /// [`LightShape::vertices`].
    pub fn vertex_rows(&self, record: &GpuLight) -> Vec<u32> {
        let (mut row, end) = (record.first_vertex, record.first_vertex + record.vertex_count);
        if record.flags & GpuLight::MESH == 0 {
            return (row..end).collect();
        }
        let mut rows = vec![];
        while let Some(head) = self.vertices.get(row as usize).filter(|_| row < end) {
            if head[3] < 0.0 {
                row += face_clusters::ROWS as u32;
            } else {
                let count = head[3] as u32;
                rows.extend(row + 1..=row + count);
                row += 1 + count;
            }
        }
        rows
    }

    /// What a frame needs to know of the lights.
    pub fn summary(&self) -> LightSummary {
        LightSummary {
            light_count: self.lights.len() as u32,
            quad_count: self.quad_count,
            shape_count: self.shapes.len() as u32,
            effects: self.effects,
        }
    }

    /// Adds the lights of `other`, which may be packed relative to another origin, after those that are here.
    /// Their quads are counted as such only where no polygons but quads are here.
    ///
    /// # Errors
    /// [`LightError`] where a 32-bit index does not reach; then nothing is added.
    pub fn append(&mut self, other: Self) -> Result<(), LightError> {
        let before = self.order.len() + self.shape_order.len();
        let added = other.order.len() + other.shape_order.len();
        let count = (self.vertices.len() + other.vertices.len()).max(before + added);
        if u32::try_from(count).is_err() {
            let fault = LightFault::TooManyVertices { count };
            return Err(LightError { index: before, name: String::new(), fault });
        }
        if self.quad_count as usize == self.lights.len() {
            self.quad_count += other.quad_count;
        }
        self.effects |= other.effects;
        let place = |index: u32| before as u32 + index;
        self.order.extend(other.order.into_iter().map(place));
        self.shape_order.extend(other.shape_order.into_iter().map(place));
        let shift = self.vertices.len() as u32;
        self.lights.extend(other.lights.into_iter().map(|mut light| {
            light.first_vertex += shift;
            light.shaping += if light.flags & GpuLight::SHAPED == 0 { 0 } else { shift };
            light
        }));
        self.vertices.extend(other.vertices);
        self.shapes.extend(other.shapes);
        Ok(())
    }

    /// Adds a polygon or mesh.
    fn push(&mut self, light: &Light, origin: DVec3) -> Result<(), LightFault> {
        let map = light.mapped()?;
        let (shape, vertices) = (&light.shape, light.shape.vertices());
        let first_vertex = self.vertices.len() as u32;
        for (index, &value) in vertices.iter().enumerate() {
            if !(value - origin).as_vec3().is_finite() {
                return Err(LightFault::VertexNotFinite { index, value });
            }
        }
        // Subtract the origin in float64, then round once: the center for all, the vertices about the rounded
        // center
        let center = (shape.center() - origin).as_vec3();
        let offsets: Vec<DVec3> =
            vertices.iter().map(|vertex| *vertex - origin - center.as_dvec3()).collect();
        // The middle lies between the vertices, but two of them may be farther apart than float32 reaches
        if let Some(index) = offsets.iter().position(|offset| !(offset.length() as f32 * 2.0).is_finite()) {
            return Err(LightFault::VertexNotFinite { index, value: vertices[index] });
        }
        let mut radius = offsets.iter().map(|offset| offset.length()).fold(0.0, f64::max);
        if shape.is_mesh() {
            radius = radius.max(shape.covering_radius(light.two_sided));
        }
        self.push_outlines(shape, &offsets, origin + center.as_dvec3());
        let vertex_count = self.vertices.len() as u32 - first_vertex;
        if let Some(map) = map {
            // The texture's axes keep their precision as the vertices do
            self.push_texture(map, map.corner - origin - center.as_dvec3());
        }
        let shaping = if light.is_shaped() { self.vertices.len() as u32 } else { 0 };
        if let Some(opening) = &light.opening {
            self.vertices.extend(opening.rows(vertices, origin));
        }
        if let Some(profile) = &light.profile {
            self.push_profile(profile, shape.first_edge());
        }
        let greatest = light.profile.as_ref().map_or(1.0, Profile::greatest);
        let area_vector = shape.area_vector();
        let area = area_vector.length() / radius.powi(2);
        self.lights.push(GpuLight {
            radiance: (light.radiance * greatest as f32).to_array(),
            first_vertex,
            center: center.to_array(),
            radius: (radius as f32).next_up(),
            normal: area_vector.normalize_or_zero().as_vec3().to_array(),
            area: if area.is_finite() { area as f32 } else { 0.0 },
            vertex_count,
            flags: flags(light),
            texture_layer: light.texture.as_ref().map_or(GpuLight::NO_TEXTURE, |texture| texture.layer),
            shaping,
        });
        Ok(())
    }

    /// The rows of an outline, or of the faces of a mesh and their clusters, about `center`.
    fn push_outlines(&mut self, shape: &LightShape, offsets: &[DVec3], center: DVec3) {
        let clusters = shape.clusters().rows(shape.faces().len(), center);
        let mut clusters = clusters.into_iter().peekable();
        let mut first = 0;
        for (index, face) in shape.outlines().enumerate() {
            while let Some((_, rows)) = clusters.next_if(|(face, _)| *face == index) {
                self.vertices.extend(rows);
            }
            let vertices = &offsets[first..first + face.len()];
            if shape.is_mesh() {
                let normal = area_of(vertices).normalize_or_zero().as_vec3();
                self.vertices.push(normal.extend(face.len() as f32).to_array());
            }
            self.vertices.extend(vertices.iter().map(|offset| offset.as_vec3().extend(0.0).to_array()));
            first += face.len();
        }
    }

    /// The rows of a profile, its greatest factor being 1; azimuth 0 is along `axis`.
    fn push_profile(&mut self, profile: &Profile, axis: DVec3) {
        let parts = DVec3::new(1.0, profile.greatest(), profile.greatest());
        let places: Vec<DVec3> = profile.places().into_iter().map(|place| place / parts).collect();
        let row = |place: DVec3, number: f64| place.as_vec3().extend(number as f32).to_array();
        self.vertices.push([
            profile.scale() as f32,
            profile.levels().len() as f32,
            profile.piece_scale() as f32,
            (if profile.harmonics().is_empty() { 1.0 } else { -1.0 }) * profile.crowding() as f32,
        ]);
        self.vertices.extend(profile.levels().iter().map(|cosine| {
            let tangents = (1.0 - cosine * cosine) / (cosine * cosine);
            row(profile.place(&places, *cosine), tangents)
        }));
        self.vertices.extend(places.windows(2).map(|pair| {
            let step = pair[1] - pair[0];
            row(pair[0], step.y / step.x)
        }));
        self.vertices.extend(places.last().map(|place| row(DVec3 { y: 0.0, ..*place }, 0.0)));
        let harmonics = profile.harmonics().as_flattened();
        self.vertices.extend((!harmonics.is_empty()).then(|| row(axis, 0.0)));
        self.vertices.extend(
            harmonics
                .as_chunks()
                .0
                .iter()
                .map(|[a, b]| [a.x, a.y, b.x, b.y].map(|coefficient| coefficient as f32)),
        );
    }

    /// The rows of a texture's place, whose corner is `corner` from the light's center.
    fn push_texture(&mut self, map: TextureMap, corner: DVec3) {
        let row = |vector: DVec3, number: f64| vector.as_vec3().extend(number as f32).to_array();
        self.vertices.extend([
            row(corner, map.low.x),
            row(map.axis_u, map.low.y),
            row(map.axis_v, map.size.x),
            [map.size.y as f32, map.longer() as f32, 0.0, 0.0],
        ]);
    }
}

/// The rank of convex quads without a texture.
const QUAD: u32 = 0;

/// Where lights of these effects are in the order of records.
fn rank(effects: Effects) -> u32 {
    match effects - Effects::OF_ANY_KIND {
        kind if kind.is_empty() => QUAD,
        kind if kind.contains(Effects::ELLIPSE) => 2,
        kind if kind.contains(Effects::SPHERE) => 3,
        kind if kind.contains(Effects::TUBE) => 4,
        _ => 1,
    }
}

/// Checks that a 32-bit index reaches every row of vertices.
fn check_rows(lights: &[Light]) -> Result<(), LightError> {
    let mut count = 0;
    for (index, light) in lights.iter().enumerate() {
        count += light.shape.vertices().len() + light.shape.faces().len() + TEXTURE_ROWS;
        count += light.shape.clusters().row_count();
        count += if light.is_shaped() { SHAPING_ROWS } else { 0 };
        if u32::try_from(count).is_err() {
            return Err(LightFault::TooManyVertices { count }.of(index, &light.name));
        }
    }
    Ok(())
}

fn flags(light: &Light) -> u32 {
    let flag = |on: bool, flag: u32| if on { flag } else { 0 };
    u32::from(light.links) << GpuLight::LINKS_SHIFT
        | flag(light.two_sided, GpuLight::TWO_SIDED)
        | flag(light.shape.is_flat(), GpuLight::FLAT)
        | flag(light.shape.is_mesh(), GpuLight::MESH)
        | flag(light.shape.is_convex_quad(), GpuLight::QUAD)
        | flag(light.opening.is_some(), GpuLight::OPENING)
        | light.profile.as_ref().map_or(0, |it| {
            GpuLight::PROFILE | ((it.end() * f64::from(u16::MAX)) as u32) << GpuLight::PROFILE_END_SHIFT
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::tests::arrow;
    use crate::{LightTexture, TubeEnds};

    fn of(shape: LightShape) -> Light {
        Light { shape, ..Light::default() }
    }

    #[test]
    fn records_are_sorted_by_kind_and_say_whose_they_are() {
        let polygon = |x: f64, concave: bool, two_sided: bool| {
            let mut light = arrow();
            light.shape.vertices_mut()[3].x = if concave { 1.0 } else { -1.0 };
            light.shape.vertices_mut().iter_mut().for_each(|vertex| vertex.x += x);
            Light { two_sided, ..light }
        };
        let sphere = || of(LightShape::Sphere { center: DVec3::ZERO, radius: 1.0 });
        let disk = of(LightShape::Disk { center: DVec3::ZERO, axis_u: DVec3::X, axis_v: DVec3::Y });
        let ends = TubeEnds::Flat;
        let tube = of(LightShape::Tube { p0: DVec3::ZERO, p1: DVec3::X, radius: 1.0, ends });
        let lights = [
            tube,
            polygon(0.0, true, false),
            sphere(),
            polygon(1.0, false, false),
            polygon(2.0, true, true),
            disk,
            polygon(3.0, false, false),
            sphere(),
        ];
        let mut packed = PackedLights::new(&lights, DVec3::ZERO).unwrap();
        assert_eq!((&packed.order[..], &packed.shape_order[..]), (&[3, 6, 1, 4][..], &[5, 2, 7, 0][..]));
        let effects = Effects::SHAPES | Effects::POLYGON | Effects::TWO_SIDED;
        let expected = LightSummary { light_count: 4, quad_count: 2, shape_count: 4, effects };
        assert_eq!(packed.summary(), expected);
        assert!(packed.summary().has_polygons() && !packed.summary().quads().has_polygons());
        assert_eq!(packed.summary().quads().effects, Effects::TWO_SIDED);
        let kinds: Vec<u32> = packed.shapes.iter().map(|shape| shape.kind).collect();
        assert_eq!(kinds, [GpuShape::DISK, GpuShape::SPHERE, GpuShape::SPHERE, GpuShape::TUBE]);
        for (record, index) in packed.lights.iter().zip(&packed.order) {
            let first = packed.vertices[record.first_vertex as usize][0] + record.center[0];
            assert!((f64::from(first) - lights[*index as usize].shape.vertices()[0].x).abs() < 1e-6);
        }
        // What comes after other lights is not among the first quads
        let quads = || PackedLights::new(&lights[3..4], DVec3::ZERO).unwrap();
        packed.append(quads()).unwrap();
        assert_eq!((&packed.order[..], packed.quad_count), (&[3, 6, 1, 4, 8][..], 2));
        let mut two = quads();
        two.append(quads()).unwrap();
        assert_eq!((two.quad_count, two.effects), (2, Effects::empty()));
        two.append(PackedLights::new(&lights[..1], DVec3::ZERO).unwrap()).unwrap();
        assert_eq!((&two.shape_order[..], two.effects), (&[2][..], Effects::TUBE));
        assert_eq!(PackedLights::new(&[], DVec3::ZERO).unwrap(), PackedLights::default());
    }

    #[test]
    fn the_summary_has_what_any_light_needs() {
        let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(glam::DVec2::from_array).to_vec();
        let triangle = of(LightShape::Polygon(vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]));
        let textured = Light { texture: Some(LightTexture { layer: 0, uvs }), ..triangle.clone() };
        let disk = of(LightShape::Disk { center: DVec3::ZERO, axis_u: DVec3::X, axis_v: DVec3::Y });
        let shown = Light { texture: Some(LightTexture { layer: 0, uvs: vec![] }), ..disk };
        let needs = |lights: &[Light]| PackedLights::new(lights, DVec3::ZERO).unwrap().summary().effects;
        assert_eq!(needs(std::slice::from_ref(&triangle)), Effects::empty());
        assert_eq!(needs(&[triangle.clone(), textured]), Effects::TEXTURED);
        let both = Effects::ELLIPSE | Effects::TEXTURED_ELLIPSE;
        assert_eq!(needs(&[triangle, shown]), both);
    }

    #[test]
    fn packing_keeps_precision_far_from_the_world_origin() {
        let offset = DVec3::splat(1e7);
        let mut far = arrow();
        for v in far.shape.vertices_mut() {
            *v = *v + offset + DVec3::new(1e-3, 0.0, 0.0);
        }
        let packed = PackedLights::new(&[far], offset).unwrap();
        assert!((packed.lights[0].center[0] + packed.vertices[1][0] - 2.001).abs() < 1e-6);
    }
}
