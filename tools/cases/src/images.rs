//! Images beside a file of cases.

use arealight_oracle::texture::Texture;
use exr::prelude::{ReadChannels, ReadLayers, read};
use glam::DVec3;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest image that is read: that of the largest picture of `arealight render`.
const MAX_SIDE: usize = 8192;

/// Images in one folder; each is read once.
pub struct Images {
    folder: PathBuf,
    known: HashMap<String, Result<Arc<Texture>, String>>,
    memory: fn(u64) -> u64,
    read: u64,
    taken: u64,
}

impl Images {
    /// Those beside `file`; `memory` says how many bytes they may take together, by the bytes of their files.
    pub fn beside(file: &Path, memory: fn(u64) -> u64) -> Self {
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        Self { folder, known: HashMap::new(), memory, read: 0, taken: 0 }
    }

    /// The image of a path in the folder: OpenEXR, linear, its channels R, G and B.
    ///
    /// # Errors
    /// Why it cannot be read, in words.
    pub fn load(&mut self, path: &str) -> Result<Arc<Texture>, String> {
        if let Some(known) = self.known.get(path) {
            return known.clone();
        }
        let image = self.read(&self.folder.join(path)).and_then(|image| {
            match image.texels().iter().position(|texel| texel.min_element() < 0.0) {
                Some(at) => Err(format!("texels[{at}]: {} must not be negative", image.texels()[at])),
                None => Ok(Arc::new(image)),
            }
        });
        self.known.insert(path.to_owned(), image.clone());
        image
    }

    /// The image at a path from anywhere; a picture may have what is below zero.
    pub fn read(&mut self, path: &Path) -> Result<Texture, String> {
        let about = std::fs::metadata(path).map_err(|error| error.to_string())?;
        if !about.is_file() {
            return Err("not a plain file".into());
        }
        self.read = self.read.saturating_add(about.len());
        let most = (self.memory)(self.read);
        load_image(path, |texels| {
            self.taken = self.taken.saturating_add(texels.saturating_mul(size_of::<DVec3>() as u64));
            if self.taken <= most {
                Ok(())
            } else {
                Err(format!(
                    "{texels} texels take more memory than {most} bytes with \
                those of other images; --memory allows more"
                ))
            }
        })
    }
}

/// An image: OpenEXR, linear, its channels R, G and B, where it may have so many texels.
fn load_image(path: &Path, mut take: impl FnMut(u64) -> Result<(), String>) -> Result<Texture, String> {
    // The header first: what it says is not yet to be trusted with memory
    let header = exr::meta::MetaData::read_from_file(path, true)
        .map_err(|error| format!("is not read as OpenEXR ({error}); pictures of radiance are .exr"))?;
    for layer in &header.headers {
        let (width, height) = (layer.layer_size.width(), layer.layer_size.height());
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(format!("{width} x {height} texels; at most {MAX_SIDE} a side"));
        }
        take(width as u64 * height as u64)?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.width(), vec![DVec3::ZERO; size.area()]),
            |(width, texels), at, (r, g, b): (f32, f32, f32)| {
                texels[at.y() * *width + at.x()] = DVec3::new(r.into(), g.into(), b.into());
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(|error| error.to_string())?;
    let (width, texels) = image.layer_data.channel_data.pixels;
    Texture::new(width, texels.len() / width.max(1), texels).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_read_once_and_what_is_none_has_a_reason() {
        let folder = tempfile::tempdir().unwrap();
        let pixel = |x: usize, y: usize| (x as f32, y as f32, 0.5);
        exr::prelude::write_rgb_file(folder.path().join("a.exr"), 3, 2, pixel).unwrap();
        std::fs::write(folder.path().join("b.exr"), "no image").unwrap();
        let mut images = Images::beside(&folder.path().join("cases.json"), |_| 300);
        for texel in [-0.5, f32::NAN, f32::INFINITY] {
            exr::prelude::write_rgb_file(folder.path().join("f.exr"), 1, 1, |_, _| (1.0, texel, 1.0))
                .unwrap();
            let mut images = Images::beside(&folder.path().join("cases.json"), |_| 300);
            let error = images.load("f.exr").unwrap_err();
            assert!(error.contains(if texel < 0.0 { "must not be negative" } else { "must be finite" }));
            assert_eq!(images.read(&folder.path().join("f.exr")).is_ok(), texel.is_finite());
        }
        let image = images.load("a.exr").unwrap();
        assert_eq!((image.width(), image.height()), (3, 2));
        assert_eq!(image.texel(2, 1), DVec3::new(2.0, 1.0, 0.5));
        assert!(Arc::ptr_eq(&image, &images.load("a.exr").unwrap()));
        assert!(images.load("b.exr").is_err() && images.load("c.exr").is_err());
        assert_eq!(images.load(".").unwrap_err(), "not a plain file");
        // Six texels of 24 bytes, and so many once more; then there is no room
        exr::prelude::write_rgb_file(folder.path().join("d.exr"), 3, 2, pixel).unwrap();
        exr::prelude::write_rgb_file(folder.path().join("e.exr"), 3, 2, pixel).unwrap();
        images.load("d.exr").unwrap();
        assert!(images.load("e.exr").unwrap_err().starts_with("6 texels take more memory than 300 bytes"));
    }
}
