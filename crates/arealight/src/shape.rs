//! Disks, ellipses, spheres, cylinders and capsules as lights, and how they are packed for the GPU.

use crate::Effects;
use crate::gpu::{GpuLight, GpuShape};
use glam::{DVec3, Vec3};

/// A light of constant radiance, or that shows an image, that is no polygon.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeLight {
    /// A name for messages; it need not be unique.
    pub name: String,
    /// Radiance of the front or outside, W/(m² sr), linear Rec. 709, not negative.
    pub radiance: Vec3,
    /// Whether the back of an ellipse, or the inside of a sphere, emits too. Of a tube only the outside is shaded.
    pub two_sided: bool,
    /// The layer of the light textures (see [`crate::pyramid`]) that an ellipse shows: an image that multiplies the radiance. Seen from
    /// the front, its rows run along `axis_u` and the top row is where `axis_v` points to; the ellipse is what is seen of it within the
    /// parallelogram of both, which touches its edges. The back shows it mirrored, as a slide does.
    pub texture: Option<u32>,
    /// What shines.
    pub shape: Shape,
}

/// The shape of a light, in world positions in the scene's unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A flat ellipse: `center + cos(t) axis_u + sin(t) axis_v` is its outline. A disk has perpendicular axes of one
    /// length; any two axes that are not parallel will do. The front is the side of `axis_u × axis_v`.
    Ellipse {
        /// The middle.
        center: DVec3,
        /// A half axis.
        axis_u: DVec3,
        /// The half axis that is conjugate to it.
        axis_v: DVec3,
    },
    /// A sphere, which emits outwards.
    Sphere {
        /// The middle.
        center: DVec3,
        /// Above zero.
        radius: f64,
    },
    /// A cylinder or capsule, which emits outwards.
    Tube {
        /// Where the axis begins.
        p0: DVec3,
        /// Where it ends: another point.
        p1: DVec3,
        /// Above zero.
        radius: f64,
        /// What its ends are.
        ends: TubeEnds,
    },
}

/// What the ends of a tube are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum TubeEnds {
    /// The lateral surface alone shines; through the ends a black inside is seen.
    #[default]
    Open = 0,
    /// Flat caps shine too.
    Flat = 1,
    /// Half spheres about both ends of the axis: a capsule.
    Round = 2,
}

/// The kinds of shapes: what a pass can be specialised for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum ShapeKind {
    /// [`Shape::Ellipse`].
    Ellipse = 0,
    /// [`Shape::Sphere`].
    Sphere = 1,
    /// [`Shape::Tube`].
    Tube = 2,
    /// Each shape is what its record says: for lists of several kinds.
    #[default]
    Any = 3,
}

/// Why a shape cannot be used as a light. The light is named, and nothing is packed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A position or axis is NaN, infinite, or farther from the origin than float32 reaches.
    #[error("light '{light}': {field}: {value} is not a finite float32 vector")]
    NotFinite {
        /// The light's name.
        light: String,
        /// The field of its shape.
        field: &'static str,
        /// What it holds.
        value: DVec3,
    },
    /// A radius is not above zero, or outside the range of float32.
    #[error("light '{light}': radius: {value} must be above zero and within the range of float32")]
    BadRadius {
        /// The light's name.
        light: String,
        /// The radius given.
        value: f64,
    },
    /// The axes of an ellipse are zero or parallel, to the precision of float32.
    #[error("light '{light}': axis_u and axis_v: {axis_u} and {axis_v} span no ellipse")]
    NoArea {
        /// The light's name.
        light: String,
        /// A half axis.
        axis_u: DVec3,
        /// The other one.
        axis_v: DVec3,
    },
    /// The ends of a tube are one point, to the precision of float32.
    #[error("light '{light}': p0 and p1: {value} is both ends of the axis; a sphere has one center")]
    NoAxis {
        /// The light's name.
        light: String,
        /// The point.
        value: DVec3,
    },
    /// It is to show an image, and is no ellipse.
    #[error("light '{light}': texture: only ellipses show images; a sphere or tube has one colour")]
    NoImage {
        /// The light's name.
        light: String,
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
    /// Radiance is NaN, infinite or negative.
    #[error("light '{light}': radiance: {value} must be finite and not negative")]
    BadRadiance {
        /// The light's name.
        light: String,
        /// The radiance given.
        value: Vec3,
    },
}

impl Shape {
    /// Which kind it is.
    pub fn kind(&self) -> ShapeKind {
        match self {
            Self::Ellipse { .. } => ShapeKind::Ellipse,
            Self::Sphere { .. } => ShapeKind::Sphere,
            Self::Tube { .. } => ShapeKind::Tube,
        }
    }

    /// The smallest and the largest corner of a box along the axes that holds it.
    pub fn bounds(&self) -> [DVec3; 2] {
        match *self {
            Self::Ellipse { center, axis_u, axis_v } => {
                // Along each axis an outline reaches as far as that axis' parts of both half axes together
                let reach = (axis_u * axis_u + axis_v * axis_v).map(f64::sqrt);
                [center - reach, center + reach]
            }
            Self::Sphere { center, radius } => [center - radius, center + radius],
            Self::Tube { p0, p1, radius, .. } => [p0.min(p1) - radius, p0.max(p1) + radius],
        }
    }
}

impl ShapeLight {
    /// Checks that the light can be shaded.
    ///
    /// # Errors
    /// [`ShapeError`] names the light and the field that is wrong.
    pub fn validate(&self) -> Result<(), ShapeError> {
        self.pack(DVec3::ZERO).map(|_| ())
    }

    /// What the light calls for.
    pub fn effects(&self) -> Effects {
        let kind = match self.shape {
            Shape::Ellipse { .. } => Effects::ELLIPSE,
            Shape::Sphere { .. } => Effects::SPHERE,
            Shape::Tube { .. } => Effects::TUBE,
        };
        // A tube's inside is not shaded
        let sides = self.two_sided && kind != Effects::TUBE;
        let mut effects = kind;
        effects.set(Effects::TWO_SIDED, sides);
        effects.set(Effects::TEXTURED_ELLIPSE, self.texture.is_some());
        effects
    }

    /// Checks that a light that shows an image has its layer among `layers`.
    ///
    /// # Errors
    /// [`ShapeError::NoTextureLayer`] where it has not: the device would show another.
    pub fn check_texture_layer(&self, layers: u32) -> Result<(), ShapeError> {
        match self.texture {
            Some(layer) if layer >= layers => {
                Err(ShapeError::NoTextureLayer { light: self.name.clone(), layer, layers })
            }
            _ => Ok(()),
        }
    }

    /// The light as the GPU reads it, relative to `origin`: the subtraction is made in float64, so that a scene far
    /// from the world's origin shades as well as one at it. Use the same origin for the shading points.
    ///
    /// # Errors
    /// [`ShapeError`] names the light and the field that is wrong.
    pub fn pack(&self, origin: DVec3) -> Result<GpuShape, ShapeError> {
        if !self.radiance.is_finite() || self.radiance.min_element() < 0.0 {
            return Err(ShapeError::BadRadiance { light: self.name.clone(), value: self.radiance });
        }
        if self.texture.is_some() && self.shape.kind() != ShapeKind::Ellipse {
            return Err(ShapeError::NoImage { light: self.name.clone() });
        }
        let empty = GpuShape {
            radiance: self.radiance.to_array(),
            kind: self.shape.kind() as u32,
            flags: if self.two_sided { GpuShape::TWO_SIDED } else { 0 },
            ..bytemuck::Zeroable::zeroed()
        };
        match self.shape {
            Shape::Ellipse { center, axis_u, axis_v } => {
                let [u, v] = [self.vector("axis_u", axis_u, axis_u)?, self.vector("axis_v", axis_v, axis_v)?];
                let radius = longer_half_axis(u.as_dvec3(), v.as_dvec3());
                if !radius.is_some_and(in_range) {
                    return Err(ShapeError::NoArea { light: self.name.clone(), axis_u, axis_v });
                }
                Ok(GpuShape {
                    center: self.vector("center", center, center - origin)?.to_array(),
                    axis_u: u.to_array(),
                    axis_v: v.to_array(),
                    // Not below the longer half axis
                    radius: (radius.unwrap_or_default() as f32).next_up(),
                    detail: self.texture.unwrap_or(GpuLight::NO_TEXTURE),
                    ..empty
                })
            }
            Shape::Sphere { center, radius } => Ok(GpuShape {
                center: self.vector("center", center, center - origin)?.to_array(),
                radius: self.radius(radius)?,
                ..empty
            }),
            Shape::Tube { p0, p1, radius, ends } => {
                // Each end by itself, so that an error names it; then the middle
                self.vector("p0", p0, p0 - origin)?;
                self.vector("p1", p1, p1 - origin)?;
                let half = ((p1 - p0) * 0.5).as_vec3();
                if half == Vec3::ZERO {
                    return Err(ShapeError::NoAxis { light: self.name.clone(), value: p0 });
                }
                Ok(GpuShape {
                    center: ((p0 - origin) * 0.5 + (p1 - origin) * 0.5).as_vec3().to_array(),
                    axis_u: half.to_array(),
                    radius: self.radius(radius)?,
                    detail: ends as u32,
                    ..empty
                })
            }
        }
    }

    /// A vector of the shape, relative to an origin, in float32; `value` is what the field holds.
    fn vector(&self, field: &'static str, value: DVec3, relative: DVec3) -> Result<Vec3, ShapeError> {
        let narrow = relative.as_vec3();
        if narrow.is_finite() && value.as_vec3().is_finite() {
            Ok(narrow)
        } else {
            Err(ShapeError::NotFinite { light: self.name.clone(), field, value })
        }
    }

    fn radius(&self, value: f64) -> Result<f32, ShapeError> {
        if in_range(value) {
            Ok(value as f32)
        } else {
            Err(ShapeError::BadRadius { light: self.name.clone(), value })
        }
    }
}

/// Whether a length is a normal positive number of float32, and not its largest.
fn in_range(length: f64) -> bool {
    length >= f64::from(f32::MIN_POSITIVE) && length < f64::from(f32::MAX) * 0.5
}

/// The longer half axis of an ellipse of two conjugate ones; `None` where they are parallel or zero.
fn longer_half_axis(u: DVec3, v: DVec3) -> Option<f64> {
    // Both numbers of float32, whose squares and their products float64 holds after scaling
    let size = u.abs().max_element().max(v.abs().max_element());
    let (u, v) = (u / size, v / size);
    if !u.is_finite() || !v.is_finite() || u.cross(v) == DVec3::ZERO {
        return None;
    }
    let (sum, difference) =
        (u.length_squared() + v.length_squared(), u.length_squared() - v.length_squared());
    Some(size * (0.5 * (sum + difference.hypot(2.0 * u.dot(v)))).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(shape: Shape) -> ShapeLight {
        ShapeLight { name: "lamp".into(), radiance: Vec3::ONE, two_sided: false, texture: None, shape }
    }

    fn disk(center: DVec3, axis_u: DVec3, axis_v: DVec3) -> ShapeLight {
        light(Shape::Ellipse { center, axis_u, axis_v })
    }

    fn tube(p0: DVec3, p1: DVec3, radius: f64) -> ShapeLight {
        light(Shape::Tube { p0, p1, radius, ends: TubeEnds::Round })
    }

    #[test]
    fn shapes_are_packed_about_the_origin_in_float64() {
        let origin = DVec3::new(1e7, -2e7, 3e7);
        let packed = |light: ShapeLight| light.pack(origin).unwrap();
        let near = DVec3::new(0.125, 0.25, 0.5);
        let found = packed(ShapeLight {
            two_sided: true,
            ..disk(origin + near, DVec3::new(0.0, 3.0, 0.0), DVec3::new(4.0, 0.0, 0.0))
        });
        assert_eq!((found.center, found.kind, found.flags), ([0.125, 0.25, 0.5], 0, GpuShape::TWO_SIDED));
        assert_eq!((found.axis_u, found.axis_v), ([0.0, 3.0, 0.0], [4.0, 0.0, 0.0]));
        assert!(found.radius >= 4.0 && found.radius < 4.00001, "{}", found.radius);
        assert_eq!(found.detail, GpuLight::NO_TEXTURE);
        let found = packed(light(Shape::Sphere { center: origin + near, radius: 0.75 }));
        assert_eq!((found.center, found.radius, found.kind, found.flags), ([0.125, 0.25, 0.5], 0.75, 1, 0));
        let found = packed(tube(origin, origin + near, 0.75));
        assert_eq!((found.center, found.axis_u), ([0.0625, 0.125, 0.25], [0.0625, 0.125, 0.25]));
        assert_eq!((found.kind, found.detail), (2, TubeEnds::Round as u32));
    }

    #[test]
    fn the_radius_holds_ellipses_of_axes_that_are_not_perpendicular() {
        // A disk's axes, sheared: the longest vector of the outline, by search
        let (u, v) = (DVec3::new(1.0, 0.5, 0.0), DVec3::new(0.75, 1.0, 0.25));
        let longest = (0..10_000)
            .map(|i| (f64::from(i) * 1e-3).sin_cos())
            .map(|(sin, cos)| (u * cos + v * sin).length())
            .fold(0.0, f64::max);
        let found = f64::from(disk(DVec3::ZERO, u, v).pack(DVec3::ZERO).unwrap().radius);
        assert!((found - longest).abs() < 1e-6, "{found}, {longest}");
    }

    #[test]
    fn boxes_hold_their_shapes() {
        let (center, u, v) = (DVec3::X, DVec3::new(3.0, 0.0, 0.0), DVec3::new(4.0, 1.0, 0.0));
        let ellipse = Shape::Ellipse { center, axis_u: u, axis_v: v };
        assert_eq!(ellipse.bounds(), [DVec3::new(-4.0, -1.0, 0.0), DVec3::new(6.0, 1.0, 0.0)]);
        let tube = Shape::Tube { p0: DVec3::Y, p1: DVec3::ZERO, radius: 0.5, ends: TubeEnds::Round };
        assert_eq!(tube.bounds(), [DVec3::splat(-0.5), DVec3::new(0.5, 1.5, 0.5)]);
        assert_eq!(Shape::Sphere { center, radius: 1.0 }.bounds()[0], DVec3::new(0.0, -1.0, -1.0));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let (nan, huge) = (DVec3::new(0.0, f64::NAN, 0.0), DVec3::new(0.0, 0.0, 1e39));
        let (x, y, zero) = (DVec3::X, DVec3::Y, DVec3::ZERO);
        let sphere = |radius: f64| light(Shape::Sphere { center: x, radius });
        let shown = ShapeLight { texture: Some(0), ..sphere(1.0) };
        let dark = ShapeLight { radiance: Vec3::new(0.0, -1.0, 0.0), ..sphere(1.0) };
        for (light, expected) in [
            (disk(nan, x, y), "center: [0, NaN, 0] is not a finite"),
            (disk(huge, x, y), "center: "),
            (disk(x, nan, y), "axis_u: "),
            (disk(x, y, huge), "axis_v: "),
            (disk(x, zero, y), "axis_u and axis_v: [0, 0, 0] and [0, 1, 0] span no ellipse"),
            (disk(x, y, y * -2.0), "axis_u and axis_v: "),
            (disk(x, y * 1e-60, x), "axis_u and axis_v: "),
            (light(Shape::Sphere { center: nan, radius: 1.0 }), "center: "),
            (sphere(0.0), "radius: 0 must be above zero"),
            (sphere(-1.0), "radius: -1 "),
            (sphere(f64::NAN), "radius: NaN "),
            (sphere(1e39), "radius: "),
            (sphere(1e-50), "radius: "),
            (tube(nan, x, 1.0), "p0: "),
            (tube(x, huge, 1.0), "p1: "),
            (tube(x, x, 1.0), "p0 and p1: [1, 0, 0] is both ends of the axis"),
            (tube(x, y, -1.0), "radius: -1 "),
            (shown, "texture: only ellipses show images"),
            (dark, "radiance: [0, -1, 0] must be finite and not negative"),
        ] {
            let message = light.validate().unwrap_err().to_string();
            assert!(message.starts_with(&format!("light 'lamp': {expected}")), "{message}\nnot {expected}");
        }
        // The twins: the same, as they should be
        let shown = ShapeLight { texture: Some(0), ..disk(x, x, y) };
        for light in [disk(x, x, y), shown, sphere(1.0), tube(x, y, 1.0)] {
            light.validate().unwrap();
        }
    }

    #[test]
    fn a_disk_that_shows_an_image_says_so() {
        let plain = disk(DVec3::ZERO, DVec3::X, DVec3::Y);
        let shown = ShapeLight { texture: Some(7), ..plain.clone() };
        assert_eq!(shown.pack(DVec3::ZERO).unwrap().detail, 7);
        assert_eq!(shown.effects(), Effects::ELLIPSE | Effects::TEXTURED_ELLIPSE);
        assert_eq!(plain.effects(), Effects::ELLIPSE);
        assert_eq!(plain.check_texture_layer(0), Ok(()));
        assert_eq!(shown.check_texture_layer(8), Ok(()));
        let message = shown.check_texture_layer(7).unwrap_err().to_string();
        assert_eq!(message, "light 'lamp': texture: layer 7 is not there: there are 7");
    }

    #[test]
    fn an_origin_far_away_is_refused_too() {
        let message =
            disk(DVec3::X * 3e38, DVec3::X, DVec3::Y).pack(DVec3::X * -3e38).unwrap_err().to_string();
        assert!(message.starts_with("light 'lamp': center: "), "{message}");
    }
}
