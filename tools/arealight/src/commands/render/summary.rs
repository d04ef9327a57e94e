//! What a render says of itself.

use super::shading::Outcome;
use super::{Arguments, SurfaceChoice};
use arealight::Effects;
use arealight_scene::{Camera, Scene};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// What took how long by the clock on the wall, in seconds, in order.
#[derive(Default)]
pub struct Phases(Vec<(&'static str, f64)>);

impl Phases {
    /// Does a phase's work.
    pub fn time<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let began = Instant::now();
        let done = work();
        let seconds = began.elapsed().as_secs_f64();
        match self.0.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += seconds,
            None => self.0.push((name, seconds)),
        }
        done
    }

    pub fn to_text(&self) -> String {
        let phases: Vec<String> =
            self.0.iter().map(|(name, seconds)| format!("{name} {seconds:.2} s")).collect();
        phases.join(", ")
    }

    pub fn to_json(&self) -> serde_json::Value {
        self.0.iter().map(|(name, seconds)| (name.replace(' ', "_"), json!(seconds))).collect()
    }
}

/// What there is to say of a render.
pub struct Summary<'a> {
    pub arguments: &'a Arguments,
    pub scene: &'a Scene,
    pub surfaces: Effects,
    pub level: &'static str,
    pub camera: &'a Camera,
    pub device: String,
    pub outcome: &'a Outcome,
    pub phases: &'a Phases,
    pub output: &'a Path,
}

impl Summary<'_> {
    pub fn to_text(&self) -> String {
        let Self { arguments, scene, surfaces, level, camera, device, outcome, phases, output } = self;
        let (width, height) = (arguments.size[0], arguments.size[1]);
        let vertices: usize = scene.lights.iter().map(|light| light.shape.vertices().len()).sum();
        let mut lines = vec![format!(
            "scene    {}: {} triangles, {} lights ({vertices} vertices), camera '{}'",
            arguments.scene_name().display(),
            scene.triangles.len(),
            scene.lights.len(),
            camera.name
        )];
        for (index, effect) in arealight_scene::required_effects(scene).iter().enumerate() {
            lines.push(format!("{} {effect}", if index == 0 { "effects " } else { "        " }));
        }
        if arguments.surfaces != SurfaceChoice::Required {
            lines.push(format!("surfaces {surfaces}"));
        }
        if arguments.reference.is_none() {
            lines.push(format!("level    {level}"));
        }
        lines.push(format!("device   {device}"));
        let method = match arguments.reference_samples() {
            None => "shading".to_owned(),
            Some(samples) => format!("reference ({samples} samples a pixel)"),
        };
        lines.push(format!(
            "time     visibility {}, {method} {}, by the device's clock",
            milliseconds(outcome.visibility),
            milliseconds(outcome.shading)
        ));
        lines.push(format!("         {}, by the clock on the wall", phases.to_text()));
        if let Some(text) = outcome.rays_text(arguments.supersample.pow(2)) {
            lines.push(text);
        }
        if let Some(fog) = outcome.fog {
            lines.push(format!("fog      {}", milliseconds(Some(fog))));
        }
        if let Some(tiles) = &outcome.tiles {
            let classes: Vec<_> =
                tiles.classes.iter().map(|(class, count)| format!("{count} {class}")).collect();
            lines.push(if tiles.is_classified() {
                format!("tiles    {}; {:.1} lights each", classes.join(", "), tiles.lights_per_tile())
            } else {
                "tiles    not classified: that would take longer than so few quads".to_owned()
            });
        }
        let per_pixel = arguments.supersample * arguments.supersample;
        let films = arguments.film.frames.map_or_else(String::new, |count| format!(", {count} in all"));
        lines.push(format!(
            "picture  {}{films} ({width}x{height}, {per_pixel} sample{} a pixel, exposure {} EV)\n",
            output.display(),
            if per_pixel == 1 { "" } else { "s" },
            stops_text(outcome.stops)
        ));
        lines.join("\n")
    }

    pub fn to_json(&self) -> String {
        let Self { arguments, scene, surfaces, level, camera, device, outcome, phases, output } = self;
        let seconds = |time: Option<Duration>| time.map(|time| time.as_secs_f64());
        let required = arealight_scene::required_effects(scene);
        let effects: Vec<_> = required
            .iter()
            .map(|one| json!({ "effect": one.effect.to_string(), "reason": one.reason }))
            .collect();
        let rays = outcome.rays(arguments.supersample.pow(2));
        let summary = json!({
            "scene": arguments.scene_name().display().to_string(),
            "triangles": scene.triangles.len(),
            "lights": scene.lights.len(),
            "camera": camera.name,
            "effects": effects,
            "surfaces_shaded_with": surfaces.names(),
            "level": level,
            "warnings": scene.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "notes": scene.notes.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "device": device,
            "reference_samples": arguments.reference_samples(),
            "tiles": outcome.tiles.as_ref().map(|tiles| json!({
                "classes": tiles.classes.iter()
                    .map(|(class, count)| (class.name(), count)).collect::<BTreeMap<_, _>>(),
                "lights_per_tile": tiles.lights_per_tile(),
            })),
            "shadow_rays": rays.map(|[_, mean]| mean),
            "shadow_rays_most": rays.map(|[most, _]| most),
            "shadow_noise": outcome.noise,
            "fog_seconds": seconds(outcome.fog),
            "gpu_seconds": { "visibility": seconds(outcome.visibility), "shading": seconds(outcome.shading) },
            "seconds": phases.to_json(),
            "picture": output.display().to_string(),
            "frames": arguments.film.frames,
            "size": arguments.size,
            "exposure": outcome.stops,
            "samples_per_pixel": arguments.supersample * arguments.supersample,
        });
        format!("{summary:#}\n")
    }
}

/// To a hundredth, with its sign.
fn stops_text(stops: f32) -> String {
    format!("{:+}", (stops * 100.0).round() / 100.0)
}

fn milliseconds(time: Option<Duration>) -> String {
    time.map_or_else(
        || "not known (no timestamps)".to_owned(),
        |time| format!("{:.1} ms", time.as_secs_f64() * 1e3),
    )
}
