//! What textured lights show: rectangles of images, each a layer of the light textures.
//!
//! A light's texture coordinates lie within a layer, so the box around them, in the image's coordinates, is
//! loaded into one. Lights that show the same box share it.
//!
//! A box of its own also keeps a blurred light to its own colours: what lies beside it in an atlas stays out.
//! Only an image that is cut into many pieces (a bent screen, say) is loaded whole, where a layer for each
//! would be many times its size.

use crate::images::{Textures, halved};
use crate::messages::Messages;
use crate::scene::{Scene, SceneLightTexture, Texture};
use crate::shown::{Images, Key, Rectangle, Shown, TexturedLight};
use crate::small_parts;
use arealight::pyramid::PyramidSize;
use arealight::{Light, LightShape, LightTexture, TexturePart};
use glam::DVec2;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// The most light textures a scene has; further lights have the mean colour of what they show. Each takes
/// four array layers: `maxImageArrayLayers` is 2,048 on desktop GPUs, and 256 at least.
pub const MAX_LIGHT_TEXTURES: usize = 256;

/// The most texels that [`Scene::light_texture_size`] allows for all layers: half a gibibyte at eight bytes
/// each.
pub const MAX_LIGHT_TEXELS: u64 = 1 << 26;

/// An image that is shown in more pieces than these, whose areas add up to at least half of it, is loaded
/// whole.
const FEW_PIECES: usize = 4;

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
            part: TexturePart {
                low: shown.low,
                size: shown.size,
                wrap: [texture.wrap_u, texture.wrap_v],
                aspect: shown.aspect,
                is_ellipse: shown.is_ellipse,
                divisor: 1.0,
            },
        })
    }

    /// A size for all layers of the light textures: as many texels a side as the longest one has, but at most
    /// `largest` (1024 is enough for most scenes) and [`MAX_LIGHT_TEXELS`] in all. None if there are no light
    /// textures.
    pub fn light_texture_size(&self, largest: u32) -> Option<PyramidSize> {
        let largest = largest.clamp(PyramidSize::SMALLEST, PyramidSize::LARGEST);
        let sources = (0..self.light_textures.len()).filter_map(|layer| self.light_texture_source(layer));
        let sides = sources.map(|source| {
            let texels = source.part.size * DVec2::new(f64::from(source.width), f64::from(source.height));
            texels.max_element().ceil() as u32
        });
        let wanted = PyramidSize::for_image(sides.max()?.min(largest), 1).side(0);
        // A limit between two powers of two is kept, too
        let first = if wanted > largest { wanted / 2 } else { wanted };
        let layers = self.light_textures.len() as u64;
        let sides = std::iter::successors(Some(first), |side| Some(side / 2));
        let mut sizes = sides.map_while(|side| PyramidSize::new(side).ok());
        let smallest = PyramidSize::new(PyramidSize::SMALLEST).ok();
        sizes.find(|size| size.texels() * layers <= MAX_LIGHT_TEXELS).or(smallest)
    }
}

/// Gives the textured lights their layers, which it returns; those that show one colour get that, or black.
pub(crate) fn assign(
    textured: &[TexturedLight],
    lights: &mut [Light],
    textures: &mut Textures,
    messages: &mut Messages,
) -> Vec<SceneLightTexture> {
    // Find out what each shows
    let mut images = Images::default();
    let mut shown: Vec<Shown> = textured.iter().map(|light| images.shown(textures, light)).collect();
    let simplified = small_parts::simplify(lights, textures, textured, &mut shown);
    let mut layers = Layers { whole: shown_in_many_pieces(&shown), ..Layers::default() };
    let mut losses: Vec<(&str, Vec<usize>)> = Vec::new();
    for (TexturedLight { owner, .. }, shown) in textured.iter().zip(shown) {
        // Show it, or else its colour
        let light = &mut lights[*owner];
        let (color, loss) = match shown {
            Shown::Color(color) => (color, None),
            Shown::Lost(color, loss) => (color, Some(loss)),
            Shown::Rectangle(rectangle) => match layers.show_to(light, &rectangle) {
                Ok(()) => continue,
                Err(loss) => (rectangle.mean(textures), Some(loss)),
            },
        };
        light.radiance *= color.as_vec3();
        if let Some(loss) = loss {
            match losses.iter_mut().find(|(known, _)| *known == loss) {
                Some((_, owners)) => owners.push(*owner),
                None => losses.push((loss, vec![*owner])),
            }
        }
    }
    scale_down(&mut layers.made, textures);
    for owners in simplified {
        let text = "small, one of many parts of its surface: its mean colour is everywhere";
        warn_of(lights, &owners, text, messages);
    }
    for (loss, owners) in losses {
        warn_of(lights, &owners, &format!("{loss}: its mean colour is everywhere"), messages);
    }
    layers.made
}

/// Warns once of all `owners`, if there are any.
fn warn_of(lights: &[Light], owners: &[usize], text: &str, messages: &mut Messages) {
    let Some(first) = owners.first() else { return };
    let name = &lights[*first].name;
    let more = if owners.len() > 1 { format!(" and {} more", owners.len() - 1) } else { String::new() };
    messages.warn(format!("light '{name}'{more}"), format!("emissiveTexture: {text}"));
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
fn scale_down(layers: &mut [SceneLightTexture], textures: &mut Textures) {
    // By texture and how often it is halved
    let mut known: HashMap<(u32, u32), u32> = HashMap::new();
    for layer in layers {
        let (image, _) = textures.get(layer.texture);
        let (sides, size) = ([image.width, image.height], layer.size.to_array());
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
        layer.texture = *known.entry((layer.texture, halvings)).or_insert_with(|| {
            let (image, texture) = textures.get(layer.texture);
            let mut smaller = halved(image, texture.srgb);
            for _ in 1..halvings {
                smaller = halved(&smaller, texture.srgb);
            }
            textures.images.push(smaller);
            textures.textures.push(Texture { image: textures.images.len() as u32 - 1, ..texture });
            textures.textures.len() as u32 - 1
        });
    }
}

/// The layers so far.
#[derive(Default)]
struct Layers {
    /// Textures that are loaded whole.
    whole: HashSet<u32>,
    made: Vec<SceneLightTexture>,
    /// By what they show, and the form of the lights: whether they are ellipses, and half octaves of their
    /// aspect.
    known: HashMap<(Key, bool, i32), u32>,
}

impl Layers {
    /// Gives a light the texture that shows `rectangle`, or says why there is none.
    fn show_to(&mut self, light: &mut Light, rectangle: &Rectangle) -> Result<(), &'static str> {
        let is_ellipse = matches!(light.shape, LightShape::Disk { .. });
        // Find the layer, or make one
        let mut key = rectangle.key();
        let (mut low, mut size) = (rectangle.low, rectangle.high - rectangle.low);
        if is_ellipse {
            let upright = |first: &DVec2| (*first - low).abs().cmplt(size * 0.5).all();
            if !rectangle.uvs.first().is_some_and(upright) {
                return Err("its texture is mirrored");
            }
        } else if self.whole.contains(&rectangle.texture) && rectangle.is_inside() {
            (low, size) = (DVec2::ZERO, DVec2::ONE);
            key = Key::of(rectangle.texture, low, size);
        }

        // Map the light onto it
        let uvs = rectangle.uvs.iter().map(|uv| ((*uv - low) / size).clamp(DVec2::ZERO, DVec2::ONE));
        let uvs = if is_ellipse { vec![] } else { uvs.collect() };
        let mut shown = Light { texture: Some(LightTexture { layer: 0, uvs }), ..light.clone() };
        if shown.validate().is_err() {
            return Err("its texture cannot be mapped");
        }
        let aspect = TexturePart::default().shown_by(&shown).aspect;
        let key = (key, is_ellipse, (2.0 * aspect.log2()).round() as i32);
        let layer = self.made.len() as u32;
        let layer = match self.known.entry(key) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(_) if self.made.len() == MAX_LIGHT_TEXTURES => {
                return Err("there are too many light textures");
            }
            Entry::Vacant(new) => {
                let texture = rectangle.texture;
                self.made.push(SceneLightTexture { texture, low, size, aspect, is_ellipse });
                *new.insert(layer)
            }
        };
        shown.texture.iter_mut().for_each(|texture| texture.layer = layer);
        light.texture = shown.texture;
        Ok(())
    }
}
