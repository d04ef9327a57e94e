//! What a textured light shows: a rectangle of an image, or one colour.

use crate::images::{Textures, linear_mean, sample};
use crate::lit_texels::LitTexels;
use crate::scene::Wrap;
use arealight::TexturePart;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// Coordinates beyond have lost the image: float32 numbers there are a hundredth apart.
const FARTHEST: f64 = 1e5;

/// A light that shows less of an image than this many texels across shows a line of it, or a point.
const THIN: f64 = 0.25;

/// Samples for a mean along a line, and the most and the fewest along each side of a rectangle.
const LINE_SAMPLES: u32 = 64;
const SIDE_SAMPLES: u32 = 32;
const FEWEST_SAMPLES: u32 = 8;

/// How far a box may be outside of the image and still count as inside, from rounding in files.
const OUTSIDE: f64 = 1e-5;

/// How often a light may repeat its image, along each axis, and still show it; beyond, it has the mean
/// colour. At 1024 texels a layer, sixteen are left for each repeat.
pub const MAX_REPEATS: f64 = 64.0;

/// A textured light, while the scene is read.
pub(crate) struct TexturedLight {
    /// Which light: an index into [`crate::Scene::lights`].
    pub owner: usize,
    /// Which surface it is a part of: the first light of that.
    pub surface: usize,
    /// Index into [`crate::Scene::textures`].
    pub texture: u32,
    /// Of its vertices, in the texture's coordinates; of a disk those of its box's corners, the first texel's
    /// first.
    pub uvs: Vec<DVec2>,
}

/// How far coordinates of neighbours may be off one map and still be one light's: a quarter of a texel cannot
/// be seen, nor, in small images, a thousandth of the image.
pub(crate) fn tolerance(textures: &Textures, texture: u32) -> DVec2 {
    let (image, _) = textures.get(texture);
    (0.25 / DVec2::new(f64::from(image.width), f64::from(image.height))).min(DVec2::splat(1e-3))
}

/// What a light shows.
pub(crate) enum Shown {
    /// One colour.
    Color(DVec3),
    /// The mean of what is not shown, and why.
    Lost(DVec3, &'static str),
    /// An image.
    Rectangle(Rectangle),
}

impl Shown {
    pub fn rectangle(&self) -> Option<&Rectangle> {
        if let Self::Rectangle(rectangle) = self { Some(rectangle) } else { None }
    }

    /// The mean linear colour.
    pub fn mean(&self, textures: &Textures) -> DVec3 {
        match self {
            Self::Color(color) | Self::Lost(color, _) => *color,
            Self::Rectangle(rectangle) => rectangle.mean(textures),
        }
    }
}

/// Part of a texture, and where a light's vertices are on it.
pub(crate) struct Rectangle {
    pub texture: u32,
    pub low: DVec2,
    pub high: DVec2,
    /// Within the rectangle.
    pub uvs: Vec<DVec2>,
}

impl Rectangle {
    /// Whether no wrapping is needed.
    pub fn is_inside(&self) -> bool {
        self.low.min_element() >= 0.0 && self.high.max_element() <= 1.0
    }

    pub fn key(&self) -> Key {
        Key::of(self.texture, self.low, self.high - self.low)
    }

    /// The mean linear colour over the light (over the rectangle, where the light is a disk, or too thin for
    /// samples).
    pub fn mean(&self, textures: &Textures) -> DVec3 {
        let (image, texture) = textures.get(self.texture);
        let size = self.high - self.low;
        // A sample a texel, where that is enough
        let texels = size * DVec2::new(f64::from(image.width), f64::from(image.height));
        let [across, down] = texels
            .to_array()
            .map(|side| side.ceil().clamp(f64::from(FEWEST_SAMPLES), f64::from(SIDE_SAMPLES)) as u32);
        let place = |i: u32, count: u32| (f64::from(i) + 0.5) / f64::from(count);
        let mut places: Vec<DVec2> = (0..across * down)
            .map(|i| self.low + size * DVec2::new(place(i % across, across), place(i / across, down)))
            .collect();
        if places.iter().any(|at| self.is_on_light(*at)) {
            places.retain(|at| self.is_on_light(*at));
        }
        places.iter().map(|at| sample(image, texture, *at)).sum::<DVec3>() / places.len() as f64
    }

    /// Whether the light shows this place: an odd number of its edges are to the right.
    fn is_on_light(&self, at: DVec2) -> bool {
        let edges = self.uvs.iter().zip(self.uvs.iter().cycle().skip(1));
        let crosses = |(a, b): &(&DVec2, &DVec2)| {
            (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
        };
        edges.filter(crosses).count() % 2 == 1
    }
}

/// What rectangles have in common that are the same but for rounding, to about 1e-5 of their size.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Key {
    texture: u32,
    /// In each axis: the logarithm of the step, then the corner and the size in steps.
    steps: [[i64; 3]; 2],
}

impl Key {
    /// Of sizes that are positive.
    pub fn of(texture: u32, low: DVec2, size: DVec2) -> Self {
        let steps = |low: f64, size: f64| {
            let logarithm = size.log2().round() - 17.0;
            let step = logarithm.exp2();
            [logarithm, (low / step).round(), (size / step).round()].map(|x| x as i64)
        };
        Self { texture, steps: [steps(low.x, size.x), steps(low.y, size.y)] }
    }
}

/// What is known of the images that lights show.
#[derive(Default)]
pub(crate) struct Images {
    lit: HashMap<u32, LitTexels>,
    means: HashMap<u32, DVec3>,
}

impl Images {
    /// What a light shows.
    pub fn shown(&mut self, textures: &Textures, light: &TexturedLight) -> Shown {
        let (image, texture) = textures.get(light.texture);
        let mut mean = || *self.means.entry(texture.image).or_insert_with(|| linear_mean(image));
        if light.uvs.iter().any(|uv| !uv.is_finite() || uv.abs().max_element() > FARTHEST) {
            return Shown::Lost(mean(), "its texture coordinates are too large");
        }
        // A line or a point has the colours along it
        let size = DVec2::new(f64::from(image.width), f64::from(image.height));
        let texels: Vec<DVec2> = light.uvs.iter().map(|uv| *uv * size).collect();
        let (ends, breadth) = extent(&texels);
        if breadth < THIN || image.texels.len() == 1 {
            let along = |i: u32| ends[0].lerp(ends[1], (f64::from(i) + 0.5) / f64::from(LINE_SAMPLES)) / size;
            let samples = (0..LINE_SAMPLES).map(|i| sample(image, texture, along(i)));
            return Shown::Color(samples.sum::<DVec3>() / f64::from(LINE_SAMPLES));
        }

        // Anything else is a rectangle
        let mut uvs = light.uvs.clone();
        bring_home(&mut uvs, [texture.wrap_u, texture.wrap_v]);
        let mut low = uvs.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let mut high = uvs.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        if low.min_element() >= -OUTSIDE && high.max_element() <= 1.0 + OUTSIDE {
            (low, high) = (low.clamp(DVec2::ZERO, DVec2::ONE), high.clamp(DVec2::ZERO, DVec2::ONE));
        }
        let rectangle = Rectangle { texture: light.texture, low, high, uvs };
        let far = low.abs().max_element() > TexturePart::FARTHEST;
        if far || (high - low).max_element() > MAX_REPEATS {
            let clamped = texture.wrap_u == Wrap::Clamp || texture.wrap_v == Wrap::Clamp;
            let mean = if clamped { rectangle.mean(textures) } else { mean() };
            return Shown::Lost(mean, "repeats its image too often");
        }
        if self.lit.entry(texture.image).or_insert_with(|| LitTexels::new(image)).is_black(low, high) {
            return Shown::Color(DVec3::ZERO);
        }
        Shown::Rectangle(rectangle)
    }
}

/// The two points of a polygon that are farthest apart, or almost, and its breadth across the line through
/// them.
fn extent(points: &[DVec2]) -> ([DVec2; 2], f64) {
    let farthest = |from: DVec2| {
        points.iter().copied().max_by(|a, b| a.distance(from).total_cmp(&b.distance(from))).unwrap_or(from)
    };
    let start = farthest(points.first().copied().unwrap_or_default());
    let end = farthest(start);
    let across = (end - start).normalize_or_zero().perp();
    let off = points.iter().map(|point| (*point - start).dot(across));
    let (least, most) = off.fold((0.0_f64, 0.0_f64), |(least, most), off| (least.min(off), most.max(off)));
    ([start, end], most - least)
}

/// Moves coordinates by whole periods of what is repeated, and out of a mirror image, to start within the
/// image.
fn bring_home(uvs: &mut [DVec2], wrap: [Wrap; 2]) {
    for (axis, wrap) in wrap.into_iter().enumerate() {
        let along = || uvs.iter().map(|uv| uv[axis]);
        // Half of the tolerance: what starts at an edge, but for rounding, starts there
        let (low, high) =
            (along().fold(f64::MAX, f64::min) + OUTSIDE * 0.5, along().fold(f64::MIN, f64::max));
        let (offset, sign) = match wrap {
            Wrap::Clamp => continue,
            Wrap::Repeat => (-low.floor(), 1.0),
            Wrap::Mirror => {
                let offset = -2.0 * (low * 0.5).floor();
                // A whole mirror image, from 1 to 2, turns around
                let mirrored = low + offset >= 1.0 && high + offset <= 2.0 + OUTSIDE;
                if mirrored { (2.0 - offset, -1.0) } else { (offset, 1.0) }
            }
        };
        for uv in uvs.iter_mut() {
            uv[axis] = uv[axis] * sign + offset;
        }
    }
}
