//! A picture on the CPU.

use crate::Result;
use arealight_host::{Frames, Image, Usage};
use glam::{Vec3, Vec4};
use std::path::Path;

/// Radiance, row after row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear Rec. 709 radiance in xyz, W/(m² sr).
    pub pixels: Vec<Vec4>,
}

impl Picture {
    /// Waits for the frames in flight, and reads an image of `R32G32B32A32_SFLOAT` whose last use was this.
    pub fn read(frames: &Frames, image: &Image, last: Usage) -> Result<Self> {
        frames.wait()?;
        Ok(Self { size: image.extent(), pixels: image.download(last)? })
    }

    /// Red, green and blue as a screen takes them: brightness is compressed (Reinhard) and encoded as sRGB.
    /// `tone_map.comp` does so too.
    pub fn encoded(&self) -> Vec<u8> {
        let encode = |pixel: &Vec4| {
            let shown = pixel.truncate() / (Vec3::ONE + pixel.truncate());
            shown.to_array().map(|value| (255.0 * srgb(value) + 0.5) as u8)
        };
        self.pixels.iter().flat_map(encode).collect()
    }

    /// Writes a PNG of it [as a screen takes it](Self::encoded).
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        Ok(image::save_buffer(path, &self.encoded(), self.size[0], self.size[1], image::ColorType::Rgb8)?)
    }
}

fn srgb(linear: f32) -> f32 {
    if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}
