//! A light's texture as the GPU prefilters it, read back.

use crate::failure::Failure;
use crate::picture::srgb_from_linear;
use crate::plots::bytes_of;
use crate::{gpu, lights, memory};
use arealight::TexturePart;
use arealight::pyramid::PyramidSize;
use arealight_cases::images::Images;
use arealight_engine::{Engine, EngineError, Of, SourceImage, SourceTexels};
use arealight_scene::{LoadOptions, Scene};
use glam::DVec3;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// The most texels a side: what a picture of levels side by side can show, and what `render` uses.
const LARGEST: u32 = 1024;

/// A light texture and where it is from.
pub struct Pyramid {
    /// The file, and what of it.
    pub name: String,
    pub size: PyramidSize,
    /// The image, then the colours that are seen from each height; linear light, row after row from the top.
    pub levels: Vec<Vec<[f32; 4]>>,
}

/// The mean of a level: that of the image.
fn mean(level: &[[f32; 4]]) -> DVec3 {
    let texels = level.iter().map(|[r, g, b, _]| DVec3::new((*r).into(), (*g).into(), (*b).into()));
    texels.sum::<DVec3>() / level.len() as f64
}

/// Prefilters an image, or layer `layer` of a scene's light textures, on a device.
///
/// # Errors
/// [`Failure`] where there is no such file, layer or device.
pub fn make(path: &Path, layer: u32, device: Option<&str>) -> Result<Pyramid, Failure> {
    // Read the file, before a device is asked for
    let ending = path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).unwrap_or_default();
    let (name, input) = match ending.as_str() {
        "glb" | "gltf" => {
            let scene = lights::read(path, LoadOptions::default())?;
            (layer_name(path, &scene, layer)?, Input::Scene(Box::new(scene)))
        }
        _ if layer > 0 => {
            let message = format!("{layer}: an image is one texture, 0");
            return Err(Failure::Argument { argument: "--layer", message });
        }
        "exr" => (path.display().to_string(), Input::Image(Loaded::exr(path)?)),
        _ => (path.display().to_string(), Input::Image(Loaded::encoded(path)?)),
    };
    // Make the pyramid, and read it back
    let mut engine = gpu::engine(device, &arealight::LightTable::ggx())?;
    match input {
        Input::Scene(scene) => engine.load_scene_textures(&scene, LARGEST),
        Input::Image(image) => image.load(&mut engine),
    }
    .and_then(|()| read_back(&engine, name, layer))
    .map_err(|error| gpu::failure(error, path))
}

enum Input {
    Scene(Box<Scene>),
    Image(Loaded),
}

/// What a scene's layer is called: its image, and who shows it.
fn layer_name(path: &Path, scene: &Scene, layer: u32) -> Result<String, Failure> {
    let count = scene.light_textures.len();
    if count == 0 {
        return Err(Failure::input(path, "no light shows a texture (an emissiveTexture on a flat part)"));
    }
    let Some(shown) = scene.light_textures.get(layer as usize) else {
        let message = format!("{layer}: {} has {count}, from 0 to {}", path.display(), count - 1);
        return Err(Failure::Argument { argument: "--layer", message });
    };
    let image = &scene.images[scene.textures[shown.texture as usize].image as usize].name;
    let shows =
        |light: &&arealight::Light| light.texture.as_ref().is_some_and(|texture| texture.layer == layer);
    let lights: Vec<&str> = scene.lights.iter().filter(shows).map(|light| light.name.as_str()).collect();
    let more = if lights.len() > 1 { format!(" and {} more", lights.len() - 1) } else { String::new() };
    let light = lights.first().copied().unwrap_or_default();
    Ok(format!("{}: '{image}', shown by '{light}'{more}", path.display()))
}

fn read_back(engine: &Engine, name: String, layer: u32) -> Result<Pyramid, EngineError> {
    let size = engine.texture_size().expect("textures were loaded");
    let mut levels = vec![engine.download_level(layer, Of::Image, 0)?];
    for level in 0..size.levels() {
        let seen = engine.download_level(layer, Of::A, level)?;
        levels.push(seen.into_iter().map(|[r, g, b, a]| [r / a, g / a, b / a, 1.0]).collect());
    }
    Ok(Pyramid { name, size, levels })
}

/// An image from a file.
struct Loaded {
    size: [u32; 2],
    texels: Texels,
}

enum Texels {
    Srgb(Vec<[u8; 4]>),
    Linear(Vec<[f32; 4]>),
}

impl Loaded {
    fn exr(path: &Path) -> Result<Self, Failure> {
        let image = Images::beside(path, memory::most_of).read(path);
        let image = image.map_err(|error| Failure::input(path, error))?;
        let texels = image.texels().iter().map(|texel| texel.as_vec3().extend(1.0).to_array()).collect();
        let size = [image.width(), image.height()].map(|side| side as u32);
        Self { size, texels: Texels::Linear(texels) }.check(path)
    }

    fn encoded(path: &Path) -> Result<Self, Failure> {
        let failed = |error: image::ImageError| Failure::input(path, error);
        let reader = image::ImageReader::open(path).and_then(image::ImageReader::with_guessed_format);
        let reader = reader.map_err(|error| Failure::input(path, error))?;
        let pixels = reader.decode().map_err(failed)?.into_rgba8();
        let size = [pixels.width(), pixels.height()];
        Self { size, texels: Texels::Srgb(pixels.pixels().map(|pixel| pixel.0).collect()) }.check(path)
    }

    /// That the image can be loaded.
    fn check(self, path: &Path) -> Result<Self, Failure> {
        let constants = TexturePart::default().load_constants(self.size, self.pyramid_size(), 0, false);
        constants.map_err(|error| Failure::input(path, error))?;
        Ok(self)
    }

    fn pyramid_size(&self) -> PyramidSize {
        let [width, height] = self.size.map(|side| side.min(LARGEST));
        PyramidSize::for_image(width, height)
    }

    /// Loads the whole image.
    fn load(&self, engine: &mut Engine) -> Result<(), EngineError> {
        let texels = match &self.texels {
            Texels::Srgb(texels) => SourceTexels::Srgb(texels),
            Texels::Linear(texels) => SourceTexels::Linear(texels),
        };
        let image = SourceImage { texels, size: self.size, part: TexturePart::default() };
        engine.load_textures(self.pyramid_size(), &[image])
    }
}

impl Pyramid {
    /// The levels with their sides in texels, and their heights in the light's longer side.
    fn levels(&self) -> impl Iterator<Item = (&[[f32; 4]], u32, f64)> {
        self.levels.iter().zip(0_u32..).map(|(texels, number)| {
            let level = number.saturating_sub(1);
            let height = if number == 0 { 0.0 } else { self.size.height(level) };
            (texels.as_slice(), self.size.side(level), height)
        })
    }

    /// The levels, for a picture: what makes the brightest texel white is said where it is not 1.
    pub fn found(&self) -> Value {
        let texels = self.levels[0].iter().flat_map(|texel| &texel[..3]);
        let peak = texels.fold(1.0_f32, |peak, channel| peak.max(*channel));
        let white = if peak > 1.0 { format!("; white is {peak:.3}") } else { String::new() };
        let side = self.size.side(0);
        let level = |(texels, side, height): (&[[f32; 4]], u32, f64)| {
            let channels = texels.iter().flat_map(|[r, g, b, _]| [r, g, b]);
            let bytes: Vec<u8> = channels.map(|channel| srgb_from_linear(channel / peak)).collect();
            json!({ "size": [side, side], "height": height, "srgb": bytes_of(&bytes) })
        };
        json!({
            "title": format!("{}\n{side} x {side} texels{white}", self.name),
            "size": [side, side],
            "levels": self.levels().map(level).collect::<Value>(),
        })
    }

    pub fn to_text(&self) -> String {
        let side = self.size.side(0);
        let mut text =
            format!("{}\nsize  {side} x {side} texels, {} in all\n\n", self.name, self.size.texels());
        let [level, extent, height] = ["level", "extent", "height"];
        let _ = writeln!(text, "{level:<6} {extent:>11} {height:>10}  mean");
        for (number, (texels, side, height)) in self.levels().enumerate() {
            let (mean, extent) = (mean(texels), format!("{side} x {side}"));
            let level = if number == 0 { "image".to_owned() } else { (number - 1).to_string() };
            let _ = writeln!(
                text,
                "{level:<6} {extent:>11} {height:>10.4}  {:.4} {:.4} {:.4}",
                mean.x, mean.y, mean.z
            );
        }
        text.push_str("\nheight: above the light, in its longer side; what is seen from there\n");
        text
    }

    pub fn to_json(&self) -> String {
        let level = |(texels, side, height): (&[[f32; 4]], u32, f64)| {
            let mean = mean(texels).to_array();
            json!({ "extent": [side, side], "height": height, "mean": mean })
        };
        let summary = json!({
            "texture": self.name,
            "size": [self.size.side(0), self.size.side(0)],
            "levels": self.levels().map(level).collect::<Value>(),
        });
        format!("{summary:#}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bright_images_are_exposed_to_their_peak() {
        let size = PyramidSize::new(128).unwrap();
        let level = |peak: f32| {
            let mut texels = vec![[0.0, 0.0, 0.0, 99.0]; 128 * 128];
            texels[7] = [0.5, peak, 0.0, 99.0];
            Pyramid { name: "a".into(), size, levels: vec![texels] }
        };
        let (bright, other) = (level(16.0).found(), level(0.5).found());
        assert_eq!(bright["title"], "a\n128 x 128 texels; white is 16.000");
        assert_eq!(other["title"], "a\n128 x 128 texels");
        let mut bytes = vec![0; 3 * 128 * 128];
        bytes[21..24].copy_from_slice(&[0.5 / 16.0, 1.0, 0.0].map(srgb_from_linear));
        assert_eq!(bright["levels"][0]["srgb"], bytes_of(&bytes));
        bytes[21..24].copy_from_slice(&[0.5, 0.5, 0.0].map(srgb_from_linear));
        assert_eq!(other["levels"][0]["srgb"], bytes_of(&bytes));
    }
}
