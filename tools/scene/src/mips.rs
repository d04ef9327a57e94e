//! The smaller levels of images, each half as wide and high as the one before, down to one texel.

use crate::images::{halved, halved_by};
use crate::scene::Image;
use glam::DVec3;

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

/// The texels of all levels, the image's own first. Of normals each texel has the mean's direction, and in
/// alpha how long that is (`mean_length` in scene.glsl), which a mean of normals that point apart is not.
pub(crate) fn levels(image: &Image, content: Content) -> Vec<u32> {
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
pub(crate) fn count(width: u32, height: u32) -> u64 {
    let [mut width, mut height] = [width, height].map(u64::from);
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

    fn image(width: u32, height: u32, texels: Vec<u32>) -> Image {
        Image { name: "image".into(), width, height, texels }
    }

    #[test]
    fn levels_go_down_to_one_texel() {
        for (width, height, expected) in [(4, 4, 21), (5, 3, 15 + 2 + 1), (1, 1, 1), (8, 1, 15)] {
            let image = image(width, height, vec![0xff80_8080; (width * height) as usize]);
            for content in [Content::Numbers, Content::Colors, Content::Normals] {
                let texels = levels(&image, content);
                assert_eq!((texels.len() as u64, count(width, height)), (expected, expected), "{content:?}");
            }
        }
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
