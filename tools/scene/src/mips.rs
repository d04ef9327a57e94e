//! The smaller levels of images, each half as wide and high as the one before, down to one texel.

use crate::images::{halved, halved_by};
use crate::scene::{Image, Scene, SceneMaterial, Texture};
use glam::DVec3;
use std::collections::BTreeMap;

/// The most texels of a scene: 128 MiB, what every device binds to a shader.
pub(crate) const MOST_TEXELS: u64 = 1 << 25;

/// What an image's channels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Content {
    /// sRGB-encoded colours.
    Colors,
    /// Numbers.
    Numbers,
    /// Unit normals.
    Normals,
}

/// An image as it is read, and the size of its finest level.
type Sizes = BTreeMap<(u32, Content), [u32; 2]>;

/// What each of some textures' images is read as.
fn contents(textures: &[Texture], materials: &[SceneMaterial]) -> Vec<Content> {
    let content = |texture: &Texture| if texture.srgb { Content::Colors } else { Content::Numbers };
    let mut contents: Vec<Content> = textures.iter().map(content).collect();
    for material in materials {
        for texture in [material.normal_texture, material.coat_normal_texture].into_iter().flatten() {
            contents[texture as usize] = Content::Normals;
        }
    }
    contents
}

/// The images' sizes where all levels have `most` texels at most: the largest lose their finest ones.
fn sizes(textures: &[Texture], contents: &[Content], images: &[Image], most: u64) -> Sizes {
    let of_image = |image: &Image| [image.width, image.height];
    let read = textures.iter().zip(contents).map(|(texture, content)| (texture.image, *content));
    let mut sizes: Sizes = read.map(|key| (key, of_image(&images[key.0 as usize]))).collect();
    let mut total: u64 = sizes.values().map(|size| count(*size)).sum();
    while total > most {
        let area = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
        let Some(largest) = sizes.values_mut().max_by_key(|size| area(**size)) else { break };
        total -= area(*largest);
        *largest = largest.map(|side| (side / 2).max(1));
    }
    sizes
}

/// How many images are smaller than the file's, for all to be of [`MOST_TEXELS`].
pub(crate) fn smaller(textures: &[Texture], materials: &[SceneMaterial], images: &[Image]) -> usize {
    let sizes = sizes(textures, &contents(textures, materials), images, MOST_TEXELS);
    let is_smaller = |(image, size): (u32, [u32; 2])| {
        let whole = &images[image as usize];
        size != [whole.width, whole.height]
    };
    sizes.into_iter().filter(|((image, _), size)| is_smaller((*image, *size))).count()
}

/// The first texel, width and height of each of a scene's textures, and the texels, which are `most` at most.
/// The levels of an image follow one another; one that is read in two ways is there twice.
pub(crate) fn pack(scene: &Scene, most: u64) -> (Vec<[u32; 3]>, Vec<u32>) {
    let contents = contents(&scene.textures, &scene.materials);
    let sizes = sizes(&scene.textures, &contents, &scene.images, most);
    let mut texels = vec![];
    let mut firsts = BTreeMap::new();
    for ((image, content), size) in &sizes {
        firsts.insert((*image, *content), texels.len() as u32);
        let levels = levels(&scene.images[*image as usize], *content);
        texels.extend_from_slice(&levels[levels.len() - count(*size) as usize..]);
    }
    let place = |(texture, content): (&Texture, &Content)| {
        let [width, height] = sizes[&(texture.image, *content)];
        [firsts[&(texture.image, *content)], width, height]
    };
    (scene.textures.iter().zip(&contents).map(place).collect(), texels)
}

/// The texels of all levels, the image's own first. Of normals each texel has the mean's direction, and in
/// alpha how long that is (`mean_length` in scene.glsl), which a mean of normals that point apart is not.
fn levels(image: &Image, content: Content) -> Vec<u32> {
    let own = match content {
        Content::Normals => whole_normals(image),
        _ => image.clone(),
    };
    let mut texels = own.texels.clone();
    let mut level = own;
    while level.width.max(level.height) > 1 {
        level = match content {
            Content::Normals => {
                halved_by(&level, |near| encode(near.map(decode).into_iter().sum::<DVec3>() * 0.25))
            }
            _ => halved(&level, content == Content::Colors),
        };
        texels.extend_from_slice(&level.texels);
    }
    texels
}

/// How many texels the levels of an image of a size have.
fn count(size: [u32; 2]) -> u64 {
    let [mut width, mut height] = size.map(u64::from);
    let mut count = width * height;
    while width.max(height) > 1 {
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
        count += width * height;
    }
    count
}

fn decode(texel: u32) -> DVec3 {
    let [x, y, z, alpha] = texel.to_le_bytes().map(|byte| f64::from(byte) / 255.0);
    let short = 1.0 - alpha;
    (DVec3::new(x, y, z) * 2.0 - 1.0).normalize_or(DVec3::Z) * (1.0 - short * short)
}

fn encode(mean: DVec3) -> u32 {
    let byte = |value: f64| (value * 255.0).round() as u8;
    let [x, y, z] = (mean.normalize_or(DVec3::Z) * 0.5 + 0.5).to_array().map(byte);
    u32::from_le_bytes([x, y, z, byte(1.0 - (1.0 - mean.length().min(1.0)).sqrt())])
}

/// Normals as the file has them, whatever its alpha.
fn whole_normals(image: &Image) -> Image {
    Image { texels: image.texels.iter().map(|texel| texel | 0xff00_0000).collect(), ..image.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Wrap;

    fn image(width: u32, height: u32, texels: Vec<u32>) -> Image {
        Image { width, height, texels, ..Image::default() }
    }

    #[test]
    fn levels_go_down_to_one_texel() {
        for (width, height, expected) in [(4, 4, 21), (5, 3, 15 + 2 + 1), (1, 1, 1), (8, 1, 15)] {
            let image = image(width, height, vec![0xff80_8080; (width * height) as usize]);
            for content in [Content::Numbers, Content::Colors, Content::Normals] {
                let texels = levels(&image, content);
                let counts = [texels.len() as u64, count([width, height])];
                assert_eq!(counts, [expected; 2], "{content:?}");
            }
        }
    }

    #[test]
    fn the_largest_images_lose_their_finest_levels() {
        let texture = |image: u32| Texture { image, srgb: false, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat };
        let scene = Scene {
            images: vec![image(8, 8, vec![1; 64]), image(4, 4, vec![2; 16])],
            textures: vec![texture(0), texture(1), texture(0)],
            ..Scene::default()
        };
        // 64 + 16 + 4 + 1, and 16 + 4 + 1
        let (whole, texels) = pack(&scene, 106);
        assert_eq!((&whole[..], texels.len()), (&[[0, 8, 8], [85, 4, 4], [0, 8, 8]][..], 106));
        let (reduced, texels) = pack(&scene, 105);
        assert_eq!((&reduced[..], texels.len()), (&[[0, 4, 4], [21, 4, 4], [0, 4, 4]][..], 42));
        assert!(texels[..21].iter().all(|texel| *texel == 1) && texels[21..].iter().all(|texel| *texel == 2));
        assert_eq!(smaller(&scene.textures, &[], &scene.images), 0);
    }

    #[test]
    fn a_mean_of_normals_says_how_far_they_point_apart() {
        let tilted = |angle: f64| encode(DVec3::new(angle.sin(), 0.0, angle.cos())) | 0xff00_0000;
        for angle in [0.0, 0.1, 0.5, 1.2] {
            let pair = image(2, 1, vec![tilted(angle), tilted(-angle)]);
            let mean = decode(levels(&pair, Content::Normals)[2]);
            // Alpha has a step of a 255th, of the root of what is short of 1
            assert!((mean.length() - angle.cos()).abs() < 0.012, "{angle}: {mean}");
            assert!(mean.normalize_or_zero().z > 0.9999);
        }
        // The twin: what alpha says in the file is not that
        let pair = image(2, 1, vec![tilted(0.0) & 0x00ff_ffff; 2]);
        assert!((decode(levels(&pair, Content::Normals)[2]).length() - 1.0).abs() < 1e-3);
    }
}
