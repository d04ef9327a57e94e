//! A floor under ever more lamps, shaded with all of them and by tiles: time, memory, error.

use crate::ladder::frame::processors;
use crate::ladder::{number, percent};
use crate::table::Table;
use crate::textures::{clocked, is_software};
use arealight::plan::{MediumOptions, Output, ShadeOptions, TileOptions};
use arealight::{Effects, Light, LightShape, LightTable};
use arealight_engine::host::Host;
use arealight_engine::{Engine, EngineError, Fog, SceneRenderer, TiledView};
use arealight_scene::{Camera, Scene, SceneBuffers};
use arealight_vk::TableFormat;
use glam::{DVec3, Vec3, Vec4};
use serde::Serialize;

/// What to measure.
#[derive(Debug, Clone)]
pub struct Options {
    /// How many lamps there are.
    pub counts: Vec<usize>,
    /// The picture in pixels.
    pub size: [u32; 2],
    /// Of the floor.
    pub roughness: f32,
    /// Runs of which the fastest counts; of frames with all of many lights one.
    pub rounds: u32,
    /// How lights come to a pixel; all of them first, which the others are held against.
    pub ways: Vec<Way>,
}

impl Default for Options {
    /// 10 to 10,000 lamps over concrete, every way.
    fn default() -> Self {
        Self {
            counts: vec![10, 100, 1000, 10_000],
            size: [640, 360],
            roughness: 0.9,
            rounds: 3,
            ways: WAYS.to_vec(),
        }
    }
}

/// How lights come to a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way {
    /// All of them.
    All,
    /// By tiles, which cull so much of a pixel's radiance: [`TileOptions::cull_threshold`].
    Tiles(f32),
    /// Into fog over a black floor: all of them in every froxel, or by lists and where pixels show it, and
    /// a pixel may lose so much radiance.
    Fog(Option<f32>),
}

/// What is compared.
pub const WAYS: [Way; 3] = [Way::All, Way::Tiles(0.01), Way::Tiles(0.1)];

/// What is compared in fog.
pub const FOG_WAYS: [Way; 4] =
    [Way::Fog(None), Way::Fog(Some(0.0)), Way::Fog(Some(0.001)), Way::Fog(Some(0.01))];

impl Way {
    /// Its name in tables and charts.
    pub fn name(self) -> String {
        match self {
            Self::All => "all".to_owned(),
            Self::Tiles(threshold) => format!("tiles, {threshold}"),
            Self::Fog(None) => "fog, all".to_owned(),
            Self::Fog(Some(radiance)) => format!("fog, {radiance}"),
        }
    }
}

/// What was found of a frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// How many lamps there are.
    pub lamps: usize,
    /// How they come to a pixel.
    pub way: String,
    /// The mean over the pixels of the floor of the lights that each is shaded with; 0 where that is not
    /// known.
    pub lights_per_pixel: f64,
    /// Milliseconds of the device, with the lists where it makes them.
    pub milliseconds: f64,
    /// What the lists take.
    pub bytes: u64,
    /// The difference from the picture with all lights: root mean square over mean.
    pub rmse: f64,
    /// The largest difference of a pixel over that pixel.
    pub largest: f64,
}

/// Frames of every number of lamps, by every way.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ManyLights {
    /// The device's name.
    pub device: String,
    /// The picture in pixels.
    pub size: [u32; 2],
    /// What was found.
    pub rows: Vec<Row>,
}

/// The side of the floor in metres.
const FLOOR: f64 = 40.0;

/// The most lights that a tile's list holds.
const CAPACITY: u32 = 8192;

/// How many steps `run` reports.
pub fn steps(options: &Options) -> u64 {
    (options.counts.len() * options.ways.len()) as u64
}

/// Shades every frame by every way.
pub fn run(
    host: &Host,
    table: &LightTable,
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<ManyLights, EngineError> {
    let engine = Engine::new(host.clone(), table, TableFormat::default())?;
    let mut rows = vec![];
    for count in &options.counts {
        let aspect = f64::from(options.size[0]) / f64::from(options.size[1]);
        let is_fog = options.ways.iter().any(|way| matches!(way, Way::Fog(_)));
        let mut scene = floor(options.roughness, FLOOR, aspect, if is_fog { 0.0 } else { 0.5 });
        scene.lights = lamps(*count, FLOOR);
        if is_fog {
            // From below the lamps, along them
            let mut camera = Camera::framing("along", scene.bounds, DVec3::Z, DVec3::Y, aspect);
            camera.position = DVec3::new(0.0, 0.6 * scene.lights[0].shape.center().y, -0.5 * FLOOR);
            scene.cameras = vec![camera];
        }
        let mut frame = Frame::new(&engine, &scene, options)?;
        for way in &options.ways {
            rows.push(frame.measure(*way)?);
            progress(1);
        }
    }
    Ok(ManyLights { device: host.device_name(), size: options.size, rows })
}

/// A floor under lamps.
struct Frame<'a> {
    host: &'a Host,
    scene: &'a Scene,
    shade: ShadeOptions,
    options: &'a Options,
    buffers: SceneBuffers,
    renderer: SceneRenderer<'a>,
    /// The picture with all lights, once it is known.
    exact: Vec<Vec4>,
}

impl<'a> Frame<'a> {
    fn new(engine: &'a Engine, scene: &'a Scene, options: &'a Options) -> Result<Self, EngineError> {
        let camera = scene.framing_camera(1.0);
        let camera = scene.cameras.first().cloned().unwrap_or(camera);
        let buffers = SceneBuffers::new(scene, camera.position)?;
        let constants = buffers.constants(&camera, options.size, Vec3::ZERO);
        let renderer = SceneRenderer::new(engine, &buffers, &scene.lights, constants, options.size)?;
        let shade =
            ShadeOptions { surfaces: scene.effects(), output: Output::Overwrite, ..ShadeOptions::default() };
        Ok(Self { host: engine.host(), scene, shade, options, buffers, renderer, exact: vec![] })
    }

    fn measure(&mut self, way: Way) -> Result<Row, EngineError> {
        let mut bytes = 0;
        let (seconds, lights_per_pixel) = match way {
            Way::All => {
                let seconds = self.fastest(self.rounds_with_all(), SceneRenderer::shade_as)?;
                self.exact = self.renderer.radiance()?;
                (seconds, self.scene.lights.len() as f64)
            }
            Way::Tiles(cull_threshold) => {
                let capacity = CAPACITY.min(self.scene.lights.len() as u32);
                let tiles = TileOptions { cull_threshold, capacity, ..TileOptions::default() };
                let view = self.renderer.tiled(self.shade, tiles)?;
                let seconds = self.fastest(self.options.rounds, |renderer, _| renderer.shade_tiled(&view))?;
                bytes = view.memory();
                (seconds, self.lights_by_tiles(&view)?)
            }
            Way::Fog(culled) => (self.fog(culled)?, 0.0),
        };
        let [rmse, largest] = difference(&self.exact, &self.renderer.radiance()?);
        // On a software device seconds are of all its processors
        let processors = if is_software(self.host) { processors() } else { 1.0 };
        Ok(Row {
            lamps: self.scene.lights.len(),
            way: way.name(),
            lights_per_pixel,
            milliseconds: seconds * 1e3 / processors,
            bytes,
            rmse,
            largest,
        })
    }

    /// Runs of a frame with all lights. Where that takes long one is enough: a pipeline is there from fewer
    /// lamps.
    fn rounds_with_all(&self) -> u32 {
        if self.scene.lights.len() > 1000 { 1 } else { self.options.rounds }
    }

    /// Seconds of froxels with all lights or by lists, for 8 x 8 pixels each.
    fn fog(&mut self, culled: Option<f32>) -> Result<f64, EngineError> {
        let least_lights = if culled.is_some() { 0 } else { u32::MAX };
        let fill_hidden = culled.is_none();
        let options = MediumOptions { least_lights, fill_hidden, ..MediumOptions::default() };
        let [columns, rows] = self.options.size.map(|side| side.div_ceil(8));
        let blockers = self.renderer.blockers(&self.buffers)?;
        let view = self.renderer.fog_view(&blockers, [columns, rows, 64], (options, None))?;
        let fog = Fog {
            density: 0.02,
            albedo: Vec3::ONE,
            anisotropy: 0.5,
            farthest: 2.0 * FLOOR as f32,
            cull_radiance: culled.unwrap_or_default(),
        };
        let rounds = if culled.is_none() { self.rounds_with_all() } else { self.options.rounds };
        let seconds = self.fastest(rounds, |renderer, shade| {
            renderer.shade_as(ShadeOptions { surfaces: Effects::DIFFUSE, ..shade })?;
            renderer.add_fog(&view, &fog, 0)
        })?;
        if culled.is_none() {
            self.exact = self.renderer.radiance()?;
        }
        Ok(seconds)
    }

    /// Seconds of the fastest of some runs, the first of which makes pipelines.
    fn fastest(
        &mut self,
        rounds: u32,
        mut run: impl FnMut(
            &mut SceneRenderer<'a>,
            ShadeOptions,
        ) -> Result<Option<std::time::Duration>, EngineError>,
    ) -> Result<f64, EngineError> {
        let (host, shade) = (self.host, self.shade);
        self.renderer.visibility()?;
        let mut fastest = f64::INFINITY;
        for _ in 0..rounds.max(2) {
            fastest = fastest.min(clocked(host, || run(&mut self.renderer, shade))?);
        }
        Ok(fastest)
    }

    /// The pixels of the floor.
    fn pixels(&self) -> impl Iterator<Item = [u32; 2]> {
        let width = self.options.size[0] as usize;
        let lit = self.exact.iter().enumerate().filter(|(_, pixel)| pixel.w != 0.0);
        lit.map(move |(index, _)| [(index % width) as u32, (index / width) as u32])
    }

    fn lights_by_tiles(&self, view: &TiledView) -> Result<f64, EngineError> {
        let lists = view.lists()?;
        let all = self.scene.lights.len();
        let count =
            |[x, y]: [u32; 2]| lists.lights([x / 8, y / 8]).map_or(all, |[lights, _]| lights.len()) as f64;
        Ok(mean(self.pixels().map(count)))
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / f64::max(count, 1.0)
}

impl ManyLights {
    fn table(&self) -> Table {
        let heads = "lamps | shaded by | lights a pixel | ms | lists, KB | RMSE | largest";
        let mut before = 0;
        let row = |row: &Row| {
            // A number once, where its rows begin
            let lamps = if before == row.lamps { String::new() } else { row.lamps.to_string() };
            before = row.lamps;
            let error = |error: f64| if row.way.ends_with("all") { String::new() } else { percent(error) };
            vec![
                lamps,
                row.way.clone(),
                if row.lights_per_pixel == 0.0 { String::new() } else { number(row.lights_per_pixel) },
                number(row.milliseconds),
                if row.bytes == 0 { String::new() } else { (row.bytes / 1000).to_string() },
                error(row.rmse),
                error(row.largest),
            ]
        };
        Table::new(heads, self.rows.iter().map(row))
    }

    /// For a terminal.
    pub fn to_text(&self) -> String {
        let [width, height] = self.size;
        format!("{}: {width} x {height} pixels\n\n{}", self.device, self.table().to_text())
    }

    /// A section of a document. `command` is what made it.
    pub fn to_markdown(&self, command: &str) -> String {
        let [width, height] = self.size;
        format!(
            "By `{command}` on {}: {width} x {height} pixels.\n\n{}",
            self.device,
            self.table().to_markdown()
        )
    }
}

/// Root mean square over mean, and the largest of a pixel over the pixel.
fn difference(truth: &[Vec4], found: &[Vec4]) -> [f64; 2] {
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

/// A square floor of `side` metres and of this roughness about the origin, in y, of this albedo; and a camera
/// from above that sees all of it in a picture of `aspect`. Without lights.
pub fn floor(roughness: f32, side: f64, aspect: f64, albedo: f32) -> Scene {
    let sweep = include_bytes!("../../scenes/sweep.glb");
    let mut scene = Scene::from_bytes(sweep, "floor").expect("the scene in the repository is valid");
    let floor = scene.materials.iter().position(|material| material.name == "floor");
    scene.triangles.retain(|triangle| Some(triangle.material as usize) == floor);
    if let Some(material) = floor.and_then(|floor| scene.materials.get_mut(floor)) {
        (material.material.base_color, material.material.roughness) = (Vec3::splat(albedo), roughness);
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

/// Square lamps that face down over a floor of `side` metres about the origin, as many as a square
/// holds; so high as half of what is between them.
fn lamps(count: usize, side: f64) -> Vec<Light> {
    let columns = (count as f64).sqrt().ceil() as usize;
    let step = side / columns as f64;
    let place = |at: usize| (at as f64 + 0.5) * step - 0.5 * side;
    let lamp = |index: usize| {
        let center = DVec3::new(place(index % columns), 0.5 * step, place(index / columns));
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corner = |(x, z): (f64, f64)| center + DVec3::new(x, 0.0, z) * (0.1 * step);
        Light {
            name: format!("lamp {index}"),
            radiance: Vec3::splat(10.0),
            shape: LightShape::Polygon(corners.map(corner).to_vec()),
            ..Light::default()
        }
    };
    (0..count).map(lamp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found() -> ManyLights {
        let row = |lamps: usize, way: Way| Row {
            lamps,
            way: way.name(),
            lights_per_pixel: 2.5,
            milliseconds: lamps as f64,
            bytes: if way == Way::All { 0 } else { 12_345 },
            rmse: if way == Way::All { 0.0 } else { 0.012 },
            largest: 0.03,
        };
        let rows = [10, 100].into_iter().flat_map(|lamps| WAYS.map(|way| row(lamps, way))).collect();
        ManyLights { device: "a device (driver)".to_owned(), size: [64, 36], rows }
    }

    #[test]
    fn tables_have_every_way() {
        let found = found();
        let text = found.to_markdown("command");
        for way in WAYS {
            assert!(text.contains(&format!("| {} |", way.name())), "{text}");
        }
        assert!(text.contains("| 100 | all | 2.50 | 100 |"), "{text}");
        assert!(text.contains("| 12 | 1.20 % | 3.00 % |"), "{text}");
    }
}
