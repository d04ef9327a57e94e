//! The hard cases of the ellipse's integral: families of ellipses that break form factors in float32.
//!
//! As for polygons (`hard::family`), a case is the same on every machine, and is rounded to float32 before
//! anything is computed from it.

use arealight_oracle::ellipse::Ellipse;
use arealight_oracle::stream::Stream;
use glam::DVec3;

/// A family of hard cases.
#[derive(Debug, Clone, Copy)]
pub struct Family {
    /// A short name.
    pub name: &'static str,
    /// What makes it hard.
    pub description: &'static str,
    make: fn(&mut Stream) -> Ellipse,
}

/// All families.
pub const FAMILIES: &[Family] = &[
    Family { name: "generic", description: "about as large as far, any way", make: |s| generic(s) },
    Family { name: "above", description: "wholly above the horizon", make: above },
    Family { name: "crossing", description: "across the horizon", make: |s| crossing(s, 0.99) },
    Family { name: "tangent", description: "1e-7 to 1e-2 from touching the horizon", make: tangent },
    Family { name: "edge-on", description: "seen along its plane, 0 to 1e-3 off", make: edge_on },
    Family {
        name: "contact-interior",
        description: "1e-6 to 1e-2 before its inside",
        make: contact_interior,
    },
    Family { name: "contact-rim", description: "1e-6 to 1e-2 from its rim", make: contact_rim },
    Family { name: "huge", description: "1e3 to 1e6 times as large as far", make: huge },
    Family { name: "elongated", description: "one axis 1e2 to 1e5 times the other", make: elongated },
    Family { name: "thin", description: "one axis 1e-5 to 1e-2 of the other", make: thin },
    Family { name: "needle-tip", description: "a needle's tip, 1e-6 to 1e-2 away", make: needle_tip },
    Family {
        name: "low-alpha",
        description: "a disk in the cosine space of an alpha of 3e-4 to 0.1",
        make: low_alpha,
    },
    Family { name: "far", description: "1e3 to 1e8 times as far as large", make: far },
    Family { name: "far-crossing", description: "as far, across the horizon", make: far_crossing },
];

impl Family {
    /// The family of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        FAMILIES.iter().find(|family| family.name == name)
    }

    /// The family's case of an index and a seed: numbers that float32 holds. Every other one has slanting
    /// axes.
    pub fn case(&self, index: u64, seed: u64) -> Ellipse {
        let mut stream = Stream::new(self.name, index, seed);
        let ellipse = (self.make)(&mut stream);
        let [cos, sin] = if stream.one_in(2) { [1.0, 0.0] } else { stream.circle() };
        rounded(&Ellipse {
            axis_u: ellipse.axis_u * cos + ellipse.axis_v * sin,
            axis_v: ellipse.axis_v * cos - ellipse.axis_u * sin,
            ..ellipse
        })
    }
}

/// The ellipse that float32 holds.
pub fn rounded(ellipse: &Ellipse) -> Ellipse {
    let round = |v: DVec3| v.as_vec3().as_dvec3();
    Ellipse { center: round(ellipse.center), axis_u: round(ellipse.axis_u), axis_v: round(ellipse.axis_v) }
}

/// Two perpendicular unit vectors and their normal.
fn frame(stream: &mut Stream) -> [DVec3; 3] {
    let x = stream.direction();
    let (y, z) = x.any_orthonormal_pair();
    let [cos, sin] = stream.circle();
    [x, y * cos + z * sin, z * cos - y * sin]
}

/// Half axes about one, the second at most the first, `2^thin` to 1 of it.
fn with_axes(stream: &mut Stream, center: DVec3, thin: [f64; 2]) -> Ellipse {
    let [x, y, _] = frame(stream);
    let size = stream.power(-3.0, 1.5);
    Ellipse { center, axis_u: x * size, axis_v: y * size * stream.power(thin[0], thin[1]) }
}

fn center(stream: &mut Stream) -> DVec3 {
    stream.direction() * stream.power(-1.5, 1.5)
}

fn generic(stream: &mut Stream) -> Ellipse {
    let center = center(stream);
    with_axes(stream, center, [-3.0, 0.0])
}

fn rise(ellipse: &Ellipse) -> f64 {
    (ellipse.axis_u.z.powi(2) + ellipse.axis_v.z.powi(2)).sqrt()
}

fn above(stream: &mut Stream) -> Ellipse {
    let ellipse = generic(stream);
    let height = rise(&ellipse) + ellipse.center.z.abs() + 1e-3;
    Ellipse { center: ellipse.center.with_z(height), ..ellipse }
}

fn crossing(stream: &mut Stream, share: f64) -> Ellipse {
    let ellipse = generic(stream);
    let height = rise(&ellipse) * stream.between(-share, share);
    Ellipse { center: ellipse.center.with_z(height), ..ellipse }
}

fn tangent(stream: &mut Stream) -> Ellipse {
    let ellipse = generic(stream);
    let height = rise(&ellipse) * stream.sign() * (1.0 + stream.sign() * stream.power(-23.0, -7.0));
    Ellipse { center: ellipse.center.with_z(height), ..ellipse }
}

fn edge_on(stream: &mut Stream) -> Ellipse {
    let ellipse = with_axes(stream, DVec3::ZERO, [-3.0, 0.0]);
    let [u, v] = stream.circle();
    let away = stream.between(1.01, 4.0);
    let normal = ellipse.axis_u.cross(ellipse.axis_v);
    let off = if stream.one_in(3) { 0.0 } else { stream.sign() * stream.power(-30.0, -10.0) };
    Ellipse { center: (ellipse.axis_u * u + ellipse.axis_v * v) * away + normal * off, ..ellipse }
}

fn contact_interior(stream: &mut Stream) -> Ellipse {
    let ellipse = with_axes(stream, DVec3::ZERO, [-3.0, 0.0]);
    let [u, v] = stream.circle();
    let away = 0.98 * stream.unit().sqrt();
    let normal = ellipse.axis_u.cross(ellipse.axis_v);
    let height = stream.sign() * stream.power(-20.0, -7.0);
    Ellipse { center: (ellipse.axis_u * u + ellipse.axis_v * v) * away + normal * height, ..ellipse }
}

fn contact_rim(stream: &mut Stream) -> Ellipse {
    let ellipse = with_axes(stream, DVec3::ZERO, [-3.0, 0.0]);
    let [u, v] = stream.circle();
    let off = stream.direction() * stream.power(-20.0, -7.0);
    Ellipse { center: ellipse.axis_u * u + ellipse.axis_v * v + off, ..ellipse }
}

fn huge(stream: &mut Stream) -> Ellipse {
    let [x, y, _] = frame(stream);
    let sizes = [stream.power(10.0, 20.0), stream.power(10.0, 20.0)];
    Ellipse { center: center(stream), axis_u: x * sizes[0], axis_v: y * sizes[1] }
}

fn elongated(stream: &mut Stream) -> Ellipse {
    let center = center(stream);
    let [x, y, _] = frame(stream);
    let size = stream.power(0.0, 3.0);
    Ellipse { center, axis_u: x * size, axis_v: y * size * stream.power(-17.0, -7.0) }
}

fn thin(stream: &mut Stream) -> Ellipse {
    let center = center(stream);
    with_axes(stream, center, [-17.0, -7.0])
}

fn needle_tip(stream: &mut Stream) -> Ellipse {
    let ellipse = with_axes(stream, DVec3::ZERO, [-17.0, -7.0]);
    let off = stream.direction() * stream.power(-20.0, -7.0);
    Ellipse { center: ellipse.axis_u * stream.sign() + off, ..ellipse }
}

/// Cosine space stretches across the lobe's axis by the reciprocal of alpha.
fn low_alpha(stream: &mut Stream) -> Ellipse {
    let alpha = stream.power(-11.5, -3.5);
    let center = center(stream);
    let [x, y, _] = frame(stream);
    let size = stream.power(-3.0, 1.0);
    let stretch = DVec3::new(1.0 / alpha, 1.0 / alpha, 1.0);
    Ellipse { center: center * stretch, axis_u: x * size * stretch, axis_v: y * size * stretch }
}

fn far(stream: &mut Stream) -> Ellipse {
    let center = stream.direction() * stream.power(10.0, 26.5);
    with_axes(stream, center, [-3.0, 0.0])
}

fn far_crossing(stream: &mut Stream) -> Ellipse {
    let center = stream.direction() * stream.power(10.0, 26.5);
    let ellipse = with_axes(stream, center, [-3.0, 0.0]);
    let height = rise(&ellipse) * stream.between(-0.9, 0.99);
    Ellipse { center: center.with_z(height), ..ellipse }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_oracle::ellipse::form_factor;

    #[test]
    fn every_family_has_light_in_it() {
        for family in FAMILIES {
            let values: Vec<f64> = (0..200).map(|index| form_factor(&family.case(index, 0)).abs()).collect();
            assert!(values.iter().all(|value| (0.0..=1.0).contains(value)), "{}", family.name);
            assert!(values.iter().filter(|value| **value > 0.0).count() > 60, "{}", family.name);
            assert_eq!(Family::find(family.name).map(|found| found.description), Some(family.description));
        }
    }
}
