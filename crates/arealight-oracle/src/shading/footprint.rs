//! What a lobe sees of an image by lookups in its pyramid: the float64 twin of `footprint.glsl`.

use super::shown::{box_coordinate, point};
use crate::texture::Pyramid;
use arealight::pyramid::FINEST_HEIGHT;
use arealight::{Footprint, TextureMap};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::PI;

/// Where A and B are looked up, and how they are weighed: `ArealightImagePlace`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Of the layer.
    pub coordinate: DVec2,
    /// In units in which the light's area is 1.
    pub height: f64,
    /// Of A.
    pub weight: f64,
    /// Of B along rows and columns.
    pub slope: DVec2,
    /// The least of the sum over A's share of it: below it A fills the sum up.
    pub least: f64,
}

impl Place {
    /// That of an image in a lobe's cosine space, all of a layer, on a light of that clipped form factor.
    pub fn new(footprint: Footprint, map: &TextureMap, vector: DVec3) -> Self {
        let cross = map.axis_u.cross(map.axis_v);
        let area = cross.length();
        let toward = cross / area * map.corner.dot(cross).signum();
        let height = map.corner.dot(toward);
        let rise = (1.0 - toward.z * toward.z).max(1e-12).sqrt();
        let up = (DVec3::Z - toward * toward.z) / rise;
        let s = toward.z / rise;
        let [lowest, highest] =
            [f64::min, f64::max].map(|pick| map.corner.z + pick(map.axis_u.z, 0.0) + pick(map.axis_v.z, 0.0));
        let below = (-2.5 * lowest / highest.max(1e-30)).clamp(0.0, 1.0);
        let facing = vector.dot(toward).abs().max(1e-30);
        let mean = box_coordinate(map, vector * (height / facing)).clamp(DVec2::ZERO, DVec2::ONE);
        let mean = point(map, DVec2::splat(0.5).lerp(mean, below));
        let foot = height * toward;
        let square = mean.length_squared() / area;
        let seen = (vector.length() * (PI * square / facing).sqrt()).min(1.0);
        let far = 0.9 * mean.z.max(1e-30) / (mean.z - foot.z).max(1e-30);
        let share = (s.max(0.0) + 1.2 / square.sqrt()).min(1.0).min(far);
        let turned = below * (1.0 - 0.625 * s).clamp(0.0, 1.0);
        let cut = share.min(1.15 * seen.powi(3) / square);
        let [share, turned] =
            if footprint == Footprint::Mips { [1.0, 0.0] } else { [share + turned * (cut - share), turned] };
        let place = mean.lerp(foot, share) + 0.24 * turned * seen * area.sqrt() * up;
        let height = (share * (square - share * mean.distance_squared(foot) / area).max(0.0)).sqrt();
        let high = (place.z / rise / area.sqrt()).max(1e-12);
        let weights = DVec2::new(high, (1.0 + turned * (seen - 1.0)) * height).normalize_or(DVec2::X);
        Self {
            coordinate: box_coordinate(map, place),
            height,
            weight: weights.x,
            slope: weights.y / area.sqrt() * DVec2::new(up.dot(map.axis_u), up.dot(map.axis_v)),
            least: 0.03 + 0.37 * below,
        }
    }

    /// The sum over A and B, of colours and of what is covered.
    fn weighed(&self, [a, b_u, b_v]: [DVec4; 3]) -> DVec4 {
        let slope = self.slope.x * b_u + self.slope.y * b_v;
        let most = self.weight * (1.0 - DVec4::W * self.least) * a / (-slope).max(DVec4::splat(1e-30));
        self.weight * a + most.min_element().min(1.0) * slope
    }
}

/// A layer's coordinate where A and B are.
fn kernel_coordinate(place: DVec2) -> DVec2 {
    let along = |x: f64| {
        let outside = (x - 0.5).abs() - 0.5;
        let side = 0.25 + 0.25 * outside / (outside + 0.5);
        if outside > 0.0 { 0.5 + side.copysign(x - 0.5) } else { 0.25 + 0.5 * x }
    };
    DVec2::new(along(place.x), along(place.y))
}

/// The mean colour that Lambert's lobe sees of an image, all of a layer, on a light of that form factor.
pub fn seen(footprint: Footprint, map: &TextureMap, vector: DVec3, pyramid: &Pyramid) -> DVec3 {
    let mut place = Place::new(footprint, map, vector);
    let height = place.height * f64::from(pyramid.size().side(0));
    let inside = place.coordinate.clamp(DVec2::ZERO, DVec2::ONE);
    if footprint == Footprint::Mips {
        let color = pyramid.lookup(0, inside, (6.0_f64.sqrt() * height).max(1.0).log2());
        return color.truncate() / color.w;
    }
    let height = height / map.longer();
    let level = (height / FINEST_HEIGHT).max(1.0).log2();
    place.slope *= (FINEST_HEIGHT * f64::from(pyramid.size().side(0)) / height).min(1.0);
    let coordinate = kernel_coordinate(place.coordinate);
    let mut sum = place.weighed([1, 2, 3].map(|layer| pyramid.lookup(layer, coordinate, level)));
    if height < FINEST_HEIGHT {
        // From the finest level on to the image itself
        let sharp = pyramid.lookup(0, inside, height.max(1.0).log2());
        sum = (sharp * (sum.w / sharp.w)).lerp(sum, height / FINEST_HEIGHT);
    }
    sum.truncate().max(DVec3::ZERO) / sum.w
}
