//! What textured lights show: rectangles of images, each a layer of the light textures.
//!
//! A light's texture coordinates lie within a layer, so the box around them, in the image's coordinates, is
//! loaded into one. Lights that show the same box share it.
//!
//! A box of its own also keeps a blurred light to its own colours: what lies beside it in an atlas stays out.
//! Only an image that is cut into many pieces (a bent screen, say) is loaded whole, where a layer for each
//! would be many times its size.

use crate::images::halved;
use crate::load::Loader;
use crate::shown::{Images, Key, Rectangle, Shown};
use crate::small_parts;
use crate::{Scene, Texture};
use arealight::pyramid::PyramidSize;
use arealight::{Light, LightShape, LightTexture, TexturePart};
use glam::DVec2;
use std::collections::{HashMap, HashSet};

/// The most light textures a scene has; further lights have the mean colour of what they show. As many layers
/// as every Vulkan device can have in an image.
pub const MAX_LIGHT_TEXTURES: usize = 256;

/// The most texels that [`Scene::light_texture_size`] allows for all layers: half a gibibyte at eight bytes
/// each.
pub const MAX_LIGHT_TEXELS: u64 = 1 << 26;

/// How often a light may repeat its image, along each axis, and still show it; beyond, it has the mean
/// colour. At 1024 texels a layer, sixteen are left for each repeat.
pub const MAX_REPEATS: f64 = 64.0;

/// An image that is shown in more pieces than these, whose areas add up to at least half of it, is loaded
/// whole.
const FEW_PIECES: usize = 4;

/// A layer of the light textures: a rectangle of a texture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneLightTexture {
    /// Index into [`Scene::textures`]. Its image is within the limits of [`TexturePart`]; a larger one has
    /// been scaled down.
    pub texture: u32,
    /// The corner that is (0, 0) in the layer, in the texture's coordinates. It may be outside of [0, 1],
    /// where the texture's wrap modes say what there is.
    pub low: DVec2,
    /// Width and height, in the texture's coordinates; both are positive.
    pub size: DVec2,
}

/// What there is to load into a layer of the light textures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightTextureSource<'a> {
    /// The image: its width in texels.
    pub width: u32,
    /// Its height.
    pub height: u32,
    /// Its texels: red in the low byte, then green, blue, alpha; rows from the top.
    pub texels: &'a [u32],
    /// Red, green and blue are sRGB-encoded.
    pub srgb: bool,
    /// The rectangle that the layer shows, and what there is beyond the image.
    pub part: TexturePart,
}

impl Scene {
    /// What layer `layer` of the light textures is loaded from; none if there is no such layer.
    pub fn light_texture_source(&self, layer: usize) -> Option<LightTextureSource<'_>> {
        let shown = self.light_textures.get(layer)?;
        let texture = self.textures.get(shown.texture as usize)?;
        let image = self.images.get(texture.image as usize)?;
        Some(LightTextureSource {
            width: image.width,
            height: image.height,
            texels: &image.texels,
            srgb: texture.srgb,
            part: TexturePart { low: shown.low, size: shown.size, wrap: [texture.wrap_u, texture.wrap_v] },
        })
    }

    /// A size for all layers of the light textures: as many texels as the most detailed one has, but at most
    /// `largest` a side (1024 is enough for most scenes) and [`MAX_LIGHT_TEXELS`] in all. None if there are
    /// no light textures.
    pub fn light_texture_size(&self, largest: u32) -> Option<PyramidSize> {
        let largest = largest.clamp(PyramidSize::SMALLEST, PyramidSize::LARGEST);
        let sources = (0..self.light_textures.len()).filter_map(|layer| self.light_texture_source(layer));
        let sizes = sources.map(|source| {
            let texels = source.part.size * DVec2::new(f64::from(source.width), f64::from(source.height));
            let [width, height] = texels.to_array().map(|side| side.ceil() as u32);
            PyramidSize::for_image(width.min(largest), height.min(largest)).extent(0)
        });
        let [width, height] = sizes.reduce(|[a, b], [c, d]| [a.max(c), b.max(d)])?;
        // A limit between two powers of two is kept, too
        let limit = if largest.is_power_of_two() { largest } else { largest.next_power_of_two() / 2 };
        let mut size = [width.min(limit), height.min(limit)];
        let layers = self.light_textures.len() as u64;
        loop {
            let fits = PyramidSize::new(size[0], size[1]).ok()?;
            if fits.texels() * layers <= MAX_LIGHT_TEXELS || size == [PyramidSize::SMALLEST; 2] {
                return Some(fits);
            }
            let longest = usize::from(size[1] > size[0]);
            size[longest] /= 2;
        }
    }
}

/// A textured light, while the scene is read.
pub(crate) struct TexturedLight {
    /// Which light: an index into [`Scene::lights`].
    pub owner: usize,
    /// Which surface it is a part of: the first light of that.
    pub surface: usize,
    /// Index into [`Scene::textures`].
    pub texture: u32,
    /// Of its vertices, in the texture's coordinates; of a disk those of its box's corners, the first texel's
    /// first.
    pub uvs: Vec<DVec2>,
}

/// How far coordinates of neighbours may be off one map and still be one light's: a quarter of a texel cannot
/// be seen, nor, in small images, a thousandth of the image.
pub(crate) fn tolerance(scene: &Scene, texture: u32) -> DVec2 {
    let image = &scene.images[scene.textures[texture as usize].image as usize];
    (0.25 / DVec2::new(f64::from(image.width), f64::from(image.height))).min(DVec2::splat(1e-3))
}

/// Gives the textured lights their layers; those that show one colour get that, or black.
pub(crate) fn assign(loader: &mut Loader) {
    let textured = std::mem::take(&mut loader.textured);
    let scene = &mut loader.scene;
    // Find out what each shows
    let mut images = Images::default();
    let mut shown: Vec<Shown> = textured.iter().map(|light| images.shown(scene, light)).collect();
    let simplified = small_parts::simplify(scene, &textured, &mut shown);
    let mut layers = Layers { whole: shown_in_many_pieces(&shown), ..Layers::default() };
    let mut losses: Vec<(&str, Vec<usize>)> = Vec::new();
    for (TexturedLight { owner, .. }, shown) in textured.iter().zip(shown) {
        // Show it, or else its colour
        let (color, loss) = match shown {
            Shown::Color(color) => (color, None),
            Shown::Lost(color, loss) => (color, Some(loss)),
            Shown::Rectangle(rectangle) => match layers.show_to(scene, *owner, &rectangle) {
                Ok(()) => continue,
                Err(loss) => (rectangle.mean(scene), Some(loss)),
            },
        };
        scene.lights[*owner].radiance *= color.as_vec3();
        if let Some(loss) = loss {
            match losses.iter_mut().find(|(known, _)| *known == loss) {
                Some((_, owners)) => owners.push(*owner),
                None => losses.push((loss, vec![*owner])),
            }
        }
    }
    scene.light_textures = layers.made;
    scale_down(scene);
    for small in simplified {
        warn_of(loader, &small, "small, one of many parts of its surface: its mean colour is everywhere");
    }
    for (loss, lights) in losses {
        warn_of(loader, &lights, &format!("{loss}: its mean colour is everywhere"));
    }
}

/// Warns once of all `lights`, if there are any.
fn warn_of(loader: &mut Loader, lights: &[usize], text: &str) {
    let Some(first) = lights.first() else { return };
    let name = &loader.scene.lights[*first].name;
    let more = if lights.len() > 1 { format!(" and {} more", lights.len() - 1) } else { String::new() };
    loader.warn(format!("light '{name}'{more}"), format!("emissiveTexture: {text}"));
}

/// Textures of which there are more pieces than a few that make up at least half of it.
fn shown_in_many_pieces(shown: &[Shown]) -> HashSet<u32> {
    let mut pieces: HashMap<u32, HashMap<Key, f64>> = HashMap::new();
    for rectangle in shown.iter().filter_map(Shown::rectangle).filter(|r| r.is_inside()) {
        let size = rectangle.high - rectangle.low;
        pieces.entry(rectangle.texture).or_default().insert(rectangle.key(), size.x * size.y);
    }
    let many = |areas: &HashMap<Key, f64>| areas.len() > FEW_PIECES && areas.values().sum::<f64>() >= 0.5;
    pieces.into_iter().filter(|(_, areas)| many(areas)).map(|(texture, _)| texture).collect()
}

/// Gives layers whose image is larger than a device loads ([`TexturePart`] has the limits) an image of fewer
/// texels.
fn scale_down(scene: &mut Scene) {
    // By texture and how often it is halved
    let mut known: HashMap<(u32, u32), u32> = HashMap::new();
    for layer in 0..scene.light_textures.len() {
        let Some(source) = scene.light_texture_source(layer) else { continue };
        let (sides, size) = ([source.width, source.height], source.part.size.to_array());
        let loads = |halvings: u32| {
            sides.iter().zip(size).all(|(side, size)| {
                let side = (side >> halvings).max(1);
                side <= TexturePart::LARGEST_SOURCE && f64::from(side) * size <= TexturePart::MOST_TEXELS
            })
        };
        // Fewer than 32: a side has that many bits, and a texel of the most repeats is loaded
        let halvings = (0..32).find(|halvings| loads(*halvings)).unwrap_or_default();
        if halvings == 0 {
            continue;
        }
        let whole = scene.light_textures[layer].texture;
        scene.light_textures[layer].texture = *known.entry((whole, halvings)).or_insert_with(|| {
            let texture = scene.textures[whole as usize];
            let mut image = halved(&scene.images[texture.image as usize], texture.srgb);
            for _ in 1..halvings {
                image = halved(&image, texture.srgb);
            }
            scene.images.push(image);
            scene.textures.push(Texture { image: scene.images.len() as u32 - 1, ..texture });
            scene.textures.len() as u32 - 1
        });
    }
}

/// The layers so far.
#[derive(Default)]
struct Layers {
    /// Textures that are loaded whole.
    whole: HashSet<u32>,
    made: Vec<SceneLightTexture>,
    known: HashMap<Key, u32>,
}

impl Layers {
    /// Gives a light the texture that shows `rectangle`, or says why there is none.
    fn show_to(
        &mut self,
        scene: &mut Scene,
        owner: usize,
        rectangle: &Rectangle,
    ) -> Result<(), &'static str> {
        let light = &scene.lights[owner];
        let texture = match light.shape {
            LightShape::Disk { .. } => self.show_upright(rectangle)?,
            _ => self.show(rectangle, light)?,
        };
        scene.lights[owner].texture = Some(texture);
        Ok(())
    }

    /// The texture of a disk that shows the whole of `rectangle`, or why there is none.
    fn show_upright(&mut self, rectangle: &Rectangle) -> Result<LightTexture, &'static str> {
        let (low, size) = (rectangle.low, rectangle.high - rectangle.low);
        let upright = |first: &DVec2| (*first - low).abs().cmplt(size * 0.5).all();
        if !rectangle.uvs.first().is_some_and(upright) {
            return Err("its texture is mirrored");
        }
        let new = SceneLightTexture { texture: rectangle.texture, low, size };
        Ok(LightTexture { layer: self.layer(rectangle.key(), new)?, uvs: vec![] })
    }

    /// The layer of a rectangle that is shown whole: one that is known, or a new one.
    fn layer(&mut self, key: Key, new: SceneLightTexture) -> Result<u32, &'static str> {
        if let Some(layer) = self.known.get(&key) {
            return Ok(*layer);
        }
        if self.made.len() == MAX_LIGHT_TEXTURES {
            return Err("there are too many light textures");
        }
        let layer = self.made.len() as u32;
        self.made.push(new);
        self.known.insert(key, layer);
        Ok(layer)
    }

    /// The texture of a light that shows `rectangle`, or why there is none.
    fn show(&mut self, rectangle: &Rectangle, light: &Light) -> Result<LightTexture, &'static str> {
        // Find the layer, or make one
        let mut key = rectangle.key();
        let (mut low, mut size) = (rectangle.low, rectangle.high - rectangle.low);
        if self.whole.contains(&rectangle.texture) && rectangle.is_inside() {
            (low, size) = (DVec2::ZERO, DVec2::ONE);
            key = Key::of(rectangle.texture, low, size);
        }
        let known = self.known.get(&key).copied();
        let new = SceneLightTexture { texture: rectangle.texture, low, size };
        let SceneLightTexture { low, size, .. } = known.map_or(new, |layer| self.made[layer as usize]);

        // Map the light onto it
        let uvs = rectangle.uvs.iter().map(|uv| ((*uv - low) / size).clamp(DVec2::ZERO, DVec2::ONE));
        let mut texture = LightTexture { layer: known.unwrap_or_default(), uvs: uvs.collect() };
        let with_texture = Light { texture: Some(texture.clone()), ..light.clone() };
        if with_texture.validate().is_err() {
            return Err("its texture cannot be mapped");
        }
        texture.layer = self.layer(key, new)?;
        Ok(texture)
    }
}
