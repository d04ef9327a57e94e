//! What a lobe sees of an image by lookups in its pyramid: the float64 twin of `footprint.glsl`.

use super::shown::box_coordinate;
use crate::texture::Pyramid;
use arealight::pyramid::FINEST_HEIGHT;
use arealight::{Footprint, TextureMap};
use glam::{DVec2, DVec3, DVec4};

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
    /// The least of the sum over A: below it A fills the sum up.
    pub least: f64,
}

/// From this cotangent of the plane's angle down a horizon moves the place.
const STEEP: f64 = 1.256;

impl Place {
    /// That of an image in a lobe's cosine space, whose box is all of the layer.
    pub fn new(footprint: Footprint, map: &TextureMap) -> Self {
        let cross = map.axis_u.cross(map.axis_v);
        let area = cross.length();
        let toward = cross / area * map.corner.dot(cross).signum();
        let height = map.corner.dot(toward);
        let rise = (1.0 - toward.z * toward.z).max(1e-12).sqrt();
        let up = (DVec3::Z - toward * toward.z) / rise;
        let s = toward.z / rise;
        let corners =
            [0.0, map.axis_u.z, map.axis_v.z, map.axis_u.z + map.axis_v.z].map(|z| z + map.corner.z);
        let [lowest, highest] =
            [f64::min, f64::max].map(|pick| corners.into_iter().reduce(pick).unwrap_or(0.0));
        let below = (-10.0 * lowest / highest.max(1e-30)).clamp(0.0, 1.0);
        let turned = below.max((1.0 - 1.75 * s).clamp(0.0, 1.0));
        let turned = if footprint == Footprint::Mips { 0.0 } else { turned };
        let v = (STEEP - s).max(0.0);
        let moved = turned * 0.83 * v * v / (v + 0.653);
        let cut = if s > STEEP {
            DVec2::new(s, 1.0)
        } else {
            DVec2::new(1.0, STEEP.recip() - 0.045 * v / (v + 1.438))
        };
        let weights = DVec2::new(toward.z, rise).lerp(cut.normalize_or(DVec2::X), turned);
        Self {
            coordinate: box_coordinate(map, height * (toward + moved * up)),
            height: height / area.sqrt() * (1.0 + (0.963 * moved).powi(2)).sqrt(),
            weight: weights.x,
            slope: weights.y / area.sqrt() * DVec2::new(up.dot(map.axis_u), up.dot(map.axis_v)),
            least: 0.03 + 0.27 * below,
        }
    }

    /// The sum over A and B, of colours and of what is covered.
    fn weighed(&self, [a, b_u, b_v]: [DVec4; 3]) -> DVec4 {
        let slope = self.slope.x * b_u + self.slope.y * b_v;
        let most = (self.weight - DVec4::W * self.least) * a / (-slope).max(DVec4::splat(1e-30));
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

/// The mean colour that a lobe sees of an image whose box is all of the layer, by Lambert's lobe.
pub fn seen(footprint: Footprint, map: &TextureMap, pyramid: &Pyramid) -> DVec3 {
    let mut place = Place::new(footprint, map);
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
