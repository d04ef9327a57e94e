//! The component, and how it moves.

use arealight::glam::{DAffine3, DVec2, DVec3, Vec3};
use arealight::{Light, LightShape, LightTexture, Opening, Profile};
use bevy::color::LinearRgba;
use bevy::ecs::component::Component;
use bevy::light::RectLight;
use bevy::prelude::{GlobalTransform, Handle, Image, Transform, Visibility};
use std::f32::consts::PI;

/// A light of any shape, which lights deferred surfaces without noise and without shadows.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_arealight::AreaLight;
///
/// # fn setup(mut commands: Commands) {
/// commands.spawn((
///     AreaLight { radiance: LinearRgba::rgb(8e3, 7e3, 5e3), ..AreaLight::rectangle(2.0, 1.0) },
///     Transform::from_xyz(0.0, 2.0, 0.0).looking_at(Vec3::ZERO, Vec3::Z),
/// ));
/// # }
/// ```
#[derive(Component, Debug, Clone, PartialEq)]
#[require(Transform, Visibility)]
pub struct AreaLight {
    /// What shines, in the entity's space, and moves with its `GlobalTransform`. Under scales that differ by
    /// axis spheres stay spheres, of the volume that they would have, and tubes round. Mirrored, a light
    /// shines to the mirrored side. Scaled to nothing, it is left out.
    pub shape: LightShape,
    /// Luminance of the front or outside, cd/m² in each linear Rec. 709 channel, not negative; alpha is
    /// ignored. As of Bevy's lights, the camera's exposure multiplies it.
    pub radiance: LinearRgba,
    /// Whether the back, or the inside of a sphere, shines too.
    pub two_sided: bool,
    /// How the radiance changes with the angle from the front, of a flat and convex light.
    pub profile: Option<Profile>,
    /// What a flat light is seen through, in the entity's space: a window, or the end of its doors.
    pub opening: Option<Opening>,
    /// Multiplies the radiance of a polygon or disk, upright as seen from -z: its box along x and y, or the
    /// disk's axes, has the whole image. It is shown in 256 texels a side, with mips.
    pub image: Option<Handle<Image>>,
}

impl AreaLight {
    /// White light of 1000 cd/m² from the front of a shape in the entity's space.
    pub fn new(shape: LightShape) -> Self {
        let radiance = LinearRgba::WHITE * 1000.0;
        Self { shape, radiance, two_sided: false, profile: None, opening: None, image: None }
    }

    /// A rectangle about the entity's origin, of a width along x and a height along y, that faces -z, to
    /// where `Transform::looking_at` turns it.
    pub fn rectangle(width: f32, height: f32) -> Self {
        let [x, y] = [width, height].map(|side| f64::from(side) / 2.0);
        let corners = [[-x, -y], [-x, y], [x, y], [x, -y]];
        Self::new(LightShape::Polygon(corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec()))
    }

    /// A disk of a radius about the entity's origin that faces -z.
    pub fn disk(radius: f32) -> Self {
        let radius = f64::from(radius);
        let (axis_u, axis_v) = (DVec3::NEG_X * radius, DVec3::Y * radius);
        Self::new(LightShape::Disk { center: DVec3::ZERO, axis_u, axis_v })
    }

    /// A sphere of a radius about the entity's origin.
    pub fn sphere(radius: f32) -> Self {
        Self::new(LightShape::Sphere { center: DVec3::ZERO, radius: f64::from(radius) })
    }

    /// The light in world space, for messages by this name, with the image of this number; `None` where it is
    /// scaled to nothing.
    pub(crate) fn in_world(
        &self,
        name: String,
        transform: &GlobalTransform,
        image: Option<u32>,
    ) -> Option<Light> {
        let world = DAffine3::from_cols_array(&transform.affine().to_cols_array().map(f64::from));
        let volume = world.matrix3.determinant();
        let is_flat = |shape: &LightShape| shape.area_vector() == DVec3::ZERO;
        if match &self.shape {
            LightShape::Sphere { .. } | LightShape::Tube { .. } => volume == 0.0,
            shape @ LightShape::Disk { .. } => is_flat(&shape.moved(&world)) && !is_flat(shape),
            _ => false,
        } {
            return None;
        }
        let LinearRgba { red, green, blue, .. } = self.radiance;
        let light = Light {
            name,
            radiance: Vec3::new(red, green, blue),
            two_sided: self.two_sided,
            texture: image.map(|layer| LightTexture { layer, uvs: uvs(&self.shape) }),
            profile: self.profile.clone(),
            opening: self.opening,
            shape: self.shape.clone(),
            ..Light::default()
        };
        Some(light.moved(&world))
    }
}

impl From<RectLight> for AreaLight {
    /// The same light but for its range, which an area light has none of.
    fn from(light: RectLight) -> Self {
        let luminance = light.intensity / (light.width * light.height * PI);
        let radiance = light.color.to_linear() * luminance;
        Self { radiance, ..Self::rectangle(light.width, light.height) }
    }
}

/// Coordinates of an image on a polygon's vertices: in its box along x and y, from the upper left as seen
/// from -z.
fn uvs(shape: &LightShape) -> Vec<DVec2> {
    let [low, high] = shape.bounds();
    let size = (high - low).truncate().max(DVec2::splat(f64::MIN_POSITIVE));
    shape.vertices().iter().map(|vertex| (high - *vertex).truncate() / size).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::TubeEnds;
    use bevy::math::Vec3 as BevyVec3;

    fn placed(light: &AreaLight, transform: Transform) -> Option<Light> {
        light.in_world(String::new(), &GlobalTransform::from(transform), None)
    }

    fn front(light: &Light) -> DVec3 {
        light.shape.area_vector().normalize_or_zero()
    }

    #[test]
    fn lights_face_where_bevys_do_and_mirrored_ones_the_mirrored_side() {
        let down = Transform::from_xyz(0.0, 2.0, 0.0).looking_at(BevyVec3::ZERO, BevyVec3::Z);
        for light in [AreaLight::rectangle(2.0, 1.0), AreaLight::disk(0.5)] {
            assert!((front(&placed(&light, down).unwrap()) + DVec3::Y).length() < 1e-6);
            let wide = placed(&light, down.with_scale(BevyVec3::new(-2.0, 3.0, 1.0))).unwrap();
            assert!((front(&wide) + DVec3::Y).length() < 1e-6, "mirrored within its plane");
            let area = light.shape.area_vector().length();
            assert!((wide.shape.area_vector().length() - 6.0 * area).abs() < 1e-5);
            let up = placed(&light, down.with_scale(BevyVec3::new(1.0, 1.0, -1.0))).unwrap();
            assert!((front(&up) - DVec3::Y).length() < 1e-6, "mirrored across it");
        }
    }

    #[test]
    fn lights_scaled_to_nothing_are_dark_or_left_out_and_never_a_fault() {
        let tube = LightShape::Tube { p0: -DVec3::X, p1: DVec3::X, radius: 0.1, ends: TubeEnds::Open };
        let lights = [AreaLight::disk(1.0), AreaLight::sphere(1.0), AreaLight::new(tube)];
        let flat = Transform::from_scale(BevyVec3::new(1.0, 0.0, 1.0));
        assert!(lights.iter().all(|light| placed(light, flat).is_none()));
        let dark = placed(&AreaLight::rectangle(1.0, 1.0), flat).unwrap();
        assert!(dark.validate().is_ok() && dark.shape.area_vector() == DVec3::ZERO);
        let wrong = placed(&AreaLight::sphere(1.0), Transform::from_xyz(f32::NAN, 0.0, 0.0)).unwrap();
        assert!(wrong.validate().unwrap_err().to_string().contains("center"));
    }

    #[test]
    fn solids_keep_their_volume_and_a_tube_its_length() {
        let stretched = Transform::from_scale(BevyVec3::new(4.0, 2.0, 1.0));
        let LightShape::Sphere { radius, .. } = placed(&AreaLight::sphere(0.5), stretched).unwrap().shape
        else {
            panic!("a sphere stays one")
        };
        assert!((radius - 1.0).abs() < 1e-9);
        let tube = LightShape::Tube { p0: -DVec3::X, p1: DVec3::X, radius: 0.5, ends: TubeEnds::Open };
        let LightShape::Tube { p0, p1, radius, .. } = placed(&AreaLight::new(tube), stretched).unwrap().shape
        else {
            panic!("a tube stays one")
        };
        assert!((p0.distance(p1) - 8.0).abs() < 1e-9 && (radius - 0.5 * 2f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn bevys_rectangles_are_taken_as_they_are() {
        let light = AreaLight::from(RectLight {
            intensity: 2.0 * PI,
            width: 2.0,
            height: 1.0,
            ..RectLight::default()
        });
        assert!((light.radiance.green - 1.0).abs() < 1e-6);
        assert_eq!(light.shape, AreaLight::rectangle(2.0, 1.0).shape);
    }
}
