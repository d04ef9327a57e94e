//! Whole frames by tiles, beside a yardstick that clips nothing and the same shading without tiles: over
//! scenes, and over a floor under ever more lights.
//!
//! Every method runs in turn, round after round, and is read as a ratio to the yardstick in the same round.

use crate::ladder::Spread;
use crate::ladder::methods::{LOBES, SHADE_YARDSTICK};
use crate::school::School;
use crate::table::Table;
use crate::textures::{clocked, is_software};
use arealight::kernels::{Kernel, SHADE};
use arealight::plan::{ShadeOptions, TileOptions, shade_specialization};
use arealight::{Effects, Light, LightShape, LightSummary, TileClass};
use arealight_engine::host::Host;
use arealight_engine::{EngineError, SceneRenderer, TileCounts};
use arealight_scene::{Camera, Scene};
use glam::{DVec3, Vec3, Vec4};
use std::fmt::Write as _;

/// How many ways a frame is shaded: by its yardstick, exactly, and exactly by tiles.
const METHODS: usize = 3;

/// What a frame is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Baseline {
    /// Polygons without textures as [`School::Clipless`] shades them, with our table and light reads.
    Clipless,
    /// The shade kernel over all lights of the frame.
    Exact,
    /// The shade kernel over the same lights without their textures.
    Plain,
}

impl Baseline {
    /// A word for the head of a table.
    fn name(self) -> &'static str {
        match self {
            Self::Clipless => School::Clipless.name(),
            Self::Exact => "exact",
            Self::Plain => "no image",
        }
    }

    /// Its kernel, and that kernel's specialisation.
    fn kernel(self, options: ShadeOptions, lights: LightSummary) -> (&'static Kernel, Vec<(u32, u32)>) {
        let shade = &SHADE;
        match self {
            Self::Clipless => {
                let school = School::Clipless as u32;
                (&SHADE_YARDSTICK, vec![(0, (options.effects(lights) | LOBES).bits()), (1, school)])
            }
            Self::Exact => (shade, shade_specialization(options, lights)),
            Self::Plain => {
                let effects = lights.effects - Effects::TEXTURED_ELLIPSE;
                (shade, shade_specialization(options, LightSummary { effects, ..lights }))
            }
        }
    }
}

/// A frame's times and tiles.
#[derive(Debug, Clone)]
pub struct TiledFrame {
    /// What is shaded.
    pub name: String,
    /// How many lights there are.
    pub lights: usize,
    /// What it is held against.
    pub baseline: Baseline,
    /// Milliseconds of the baseline, of exact shading, and of that by tiles with all that it takes.
    pub milliseconds: [Spread; METHODS],
    /// Their ratios to the baseline in the same round.
    pub ratios: [Spread; METHODS],
    /// What was found of the tiles.
    pub counts: TileCounts,
    /// How much the picture by tiles differs from that without: root mean square over mean, and the largest
    /// difference of a pixel over the pixel.
    pub error: [f64; 2],
}

/// Shades a frame by each method in `rounds` rounds, after one that warms up.
pub fn measure(
    host: &Host,
    name: &str,
    renderer: &mut SceneRenderer<'_>,
    options: ShadeOptions,
    (tiles, baseline): (TileOptions, Baseline),
    rounds: usize,
) -> Result<TiledFrame, EngineError> {
    let view = renderer.tiled(options, tiles)?;
    let lights = (renderer.lights().light_count + renderer.lights().shape_count) as usize;
    let (kernel, specialization) = baseline.kernel(options, renderer.lights());
    let exact = shade_specialization(options, renderer.lights());
    let mut seconds: [Vec<f64>; METHODS] = Default::default();
    for round in 0..=rounds {
        let took = [
            clocked(host, || renderer.shade_by(kernel, &specialization))?,
            clocked(host, || renderer.shade_by(&SHADE, &exact))?,
            clocked(host, || renderer.shade_tiled(&view))?,
        ];
        if round > 0 {
            seconds.iter_mut().zip(took).for_each(|(all, one)| all.push(one));
        }
    }
    let by_tiles = renderer.radiance()?;
    renderer.shade_by(&SHADE, &exact)?;
    let without = renderer.radiance()?;
    // On a software device seconds are of all its processors
    let processors = if is_software(host) { crate::ladder::frame::processors() } else { 1.0 };
    Ok(TiledFrame {
        name: name.to_owned(),
        lights,
        baseline,
        milliseconds: [0, 1, 2].map(|method: usize| Spread::of(&seconds[method]).times(1e3 / processors)),
        ratios: [0, 1, 2].map(|method: usize| Spread::of_ratios(&seconds[method], &seconds[0])),
        counts: view.counts(lights)?,
        error: difference(&without, &by_tiles),
    })
}

/// Root mean square over mean, and the largest of a pixel over the pixel.
pub(crate) fn difference(truth: &[Vec4], found: &[Vec4]) -> [f64; 2] {
    let sum = |pixel: &Vec4| f64::from(pixel.x) + f64::from(pixel.y) + f64::from(pixel.z);
    let (mut squares, mut mean, mut largest) = (0.0, 0.0, 0.0_f64);
    for (truth, found) in truth.iter().map(sum).zip(found.iter().map(sum)) {
        squares += (found - truth).powi(2);
        mean += truth;
        largest = largest.max((found - truth).abs() / truth.max(1e-30));
    }
    let count = truth.len().max(1) as f64;
    [(squares / count).sqrt() / (mean / count).max(1e-30), largest]
}

/// A square floor of `side` metres and of this roughness about the origin, in y, which reflects half of what
/// it scatters; and a camera from above that sees all of it in a picture of `aspect`. Without lights.
pub fn floor(roughness: f32, side: f64, aspect: f64) -> Scene {
    let sweep = include_bytes!("../../scenes/sweep.glb");
    let mut scene = Scene::from_bytes(sweep, "floor").expect("the scene in the repository is valid");
    let floor = scene.materials.iter().position(|material| material.name == "floor");
    scene.triangles.retain(|triangle| Some(triangle.material as usize) == floor);
    if let Some(material) = floor.and_then(|floor| scene.materials.get_mut(floor)) {
        (material.material.base_color, material.material.roughness) = (Vec3::splat(0.5), roughness);
    }
    let middle = scene.bounds.center();
    for corner in scene.triangles.iter_mut().flat_map(|triangle| &mut triangle.positions) {
        *corner =
            DVec3::new(corner.x - middle.x, 0.0, corner.z - middle.z).signum().with_y(0.0) * (0.5 * side);
    }
    scene.bounds = scene.triangles.iter().flat_map(|triangle| triangle.positions).collect();
    let down = DVec3::new(0.0, -1.0, -1.0);
    scene.cameras = vec![Camera::framing("from above", scene.bounds, down, DVec3::Y, aspect)];
    scene.lights.clear();
    scene.lamps.clear();
    scene
}

/// The middles of as many squares, side by side, as cover one of `side` metres about the origin in x and z,
/// row by row; and their side.
fn grid(count: usize, side: f64) -> (f64, impl Iterator<Item = DVec3>) {
    let columns = (count as f64).sqrt().ceil() as usize;
    let step = side / columns as f64;
    let place = move |at: usize| (at as f64 + 0.5) * step - 0.5 * side;
    (step, (0..count).map(move |index| DVec3::new(place(index % columns), 0.0, place(index / columns))))
}

/// Square lamps that face down over a floor of `side` metres about `center`, which lies in y, as many as a
/// square holds; so high as half of what is between them.
pub fn lamps(count: usize, side: f64, center: DVec3) -> Vec<Light> {
    over_floor(count, side, |step, place| {
        let (at, half) = (center + place.with_y(0.5 * step), 0.1 * step);
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corner = |(x, z): (f64, f64)| at + DVec3::new(x * half, 0.0, z * half);
        LightShape::Polygon(corners.map(corner).to_vec())
    })
}

/// As [`lamps`], of disks that face down, or of spheres.
pub fn round_lamps(count: usize, side: f64, are_spheres: bool) -> Vec<Light> {
    over_floor(count, side, |step, place| {
        let (center, radius) = (place.with_y(0.5 * step), 0.1 * step);
        if are_spheres { LightShape::Sphere { center, radius } } else { disk(center, radius) }
    })
}

/// Disks that face down to `center` from `height` above it, side by side as many as a square of `side` holds.
pub fn disks(count: usize, side: f64, height: f64, center: DVec3) -> Vec<Light> {
    over_floor(count, side, |step, place| disk(center + place.with_y(height), 0.4 * step))
}

/// A disk that faces down: x cross z is down.
fn disk(center: DVec3, radius: f64) -> LightShape {
    LightShape::Disk { center, axis_u: DVec3::X * radius, axis_v: DVec3::Z * radius }
}

/// Lights over the squares of a [`grid`]: each of a shape by the square's side and middle.
fn over_floor(count: usize, side: f64, shape: impl Fn(f64, DVec3) -> LightShape) -> Vec<Light> {
    let (step, places) = grid(count, side);
    let light = |(index, place): (usize, DVec3)| Light {
        name: format!("lamp {index}"),
        radiance: Vec3::splat(10.0),
        shape: shape(step, place),
        ..Light::default()
    };
    places.enumerate().map(light).collect()
}

/// Frames as a Markdown table, all of them held against the same.
pub fn markdown(frames: &[TiledFrame]) -> String {
    let baseline = frames.first().map_or(Baseline::Clipless, |frame| frame.baseline);
    let time = format!("{}, ms", baseline.name());
    let heads = [
        "frame",
        "lights",
        &time,
        "exact",
        "exact, by tiles",
        "quartiles",
        "lights per tile",
        "RMSE",
        "largest",
    ];
    let row = |frame: &TiledFrame| {
        let [_, exact, tiles] = &frame.ratios;
        let [by_tiles, quartiles] = tiles.cells();
        vec![
            frame.name.clone(),
            frame.lights.to_string(),
            format!("{:.2}", frame.milliseconds[0].median),
            format!("{:.2}", exact.median),
            by_tiles,
            quartiles,
            format!("{:.1}", frame.counts.lights_per_tile()),
            format!("{:.1e}", frame.error[0]),
            format!("{:.1e}", frame.error[1]),
        ]
    };
    let mut text = Table::new(&heads, frames.iter().map(row)).to_markdown();
    text.push('\n');
    for frame in frames {
        let classes: Vec<String> = frame
            .counts
            .classes
            .iter()
            .map(|(class, count): &(TileClass, u32)| format!("{count} {class}"))
            .collect();
        let _ = writeln!(text, "- {}: tiles {}", frame.name, classes.join(", "));
    }
    text
}
