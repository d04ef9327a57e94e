//! Where the horizons of a table's lobes are and how dense lobes are, for the classification of tiles.

use super::{LightTable, TableSample};
use crate::SpecularLobes;

/// Between which planes the horizons of the lobes of a cell of a table lie, and how dense they are:
/// `ArealightGpuLobeHorizon` in `shaders/kernels/tiles.glsl`.
///
/// The horizon of a lobe is the plane through the shading point whose normal is proportional to
/// `mirror + q across` ([`super::mirror_frame`]'s third and first axis), with the ratio `q = q20 / q22` of
/// its texel. Held here is `q` over the sine of the view's angle, which has a limit where the view is along
/// the normal. It is NaN, which is neither above nor below anything, where a lobe of the cell has no horizon
/// below its mirror direction.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LobeHorizon {
    /// The least and the largest `q / sin` of the lobe without Fresnel term, or of that and of two lobes.
    pub lobe: [f32; 2],
    /// The same for the lobe of Schlick's weight.
    pub schlick: [f32; 2],
    /// The least and the largest of Schlick's albedo times `q22` of its lobe, over the same of the lobe
    /// without Fresnel term: what a mixture of the two is weighed by.
    pub weight: [f32; 2],
    /// `a` and `b` such that no lobe, nor one between them, is denser than `a / (b + 1 - cos delta)²` a
    /// steradian, times the sine of the elevation above its horizon, at the angle `delta` from the mirror
    /// direction. An isotropic lobe is about as dense as that. Of smooth lobes, below a roughness of 0.1,
    /// nothing is said: `a` is the largest number there.
    pub envelope: [f32; 2],
    /// No Schlick's albedo in the cell is larger.
    pub schlick_albedo: f32,
    /// Zero.
    pub reserved: [f32; 3],
}

/// Points a side of a cell at which it is sampled, the corners among them.
const SAMPLES: usize = 9;

/// The sine below which a view counts as along the normal: `q` is as small there, and of no matter.
const LEAST_SINE: f64 = 1e-3;

/// The envelope at a node.
struct Peak {
    /// The most that a lobe's density over the elevation's sine, times `(b + 1 - cos delta)²`, is: for each
    /// [`width`] as `b`.
    scaled: [f64; WIDTHS],
    /// Schlick's albedo.
    schlick: f64,
}

/// How many `b` are tried.
const WIDTHS: usize = 24;

/// The `b` that are tried: from 1 down to a smooth lobe's half of alpha squared.
fn width(index: usize) -> f64 {
    0.5_f64.powf(index as f64)
}

/// The angle from the mirror direction that envelopes are made for, as 1 - cos: 37 degrees.
const OFF_MIRROR: f64 = 0.2;

/// Directions in which densities are taken: so many angles from where they are largest over the elevation's
/// sine, and about it, to one side of the plane of incidence: the other is its mirror image.
const NEAR_STEPS: u32 = 64;
const FAR_STEPS: u32 = 48;
const AZIMUTHS: u32 = 4;

/// The angles from where a lobe is largest, as 1 - cos: that, from 1e-9 on angles that grow by 1.19, and even
/// ones, since a lobe may end at its horizon anywhere.
fn falls() -> impl Iterator<Item = f64> {
    let near = (0..NEAR_STEPS - 1).map(|step| 2.0 * 0.71_f64.powi(step.cast_signed()));
    let far = (1..FAR_STEPS)
        .map(|step| 1.0 - (std::f64::consts::PI * f64::from(step) / f64::from(FAR_STEPS)).cos());
    std::iter::once(0.0).chain(near).chain(far)
}

/// Steps of the power method: what is left of other directions falls by alpha squared a step, or is of no
/// matter.
const POWER_STEPS: usize = 16;

/// What densities may grow by between nodes, and between the directions: most where lobes are sharpest. A
/// test tries lookups all over the table.
const BETWEEN_NODES: f64 = 1.3;

/// The roughness below which no envelope is given: lobes change too much between nodes there for
/// [`BETWEEN_NODES`] to be tried.
const LEAST_ROUGHNESS: f64 = 0.1;

/// What albedos may differ by between nodes: docs/fit.md, and a grazing dip.
const ALBEDO_ERROR: f64 = 0.01;

impl LightTable {
    /// The horizons of the `(size - 1)²` cells between the table's nodes, in rows of growing view angle.
    ///
    /// They are taken at 9 × 9 points of the cell, at which texels are interpolated as a lookup does, and are
    /// generous by a twentieth of what they differ there, and by what float16 rounds: along an edge of the
    /// cell the ratio of two interpolated numbers only grows or only falls, and its ends are among the
    /// points.
    ///
    /// `lobes` is what passes are made with ([`crate::Quality::specular_lobes`]).
    pub fn lobe_horizons(&self, lobes: SpecularLobes) -> Vec<LobeHorizon> {
        let cells = self.size as usize - 1;
        // Half-way between nodes of the roughness too: near a smooth lobe's edge a lobe between two is denser
        // than both
        let columns = 2 * self.size - 1;
        let peaks: Vec<Peak> = (0..columns * self.size)
            .map(|index| self.peak(lobes, index % columns, index / columns))
            .collect();
        let cell = |index: usize| {
            let (x, y) = (index % cells, index / cells);
            let rows = [y, y + 1].map(|row| row * columns as usize + 2 * x);
            let of = |value: &dyn Fn(&Peak) -> f64| {
                rows.iter().flat_map(|&row| &peaks[row..=row + 2]).map(value).fold(0.0, f64::max)
            };
            // Of all b, that which says most of directions off the mirror direction
            let envelopes =
                (0..WIDTHS).map(|index| (of(&|peak| peak.scaled[index]) * BETWEEN_NODES, width(index)));
            let off_mirror = |(a, b): &(f64, f64)| a / (b + OFF_MIRROR).powi(2);
            let best = envelopes.min_by(|one, other| off_mirror(one).total_cmp(&off_mirror(other)));
            LobeHorizon {
                envelope: match best {
                    Some((a, b)) if x as f64 >= LEAST_ROUGHNESS * cells as f64 => [a as f32, b as f32],
                    _ => [f32::MAX, 1.0],
                },
                schlick_albedo: (of(&|peak| peak.schlick) + ALBEDO_ERROR) as f32,
                ..self.horizon(lobes, x, y)
            }
        };
        (0..cells * cells).map(cell).collect()
    }

    /// How dense the specular lobes of a surface of this perceptual roughness are a steradian, where they are
    /// densest, of any view and any reflectance: what is reflected of a light is at most that times the
    /// light's solid angle and radiance. 0 to 1; rougher lobes are less dense. `lobes` is as in
    /// [`LightTable::lobe_horizons`].
    ///
    /// Sampled at twice as many views as the table has, and generous by a third for what is between them.
    pub fn lobe_density(&self, lobes: SpecularLobes, roughness: f64) -> f64 {
        let rows = 2 * self.size - 1;
        let mut densest = 0.0_f64;
        for row in 0..rows {
            let v = f64::from(row) / f64::from(rows - 1);
            let cos_view = 1.0 - v * v;
            let found = self.lookup(roughness, cos_view);
            for inverse in lobe_ends(lobes, &found).flat_map(between) {
                let scale = inverse.determinant() / std::f64::consts::PI;
                directions(inverse, super::mirror_frame(cos_view), |direction| {
                    let transformed = inverse * direction;
                    densest = densest.max(scale * transformed.z / transformed.length_squared().powi(2));
                });
            }
        }
        densest * BETWEEN_NODES
    }

    /// What the envelope is made of at a node: `column` counts half-nodes.
    fn peak(&self, lobes: SpecularLobes, column: u32, row: u32) -> Peak {
        let last = f64::from(self.size - 1);
        let (u, v) = (0.5 * f64::from(column) / last, f64::from(row) / last);
        let cos_view = 1.0 - v * v;
        let found = self.lookup(u, cos_view);
        let frame = super::mirror_frame(cos_view);
        let mut scaled = [0.0_f64; WIDTHS];
        for inverse in lobe_ends(lobes, &found).flat_map(between) {
            // A density over the elevation's sine is this over the fourth power of the length in cosine space
            let height = glam::DVec3::new(inverse.x_axis.z, inverse.y_axis.z, inverse.z_axis.z).length();
            let scale = inverse.determinant() * height / std::f64::consts::PI;
            directions(inverse, frame, |direction| {
                let transformed = inverse * direction;
                if transformed.z <= 0.0 {
                    return;
                }
                let density = scale / transformed.length_squared().powi(2);
                // As precise near the mirror direction as 1 - cos is not
                let from_mirror = 0.5 * (direction - frame.z_axis).length_squared();
                for (index, most) in scaled.iter_mut().enumerate() {
                    *most = most.max(density * (width(index) + from_mirror).powi(2));
                }
            });
        }
        Peak { scaled, schlick: found.schlick }
    }

    fn horizon(&self, lobes: SpecularLobes, x: usize, y: usize) -> LobeHorizon {
        let cells = f64::from(self.size - 1);
        let samples: Vec<[f64; 3]> = (0..SAMPLES * SAMPLES)
            .flat_map(|index| {
                let along =
                    |node: usize, step: usize| (node as f64 + step as f64 / (SAMPLES - 1) as f64) / cells;
                let (u, v) = (along(x, index % SAMPLES), along(y, index / SAMPLES).max(LEAST_SINE));
                self.horizon_at(lobes, u, 1.0 - v * v)
            })
            .collect();
        let generous = |place: usize, most: f64| {
            let values = || samples.iter().map(|sample| sample[place]);
            let (low, high) =
                (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            let by = 0.05 * (high - low) + most * high.abs().max(low.abs()) + 1e-6;
            if values().all(f64::is_finite) { Some([low - by, high + by]) } else { None }
        };
        // Entries are rounded by 2^-11 in float16, the ratio of two by twice that
        let ratio = |place| generous(place, 2e-3).map_or([f32::NAN; 2], |range| range.map(|end| end as f32));
        let weight = generous(2, 0.02);
        LobeHorizon {
            lobe: ratio(0),
            schlick: ratio(1),
            weight: weight.map_or([0.0, f32::MAX], |[low, high]| [low.max(0.0) as f32, high as f32]),
            envelope: [0.0; 2],
            schlick_albedo: 0.0,
            reserved: [0.0; 3],
        }
    }

    /// Of each lobe `q / sin` at either end of its reflectances, and the weight of Schlick's; not finite
    /// where a lobe has no horizon below its mirror direction.
    fn horizon_at(&self, lobes: SpecularLobes, roughness: f64, cos_view: f64) -> Vec<[f64; 3]> {
        let found = self.lookup(roughness, cos_view);
        let sine = (1.0 - cos_view * cos_view).sqrt();
        let frame = super::mirror_frame(cos_view);
        // The last row, across the mirror direction and along it. Of all matrices the middle entry is 1
        let row = |inverse: glam::DMat3| {
            let row = glam::DVec3::new(inverse.x_axis.z, inverse.y_axis.z, inverse.z_axis.z);
            (row.dot(frame.x_axis), row.dot(frame.z_axis))
        };
        let ratio =
            |(across, along): (f64, f64)| if along > 0.0 { across / along / sine } else { f64::INFINITY };
        let of_lobe = |ends: [glam::DMat3; 2]| {
            let [lobe, schlick] = ends.map(row);
            let weight = found.schlick * schlick.1 / (found.albedo * lobe.1);
            [ratio(lobe), ratio(schlick), if weight >= 0.0 { weight } else { f64::INFINITY }]
        };
        lobe_ends(lobes, &found).map(of_lobe).collect()
    }
}

/// The matrices of each lobe at either end of its reflectances. A coat has one lobe where the surface has
/// two.
fn lobe_ends(lobes: SpecularLobes, found: &TableSample) -> impl Iterator<Item = [glam::DMat3; 2]> + use<> {
    let pairs = found.pairs.filter(|_| lobes == SpecularLobes::Two);
    let of_pairs = pairs.into_iter().flat_map(|(inverses, _)| inverses.map(|inverse| [inverse; 2]));
    std::iter::once([found.inverse, found.schlick_inverse]).chain(of_pairs)
}

/// Both ends of a lobe's reflectances, and half-way between them; one matrix where both are the same.
fn between([from, to]: [glam::DMat3; 2]) -> impl Iterator<Item = glam::DMat3> {
    let parts: &[f64] = if from == to { &[0.0] } else { &[0.0, 0.5, 1.0] };
    parts.iter().map(move |part| from * (1.0 - part) + to * *part)
}

/// The directions in which a lobe's densities are taken: about that where it is largest over the elevation's
/// sine, which is in the plane of incidence, as the ridge of a lobe is that is long. `frame` is the mirror
/// direction's.
fn directions(inverse: glam::DMat3, frame: glam::DMat3, mut take: impl FnMut(glam::DVec3)) {
    let largest = least_stretched(inverse).unwrap_or(frame.z_axis);
    let (u, v) = (frame.y_axis.cross(largest), frame.y_axis);
    for fall in falls() {
        let (cosine, sine) = (1.0 - fall, (fall * (2.0 - fall)).max(0.0).sqrt());
        for turn in 0..=AZIMUTHS {
            let (s, c) = (std::f64::consts::PI * f64::from(turn) / f64::from(AZIMUTHS)).sin_cos();
            take(largest * cosine + (u * c + v * s) * sine);
        }
    }
}

/// The direction that a transform into cosine space stretches least, above the lobe's horizon. `None` if it
/// has no inverse.
fn least_stretched(inverse: glam::DMat3) -> Option<glam::DVec3> {
    // The power method, of the inverse of what squares of lengths are
    let transform = inverse.inverse();
    let squares = transform * transform.transpose();
    let begin = transform * glam::DVec3::Z;
    let found =
        (0..POWER_STEPS).fold(begin, |along, _| (squares * along).normalize_or(begin)).try_normalize()?;
    Some(if (inverse * found).z < 0.0 { -found } else { found })
}
