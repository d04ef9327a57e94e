//! The clamped cosine integrated over a tube: a cylinder without or with caps, or a capsule.
//!
//! The twin of `shaders/include/arealight/tube.glsl`, by other means: the silhouette is drawn as a polygon of
//! many vertices, whose error is extrapolated away; [`Tube::is_hit`] has rays for a check.
//!
//! # Accuracy
//! 1e-9 where the point is not nearer to the tube than a tenth of its radius; 1e-6 at a thousandth.

use crate::ellipse::{self, Ellipse};
use crate::polygon;
use crate::sphere::Sphere;
use glam::{DMat3, DVec3};

/// How a tube ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// The lateral surface alone shines, outwards.
    Open,
    /// Flat caps shine too.
    Flat,
    /// Half spheres: a capsule.
    Round,
}

/// A tube as seen from the origin, in a space whose z axis is the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tube {
    /// Where its axis begins, from the shading point; for [`Ends::Round`] the center of a sphere.
    pub start: DVec3,
    /// Where its axis ends.
    pub end: DVec3,
    /// Positive.
    pub radius: f64,
    /// What its ends are.
    pub ends: Ends,
}

/// What covers the same directions as a tube.
enum Silhouette {
    Nothing,
    Disk(Ellipse),
    /// Two rims about `middle` directions, in the order of the outline.
    Rims([Rim; 2]),
}

/// An arc of a circle: `center + cos(phi) middle + sin(phi) side` for phi from `-half` to `half`.
struct Rim {
    center: DVec3,
    middle: DVec3,
    side: DVec3,
    half: f64,
}

impl Tube {
    fn silhouette(&self) -> Silhouette {
        let Self { start, end, radius, ends } = *self;
        let axis = (end - start).try_normalize().unwrap_or(DVec3::X);
        // From the axis to the point
        let towards = -(start - axis * start.dot(axis));
        let distance = towards.length();
        let before_start = start.dot(axis) > 0.0;
        let past_end = end.dot(axis) < 0.0;
        if distance <= radius {
            // In the infinite cylinder there is an end to be seen, if anything
            return match ends {
                Ends::Flat if before_start => Silhouette::Disk(Ellipse::disk(start, -axis, radius)),
                Ends::Flat if past_end => Silhouette::Disk(Ellipse::disk(end, axis, radius)),
                Ends::Round if before_start || past_end => {
                    let center = if before_start { start } else { end };
                    Sphere { center, radius }.silhouette().map_or(Silhouette::Nothing, Silhouette::Disk)
                }
                _ => Silhouette::Nothing,
            };
        }
        let towards = towards / distance;
        let side = axis.cross(towards);
        let (sine, cosine) =
            (((distance - radius) * (distance + radius)).sqrt() / distance, radius / distance);
        let rims = [(start, -1.0, before_start), (end, 1.0, past_end)].map(|(center, outwards, seen)| {
            if ends == Ends::Round {
                // The circle where the cone of tangents meets the sphere
                let square = center.length_squared();
                let ring = center * (1.0 - radius * radius / square);
                let contact = center + (towards * cosine + side * sine) * radius - ring;
                let out = axis * outwards;
                let middle = (out - center * (out.dot(center) / square)).try_normalize().unwrap_or(out);
                let ring_radius = radius * (1.0 - radius * radius / square).sqrt();
                let half = contact.dot(side).atan2(contact.dot(middle));
                Rim { center: ring, middle: middle * ring_radius, side: side * ring_radius, half }
            } else {
                // The far half of the rim where the cap behind it is seen
                let far = ends == Ends::Flat && seen;
                let half = sine.atan2(if far { -cosine } else { cosine });
                let middle = towards * if far { -radius } else { radius };
                Rim { center, middle, side: side * radius, half }
            }
        });
        Silhouette::Rims(rims)
    }

    /// The silhouette as a polygon of `count` segments an end; none where nothing is seen.
    pub fn outline(&self, count: usize) -> Vec<DVec3> {
        match self.silhouette() {
            Silhouette::Nothing => vec![],
            Silhouette::Disk(disk) => disk.polygon(2 * count),
            Silhouette::Rims(rims) => {
                let point = |rim: &Rim, i: usize| {
                    let phi = rim.half * (2.0 * i as f64 / count as f64 - 1.0);
                    rim.center + rim.middle * phi.cos() + rim.side * phi.sin()
                };
                let there = (0..=count).map(|i| point(&rims[0], i));
                let back = (0..=count).rev().map(|i| point(&rims[1], i));
                there.chain(back).collect()
            }
        }
    }

    /// Whether a ray from the origin meets the lit outside.
    pub fn is_hit(&self, direction: DVec3) -> bool {
        let Self { start, end, radius, ends } = *self;
        let axis = (end - start).try_normalize().unwrap_or(DVec3::X);
        let across = |v: DVec3| v - axis * v.dot(axis);
        let (o, d) = (across(-start), across(direction));
        let (a, b, c) = (d.length_squared(), o.dot(d), o.length_squared() - radius * radius);
        let discriminant = b * b - a * c;
        let within = start.dot(axis) <= 0.0 && end.dot(axis) >= 0.0;
        let in_end = ends == Ends::Round && start.length().min(end.length()) <= radius;
        if (c <= 0.0 && within) || in_end {
            return false;
        }
        // The lateral surface from outside
        if c > 0.0 && discriminant > 0.0 {
            let t = (-b - discriminant.sqrt()) / a;
            let along = (direction * t - start).dot(axis);
            if t > 0.0 && along >= 0.0 && along <= (end - start).length() {
                return true;
            }
        }
        let meets_cap = |center: DVec3, normal: DVec3| {
            let t = center.dot(normal) / direction.dot(normal);
            direction.dot(normal) < 0.0 && t > 0.0 && (direction * t - center).length() < radius
        };
        let meets_sphere = |center: DVec3| {
            let along = center.dot(direction) / direction.length_squared();
            center.length() > radius && along > 0.0 && (center - direction * along).length() < radius
        };
        match ends {
            Ends::Open => false,
            Ends::Flat => meets_cap(start, -axis) || meets_cap(end, axis),
            Ends::Round => meets_sphere(start) || meets_sphere(end),
        }
    }
}

/// The integral of the clamped cosine `max(0, cos) / pi` over a tube, in [0, 1]; from inside 0, as it shines
/// outwards.
pub fn form_factor(tube: &Tube) -> f64 {
    transformed_form_factor(&DMat3::IDENTITY, tube)
}

/// The integral of a linearly transformed cosine over a tube, in [0, 1]. `inverse` takes directions of the
/// surface frame into cosine space; only the horizon of that is clipped.
pub fn transformed_form_factor(inverse: &DMat3, tube: &Tube) -> f64 {
    const SEGMENTS: usize = 100;
    match tube.silhouette() {
        Silhouette::Nothing => 0.0,
        Silhouette::Disk(disk) => ellipse::form_factor(&disk.transformed(inverse)).abs(),
        Silhouette::Rims(_) => {
            let at = |count| polygon::transformed_form_factor(inverse, &tube.outline(count)).abs();
            // What an inscribed polygon lacks shrinks by four when its segments are halved, and what is left
            // by sixteen
            let [coarse, middle, fine] = [at(SEGMENTS), at(2 * SEGMENTS), at(4 * SEGMENTS)];
            let [first, second] = [middle + (middle - coarse) / 3.0, fine + (fine - middle) / 3.0];
            second + (second - first) / 15.0
        }
    }
}
