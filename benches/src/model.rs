//! Modelled frames: which paths through the library's quads the waves of a picture take, counted on any
//! device, times what a GPU's compiler says of each path.
//!
//! A wave pays for every path that one of its invocations takes. Lights other than convex quads without an
//! image are left out.

mod costs;
mod text;

pub use costs::{Costs, LobeCosts, MethodCosts, rows};
pub use text::{Modelled, markdown, text};

use arealight::kernels::{Kernel, SHADE_PASS};
use arealight_engine::{Engine, EngineError, SceneRenderer};
use arealight_scene::{Scene, SceneBuffers};
use glam::{Vec3, Vec4};
use std::collections::BTreeMap;

/// How many lobes a surface has: diffuse, specular.
pub const LOBES: usize = 2;

/// How many quads are counted at most.
pub const MOST_LIGHTS: u32 = 32;

/// The kernel that finds the paths.
static PATHS: Kernel = Kernel::of_pass("paths", include_bytes!("../spirv/paths.spv"), &SHADE_PASS);

/// The pixels of a wave.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wave {
    /// 32 invocations, 8 x 4 pixels.
    Of32,
    /// 64 invocations, 8 x 8 pixels.
    Of64,
}

/// Why paths cannot be counted.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The device fails.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// There are too many quads to count.
    #[error("{count} quads: paths are counted of {MOST_LIGHTS} at most")]
    TooManyQuads {
        /// How many there are.
        count: usize,
    },
    /// The size is no multiple of 8.
    #[error("{0} x {1} pixels: paths are counted in pictures whose sides are multiples of 8")]
    Size(u32, u32),
    /// The scene cannot be shown.
    #[error("{0}")]
    Scene(String),
}

/// The paths that the invocations of a wave take for a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Paths(pub u32);

/// Bits of [`Paths`], as in benches/kernels/paths.comp.
impl Paths {
    /// Behind the light or in its plane.
    pub const BEHIND: Self = Self(1);
    /// In front of it.
    pub const IN_FRONT: Self = Self(2);
    const LOBE_SHIFT: usize = 2;
    const LOBE_BITS: usize = 6;

    /// These, and in front of the light: the lobes' own.
    pub fn in_front(lobes: [LobePaths; LOBES]) -> Self {
        let bits = (0..).zip(lobes).map(|(lobe, paths): (usize, LobePaths)| paths.0 << Self::shift(lobe));
        Self(Self::IN_FRONT.0 | bits.sum::<u32>())
    }

    const fn shift(lobe: usize) -> usize {
        Self::LOBE_SHIFT + lobe * Self::LOBE_BITS
    }

    /// Whether some invocation takes one of `paths`.
    pub const fn has(self, paths: Self) -> bool {
        self.0 & paths.0 != 0
    }

    /// What a lobe does.
    pub const fn lobe(self, lobe: usize) -> LobePaths {
        LobePaths((self.0 >> Self::shift(lobe)) & ((1 << Self::LOBE_BITS) - 1))
    }
}

/// The paths that the invocations of a wave take for a lobe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LobePaths(pub u32);

impl LobePaths {
    /// Wholly below the lobe's horizon.
    pub const BELOW: Self = Self(1);
    /// Wholly above it, seen with acute edges.
    pub const ACUTE: Self = Self(2);
    /// Wholly above it, seen with an edge that is not.
    pub const NOT_ACUTE: Self = Self(4);
    /// Crossing it, with one, two and three vertices above.
    pub const CROSSING: [Self; 3] = [Self(8), Self(16), Self(32)];

    /// These and those.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    const fn has(self, path: Self) -> bool {
        self.0 & path.0 != 0
    }

    /// Whether some invocation crosses the horizon.
    pub fn crosses(self) -> bool {
        Self::CROSSING.into_iter().any(|path| self.has(path))
    }

    /// Whether some invocation is wholly above it.
    pub const fn is_above(self) -> bool {
        self.has(Self::ACUTE.and(Self::NOT_ACUTE))
    }

    /// What a wave pays.
    fn cost(self, costs: &LobeCosts) -> f64 {
        let [acute, not_acute, mixed] = costs.above;
        let above = match (self.has(Self::ACUTE), self.has(Self::NOT_ACUTE)) {
            (false, false) => 0.0,
            (true, false) => acute,
            (false, true) => not_acute,
            (true, true) => mixed,
        };
        let below = if self.has(Self::BELOW) { costs.below } else { 0.0 };
        // The chain goes as far as the invocation with the most vertices above
        above + self.most_above().map_or(below, |most| costs.crossing[most - 1])
    }

    /// The most vertices above the horizon of a quad that crosses it; `None` where no invocation has one.
    fn most_above(self) -> Option<usize> {
        (1..=3).rev().find(|&count| self.has(Self::CROSSING[count - 1]))
    }
}

/// How many waves of a picture take which paths, light by light.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Counts {
    /// How many waves have a surface.
    pub waves: u64,
    /// How many quads there are.
    pub quads: usize,
    /// Of waves with a surface: how many, by light and paths.
    pub by_light: BTreeMap<(usize, Paths), u64>,
}

impl Counts {
    /// From what the kernel wrote into the pixels of a picture.
    pub fn new(pixels: &[Vec4], [width, height]: [u32; 2], quads: usize, wave: Wave) -> Self {
        let mut counts = Self { quads, ..Self::default() };
        let (columns, rows) = (width as usize / 8, height as usize / 8);
        // A half of a workgroup: whether it has a surface, and its lights' paths
        let half = |first: usize| {
            let pixel = |place: usize| pixels[first + place / 8 * width as usize + place % 8];
            let lights: Vec<Paths> = (0..quads).map(|light| Paths(pixel(light).x as u32)).collect();
            ((0..32).any(|place| pixel(place).y > 0.0), lights)
        };
        for group in 0..columns * rows {
            let first = group / columns * 8 * width as usize + group % columns * 8;
            let [upper, lower] = [first, first + 4 * width as usize].map(half);
            match wave {
                Wave::Of32 => [upper, lower].into_iter().for_each(|half| counts.add(half)),
                Wave::Of64 => {
                    let both = upper.1.iter().zip(&lower.1).map(|(one, other)| Paths(one.0 | other.0));
                    counts.add((upper.0 || lower.0, both.collect()));
                }
            }
        }
        counts
    }

    fn add(&mut self, (has_surface, lights): (bool, Vec<Paths>)) {
        if has_surface {
            self.waves += 1;
            for (light, paths) in lights.into_iter().enumerate() {
                *self.by_light.entry((light, paths)).or_default() += 1;
            }
        }
    }

    /// The share of waves and lights, of 1, of which `is_such` is true.
    pub fn share(&self, is_such: impl Fn(Paths) -> bool) -> f64 {
        let such = self.by_light.iter().filter(|((_, paths), _)| is_such(*paths));
        such.map(|(_, count)| *count).sum::<u64>() as f64 / (self.waves * self.quads as u64).max(1) as f64
    }

    /// What the lights cost a wave in the mean, where each costs what `cost` says of its paths.
    fn mean(&self, cost: impl Fn(Paths) -> f64) -> f64 {
        let sum: f64 = self.by_light.iter().map(|((_, paths), count)| *count as f64 * cost(*paths)).sum();
        sum / self.waves.max(1) as f64
    }
}

/// A pixel of a frame in the mean: inverse throughput, of waves with a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameCost {
    /// Ours.
    pub exact: f64,
    /// The clipless school's, whose waves skip a light that all of their invocations are behind.
    pub clipless: f64,
    /// Its straight code, that computes every light as one seen from the front.
    pub clipless_straight: f64,
}

impl FrameCost {
    /// What a frame costs.
    pub fn new(counts: &Counts, costs: &Costs) -> Self {
        let lobes = |paths: Paths| -> f64 {
            costs.lobes.iter().enumerate().map(|(i, lobe)| paths.lobe(i).cost(lobe)).sum()
        };
        let light = |paths| facing(paths, &costs.exact) + lobes(paths);
        let clipless = costs.clipless;
        Self {
            exact: costs.exact.pixel + counts.mean(light),
            clipless: clipless.pixel + counts.mean(|paths| facing(paths, &clipless)),
            clipless_straight: clipless.pixel + counts.mean(|_| clipless.in_front),
        }
    }

    /// In the order of the fields.
    const fn all(&self) -> [f64; 3] {
        [self.exact, self.clipless, self.clipless_straight]
    }
}

fn facing(paths: Paths, costs: &MethodCosts) -> f64 {
    if paths.has(Paths::IN_FRONT) { costs.in_front } else { costs.behind }
}

/// Counts the paths of a picture whose visibility the renderer has found, for waves of 8 x 4 and 8 x 8
/// pixels.
///
/// # Errors
/// [`ModelError`] where there are too many quads, the size is no multiple of 8, or the device fails.
pub fn count(
    renderer: &mut SceneRenderer<'_>,
    quads: usize,
    size: [u32; 2],
) -> Result<[Counts; 2], ModelError> {
    if quads > MOST_LIGHTS as usize {
        return Err(ModelError::TooManyQuads { count: quads });
    }
    if size.iter().any(|side| !side.is_multiple_of(8)) {
        return Err(ModelError::Size(size[0], size[1]));
    }
    renderer.shade_by(&PATHS, &[])?;
    let pixels = renderer.radiance()?;
    Ok([Wave::Of32, Wave::Of64].map(|wave| Counts::new(&pixels, size, quads, wave)))
}

/// Counts the paths of a scene's picture from its first camera.
///
/// # Errors
/// As [`count`], and where the scene cannot be shown.
pub fn count_scene(engine: &Engine, scene: &Scene, size: [u32; 2]) -> Result<[Counts; 2], ModelError> {
    let camera = scene.camera(None, f64::from(size[0]) / f64::from(size[1]));
    let camera = camera.ok_or_else(|| ModelError::Scene("the scene has no camera".to_owned()))?;
    let buffers =
        SceneBuffers::new(scene, camera.position).map_err(|error| ModelError::Scene(error.to_string()))?;
    let constants = buffers.constants(&camera, size, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, constants, size)?;
    let quads = renderer.lights().quad_count as usize;
    count(&mut renderer, quads, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COSTS: Costs = {
        let lobe = LobeCosts { below: 4.0, above: [170.0, 190.0, 300.0], crossing: [180.0, 220.0, 260.0] };
        Costs {
            exact: MethodCosts { pixel: 400.0, behind: 20.0, in_front: 100.0 },
            clipless: MethodCosts { pixel: 300.0, behind: 10.0, in_front: 600.0 },
            lobes: [lobe, LobeCosts { above: [171.0, 191.0, 301.0], ..lobe }],
        }
    };

    /// Two workgroups side by side: of their halves the first three have a surface. `paths` are those of a
    /// light.
    fn picture(paths: [Paths; 4]) -> Vec<Vec4> {
        let mut pixels = vec![Vec4::ZERO; 16 * 8];
        for (half, first) in [0, 4 * 16, 8, 4 * 16 + 8].into_iter().enumerate() {
            pixels[first] = Vec4::new(paths[half].0 as f32, 0.0, 0.0, 0.0);
            // One pixel with a surface is enough
            pixels[first + 16 + 5].y = if half < 3 { 1.0 } else { 0.0 };
        }
        pixels
    }

    fn counts(paths: [Paths; 4], wave: Wave) -> Counts {
        Counts::new(&picture(paths), [16, 8], 1, wave)
    }

    fn cost(paths: Paths) -> FrameCost {
        FrameCost::new(&counts([paths; 4], Wave::Of32), &COSTS)
    }

    fn near(one: f64, other: f64) -> bool {
        (one - other).abs() < 1e-9
    }

    #[test]
    fn waves_without_a_surface_do_not_count() {
        let above = Paths::in_front([LobePaths::ACUTE; LOBES]);
        let halves = [above, Paths::BEHIND, above, Paths::BEHIND];
        let found = counts(halves, Wave::Of32);
        assert_eq!((found.waves, found.by_light.len()), (3, 2));
        assert!(near(found.share(|paths| paths == above), 2.0 / 3.0));
        // Of the whole workgroups both have one, and the first does either
        let found = counts(halves, Wave::Of64);
        assert_eq!(found.waves, 2);
        assert!(near(found.share(|paths| paths.has(Paths::IN_FRONT)), 1.0));
        assert!(near(found.share(|paths| paths == above), 0.0));
    }

    #[test]
    fn a_wave_pays_for_every_path_that_is_taken() {
        let lobes = |diffuse, specular| cost(Paths::in_front([diffuse, specular]));
        let (below, acute) = (LobePaths::BELOW, LobePaths::ACUTE);
        let of = |diffuse, specular| lobes(diffuse, specular).exact - 500.0;
        assert!(near(of(below, below), 8.0));
        assert!(near(of(acute, below), 174.0));
        assert!(near(of(below, acute), 175.0), "each lobe its own");
        assert!(near(of(acute.and(below), below), 178.0));
        // One obtuse edge in a wave, and it pays for both ways
        assert!(near(of(LobePaths::NOT_ACUTE, acute), 190.0 + 171.0));
        assert!(near(of(LobePaths::NOT_ACUTE.and(acute), acute), 300.0 + 171.0));
        // The chain runs as far as the most vertices above; what is above is a side of its own
        let [one, _, three] = LobePaths::CROSSING;
        assert!(near(of(one, acute), 180.0 + 171.0));
        assert!(near(of(one.and(three).and(below), acute), 260.0 + 171.0));
        assert!(near(of(one.and(acute), acute), 180.0 + 170.0 + 171.0));
    }

    #[test]
    fn lights_behind_cost_what_their_test_does_unless_code_is_straight() {
        let found = cost(Paths::BEHIND);
        let all = found.all();
        assert!(all.into_iter().zip([420.0, 310.0, 900.0]).all(|(one, other)| near(one, other)), "{all:?}");
        // The twin: an invocation in front makes the wave pay
        let lobes = Paths::in_front([LobePaths::BELOW; LOBES]).0;
        assert!(near(cost(Paths(Paths::BEHIND.0 | lobes)).clipless, 900.0));
    }
}
