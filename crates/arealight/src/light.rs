//! Lights of every shape, in one list.

use crate::light_fault::{LightError, LightFault};
use crate::light_texture::{LightTexture, TextureMap};
use crate::{Effects, LightShape, Opening, Profile};
use glam::{DAffine3, DVec3, Vec3};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// A light of constant radiance, or a textured one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Light {
    /// A name for messages; it need not be unique, and may be empty.
    pub name: String,
    /// Radiance of the front or outside, W/(m² sr), linear Rec. 709, not negative.
    pub radiance: Vec3,
    /// Whether the back of a polygon, mesh or disk, or the inside of a sphere, emits too. Of a tube only the
    /// outside is shaded.
    pub two_sided: bool,
    /// An image that multiplies the radiance of a polygon or disk; the back shows it mirrored, as a slide
    /// does.
    pub texture: Option<LightTexture>,
    /// How the radiance changes with the angle from the front: of a flat, convex polygon or a disk, which is
    /// shaded as [`Light::DISK_CORNERS`] vertices then. The back of a two-sided light has it, too.
    pub profile: Option<Profile>,
    /// What it is seen through, if not all around: of a polygon, concave ones too unless it has a profile, or
    /// of a disk.
    pub opening: Option<Opening>,
    /// The groups of surfaces that it shines on, a bit each: of those whose stencil
    /// ([`Plane::Stencil`](crate::Plane::Stencil)) has any of these bits. 0, the default, is every surface;
    /// so is what else it says where surfaces lack [`Effects::LINKED`]. [Fog](crate::plan::MediumOptions) is
    /// of every group.
    pub links: u8,
    /// What shines.
    pub shape: LightShape,
}

impl Light {
    /// Checks that the light can be shaded.
    ///
    /// # Errors
    /// [`LightFault`] names the field that is wrong.
    pub fn validate(&self) -> Result<(), LightFault> {
        if self.shape.is_polygonal() || matches!(self.outlined(), Cow::Owned(_)) {
            self.outlined().mapped().map(drop)
        } else {
            self.pack_shape(DVec3::ZERO).map(drop)
        }
    }

    /// The light moved by a transform, its node's say: its [shape](LightShape::moved), what it is seen
    /// through, and its profile and on polygons its image, which a transform that mirrors mirrors. A disk's
    /// image stays as it is.
    #[must_use]
    pub fn moved(&self, by: &DAffine3) -> Self {
        let mut light = self.clone();
        light.shape = self.shape.moved(by);
        light.opening = self.opening.map(|opening| opening.moved(by));
        if by.matrix3.determinant() < 0.0 {
            light.profile = self.profile.as_ref().map(Profile::mirrored);
            if let Some(texture) = light.texture.as_mut() {
                let uvs = texture.uvs.as_mut_slice();
                uvs.reverse();
                uvs.rotate_right(uvs.len().min(2));
            }
        }
        light
    }

    /// Checks that a polygon or mesh can be shaded, and maps its texture.
    pub(crate) fn mapped(&self) -> Result<Option<TextureMap>, LightFault> {
        let vertices = self.shape.vertices();
        if vertices.len() < 3 {
            return Err(LightFault::TooFewVertices { count: vertices.len() });
        }
        for (index, &value) in vertices.iter().enumerate() {
            if !value.as_vec3().is_finite() {
                return Err(LightFault::VertexNotFinite { index, value });
            }
        }
        self.shape.check_faces()?;
        self.check_radiance()?;
        if self.is_shaped() && self.shape.is_mesh() {
            return Err(LightFault::ProfileNotFlat);
        }
        if let Some(opening) = &self.opening {
            opening.check(&self.shape)?;
        }
        if let Some(profile) = &self.profile {
            if !(self.radiance * profile.greatest() as f32).is_finite() {
                return Err(LightFault::BadRadiance { value: self.radiance });
            }
            if !self.shape.is_convex() {
                return Err(LightFault::ProfileConcave);
            }
        }
        self.texture.as_ref().map(|texture| texture.map(&self.shape)).transpose()
    }

    pub(crate) fn check_radiance(&self) -> Result<(), LightFault> {
        if self.radiance.is_finite() && self.radiance.min_element() >= 0.0 {
            Ok(())
        } else {
            Err(LightFault::BadRadiance { value: self.radiance })
        }
    }

    /// Checks that a textured light's layer is among `layers`.
    ///
    /// # Errors
    /// [`LightFault::NoTextureLayer`] where it is not: the device would show another.
    pub fn check_texture_layer(&self, layers: u32) -> Result<(), LightFault> {
        match &self.texture {
            Some(texture) if texture.layer >= layers => {
                Err(LightFault::NoTextureLayer { layer: texture.layer, layers })
            }
            _ => Ok(()),
        }
    }

    /// As [`Light::check_texture_layer`], of every light of a list.
    ///
    /// # Errors
    /// [`LightError`] names the first light whose layer is not there.
    pub fn check_texture_layers(lights: &[Self], layers: u32) -> Result<(), LightError> {
        lights.iter().enumerate().try_for_each(|(index, light)| {
            light.check_texture_layer(layers).map_err(|fault| fault.of(index, &light.name))
        })
    }

    /// Whether it has a profile or an opening.
    pub(crate) fn is_shaped(&self) -> bool {
        self.profile.is_some() || self.opening.is_some()
    }

    /// The vertices that a disk with a profile or an opening has.
    pub const DISK_CORNERS: u32 = 12;

    /// The light as it is packed: of a disk with a profile or an opening the polygon of its area that stands
    /// for it.
    pub fn outlined(&self) -> Cow<'_, Self> {
        let LightShape::Disk { center, axis_u, axis_v } = self.shape else { return Cow::Borrowed(self) };
        if !self.is_shaped() || self.texture.is_some() {
            return Cow::Borrowed(self);
        }
        let step = TAU / f64::from(Self::DISK_CORNERS);
        let scale = (step / step.sin()).sqrt();
        // The first edge goes along `axis_u`
        let vertices = (0..Self::DISK_CORNERS).map(|corner| {
            let (sin, cos) = ((f64::from(corner) - 3.5) * step).sin_cos();
            center + (axis_u * cos + axis_v * sin) * scale
        });
        Cow::Owned(Self { shape: LightShape::Polygon(vertices.collect()), ..self.clone() })
    }

    /// The effects that the light needs.
    pub fn effects(&self) -> Effects {
        if let Cow::Owned(polygon) = self.outlined() {
            return polygon.effects();
        }
        let textured = self.texture.is_some();
        // A tube's inside is not shaded
        let two_sided = self.two_sided && !matches!(self.shape, LightShape::Tube { .. });
        let mut effects = Effects::empty();
        effects.set(Effects::TWO_SIDED, two_sided);
        effects.set(Effects::LINKED, self.links != 0);
        effects.set(Effects::PROFILE, self.profile.is_some());
        effects.set(Effects::AZIMUTH, self.profile.as_ref().is_some_and(|it| !it.harmonics().is_empty()));
        effects.set(Effects::OPENING, self.opening.is_some());
        match self.shape {
            LightShape::Polygon(_) | LightShape::Mesh { .. } => {
                effects.set(Effects::POLYGON, !self.is_shaped() && !self.shape.is_convex_quad());
                effects.set(Effects::TEXTURED, textured);
                effects.set(Effects::MESH, self.shape.is_mesh());
            }
            LightShape::Disk { .. } => {
                effects |= Effects::ELLIPSE;
                effects.set(Effects::TEXTURED_ELLIPSE, textured);
            }
            LightShape::Sphere { .. } => effects |= Effects::SPHERE,
            LightShape::Tube { .. } => effects |= Effects::TUBE,
        }
        effects
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{PackedLights, TubeEnds};
    use glam::DVec2;

    pub(crate) fn arrow() -> Light {
        // A concave quad in the plane z = 2, counter-clockwise from above, so it emits upwards
        Light {
            name: "arrow".into(),
            radiance: Vec3::new(1.0, 2.0, 3.0),
            shape: LightShape::Polygon(vec![
                DVec3::new(0.0, 0.0, 2.0),
                DVec3::new(2.0, 1.0, 2.0),
                DVec3::new(0.0, 2.0, 2.0),
                DVec3::new(1.0, 1.0, 2.0),
            ]),
            ..Light::default()
        }
    }

    #[test]
    fn a_light_moves_with_all_that_is_its() {
        let quad = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(DVec2::from_array);
        let vertices: Vec<DVec3> = quad.iter().map(|place| place.extend(0.0)).collect();
        let shown = |uvs| Some(LightTexture { layer: 0, uvs });
        let uvs: Vec<DVec2> = quad.iter().map(|place| (*place + 1.0) * 0.5).collect();
        let (axis_u, axis_v) = (DVec3::X, DVec3::Y);
        let opening = Some(Opening { center: DVec3::Z, axis_u, axis_v, housed: true });
        let light = |shape| Light { radiance: Vec3::ONE, shape, ..Light::default() };
        // An odd number of azimuths: there is no factor at 180 degrees
        let rows = [[0.0, 3.0, 3.0, 3.0], [90.0, 0.0, 2.0, 1.0]];
        let profile = Some(Profile::new(&rows, 4).unwrap());
        let mesh = LightShape::mesh([&vertices[..], &vertices[..3]].concat(), vec![4, 3]);
        let lights = [
            Light { texture: shown(uvs), opening, profile, ..light(LightShape::Polygon(vertices.clone())) },
            light(mesh),
            light(LightShape::Disk { center: DVec3::X, axis_u: axis_u * 2.0, axis_v }),
            light(LightShape::Sphere { center: DVec3::X, radius: 0.5 }),
            light(LightShape::Tube { p0: DVec3::X, p1: -axis_v, radius: 0.5, ends: TubeEnds::Flat }),
        ];
        for (light, mirror) in lights.iter().flat_map(|light| [1.0, -1.0].map(|mirror| (light, mirror))) {
            let by = DAffine3::from_translation(DVec3::new(3.0, 5.0, 7.0))
                * DAffine3::from_rotation_x(0.5)
                * DAffine3::from_scale(DVec3::new(2.0 * mirror, 2.0, 2.0));
            let moved = light.moved(&by);
            assert!(moved.validate().is_ok());
            let (was, is) = (&light.shape, &moved.shape);
            assert!((is.center() - by.transform_point3(was.center())).length() < 1e-12);
            // The front goes where the space in front of it goes
            let front = by.transform_vector3(was.area_vector()) * 2.0;
            assert!((is.area_vector() - front).length() < 1e-12, "{is:?}");
            let [radii_was, radii_is] = [was, is].map(|shape| match shape {
                LightShape::Sphere { radius, .. } | LightShape::Tube { radius, .. } => *radius,
                _ => 0.0,
            });
            assert!((radii_is - 2.0 * radii_was).abs() < 1e-12);
            // Each vertex still shows what it did
            if let (Some(before), Some(after)) = (&light.texture, &moved.texture) {
                let shows = |shape: &LightShape, texture: &LightTexture, place: DVec3| {
                    let mut all = shape.vertices().iter().zip(&texture.uvs);
                    all.find(|(vertex, _)| vertex.distance(place) < 1e-9).map(|(_, uv)| *uv)
                };
                for vertex in was.vertices() {
                    let shown = shows(is, after, by.transform_point3(*vertex));
                    assert_eq!(shown, shows(was, before, *vertex));
                }
            }
            // And sends into each direction what it did
            if let (Some(before), Some(after)) = (&light.profile, &moved.profile) {
                let sent = |profile: &Profile, shape: &LightShape, to: DVec3| {
                    // Counter-clockwise seen from behind
                    let (edge, front) = (shape.first_edge(), shape.area_vector().normalize_or_zero());
                    let turn = DVec2::new(to.dot(edge), to.dot(edge.cross(front)));
                    let exact = profile.factor_toward(0.5, turn.to_angle());
                    [exact, profile.azimuth_part(0.5, turn.normalize_or_zero(), 1.0)]
                };
                for to in [0.0, 1.0, 2.5, 4.0].map(|turn| DVec2::from_angle(turn).extend(0.0)) {
                    let same = sent(after, is, by.transform_vector3(to) * 0.5);
                    let [exact, harmonics] = sent(before, was, to);
                    assert!((same[0] - exact).abs() < 1e-12 && (same[1] - harmonics).abs() < 1e-12, "{to}");
                }
            }
            let through = moved.opening.map(|opening| opening.center);
            assert_eq!(through, light.opening.map(|opening| by.transform_point3(opening.center)));
        }
        // Nothing is left of it
        let gone = lights[3].moved(&DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)));
        assert!(gone.validate().is_err());
    }

    #[test]
    fn bad_lights_are_named_and_refused() {
        let two = Light { shape: LightShape::Polygon(arrow().shape.vertices()[..2].to_vec()), ..arrow() };
        let error = PackedLights::new(&[arrow(), two.clone()], DVec3::ZERO).unwrap_err();
        assert_eq!(error.to_string(), "lights[1] 'arrow': vertices: 2 given, a polygon has at least 3");
        let error = PackedLights::new(&[Light { name: String::new(), ..two }], DVec3::ZERO).unwrap_err();
        assert_eq!(error.to_string(), "lights[0]: vertices: 2 given, a polygon has at least 3");
        let with = |index: usize, x: f64| {
            let mut light = arrow();
            light.shape.vertices_mut()[index].x = x;
            light
        };
        for (index, value) in [(2, f64::NAN), (1, 1e39)] {
            let fault = with(index, value).validate().unwrap_err();
            assert!(matches!(fault, LightFault::VertexNotFinite { index: found, .. } if found == index));
        }
        let mut light = with(0, -3e38);
        light.shape.vertices_mut()[2].x = 3e38;
        let error = PackedLights::new(&[light], DVec3::ZERO).unwrap_err();
        assert!(matches!(error.fault, LightFault::VertexNotFinite { .. }), "{error}");
        let mut light = arrow();
        light.radiance.y = -1.0;
        assert!(matches!(light.validate(), Err(LightFault::BadRadiance { .. })));
    }
}
