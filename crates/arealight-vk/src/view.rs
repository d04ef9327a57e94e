//! From where a frame is seen, and which pixels of the host's images it is.

use crate::error::Error;
use crate::frame::{ShadeFrame, Viewport};
use arealight::plan::ShadeOptions;
use glam::{DMat4, DVec3, Mat4};

/// A frame's view, as kernels have it.
pub(crate) struct View {
    /// From the clip space that kernels make of a pixel, y down and depth as stored, to positions.
    pub(crate) position_from_clip: Mat4,
    pub(crate) camera: [f32; 3],
}

/// The view of a frame, checked.
pub(crate) fn view_of(options: ShadeOptions, frame: &ShadeFrame) -> Result<View, Error> {
    let wrong = |field, message: &str| Err(Error::InvalidArgument { field, message: message.into() });
    let given = match (options.from_depth, frame.position_from_clip) {
        (true, None) => {
            return wrong("position_from_clip", "is missing, but the pass takes positions from depth");
        }
        (_, matrix) => matrix.unwrap_or(Mat4::IDENTITY),
    };
    if !frame.camera.is_finite() {
        return wrong("camera", "holds NaN or infinity");
    }
    if options.orthographic && frame.camera.length_squared() == 0.0 {
        return wrong("camera", "is zero, but of an orthographic camera it is the direction to it");
    }
    if frame.size.contains(&0) {
        return wrong("size", "has no pixels");
    }
    if frame.offset != [0, 0] && !options.rectangle {
        return wrong("offset", "is not zero, but the pass was made without ShadeOptions::rectangle");
    }
    let end = |axis: usize| u64::from(frame.offset[axis]) + u64::from(frame.size[axis]);
    if options.rectangle && (0..2).any(|axis| end(axis) > MOST_PIXELS) {
        return wrong("offset", "lies beyond any image, with the frame's size");
    }
    if frame.viewport.is_some_and(|viewport| !viewport.is_one()) {
        return wrong("viewport", "is empty, or holds NaN or infinity");
    }
    let position_from_clip = match frame.viewport {
        None if options.texels_per_pixel == 1 => given,
        viewport => {
            let viewport = viewport.unwrap_or_else(|| Viewport::of_frame(options, frame));
            (given.as_dmat4() * clip_of_viewport(options, frame, &viewport)).as_mat4()
        }
    };
    if !position_from_clip.is_finite() {
        return wrong("position_from_clip", "holds NaN or infinity");
    }
    Ok(View { position_from_clip, camera: frame.camera.to_array() })
}

/// Kernels count a G-buffer's texels, a multiple of the pixels, in signed integers.
const MOST_PIXELS: u64 = i32::MAX as u64 / ShadeOptions::MOST_TEXELS_PER_PIXEL as u64;

impl Viewport {
    /// Just the texels of a frame's pixels.
    fn of_frame(options: ShadeOptions, frame: &ShadeFrame) -> Self {
        let texels = |pixels: u32| pixels as f32 * options.texels_per_pixel as f32;
        let [[x, y], [width, height]] = [frame.offset, frame.size].map(|pixels| pixels.map(texels));
        Self { x, y, width, height, min_depth: 0.0, max_depth: 1.0 }
    }

    fn is_one(&self) -> bool {
        let Self { x, y, width, height, min_depth, max_depth } = *self;
        [x, y, width, height, min_depth, max_depth].into_iter().all(f32::is_finite)
            && width > 0.0
            && height != 0.0
            && min_depth != max_depth
    }
}

/// From the clip space of the frame's pixels and stored depth to that of the viewport that drew them.
fn clip_of_viewport(options: ShadeOptions, frame: &ShadeFrame, viewport: &Viewport) -> DMat4 {
    let texels = f64::from(options.texels_per_pixel);
    // Clip space is `scale` times that of the pixels, plus `shift`: both are linear in the place of a texel's
    // centre
    let axis = |axis: usize, start: f32, extent: f32| {
        let (size, offset) = (f64::from(frame.size[axis]), f64::from(frame.offset[axis]));
        let (start, extent) = (f64::from(start), f64::from(extent));
        let scale = texels * size / extent;
        // The centre of a pixel's first texel is not the pixel's
        let center = texels * offset - 0.5 * (texels - 1.0) - start;
        (scale, 2.0 * center / extent + scale - 1.0)
    };
    let x = axis(0, viewport.x, viewport.width);
    let y = axis(1, viewport.y, viewport.height);
    let (near, far) = (f64::from(viewport.min_depth), f64::from(viewport.max_depth));
    let z = (1.0 / (far - near), -near / (far - near));
    DMat4::from_translation(DVec3::new(x.1, y.1, z.1)) * DMat4::from_scale(DVec3::new(x.0, y.0, z.0))
}

/// Refuses options of a view that no pass can be made with.
pub(crate) fn check_view(options: ShadeOptions) -> Result<(), Error> {
    let wrong = |field, message: String| Err(Error::InvalidArgument { field, message });
    let most = ShadeOptions::MOST_TEXELS_PER_PIXEL;
    if !(1..=most).contains(&options.texels_per_pixel) {
        let message = format!("is {}, but must be from 1 to {most}", options.texels_per_pixel);
        return wrong("texels_per_pixel", message);
    }
    if ![1, 2, 4, 8].contains(&options.samples) {
        return wrong("samples", format!("is {}, but must be 1, 2, 4 or 8", options.samples));
    }
    if options.samples > 1 && options.texels_per_pixel > 1 {
        return wrong("samples", "are several, but half resolution is of one sample a texel".into());
    }
    if options.shadow_rays == 0 {
        return Ok(());
    }
    check_whole(options, &[(options.stencil, "stencil")], "shadow rays are of whole frames")
}

/// Refuses options of pictures that are not whole, with one sample a pixel, or that have any of `others`.
pub(crate) fn check_whole(
    options: ShadeOptions,
    others: &[(bool, &'static str)],
    why: &str,
) -> Result<(), Error> {
    let these = [
        (options.rectangle, "rectangle"),
        (options.texels_per_pixel != 1, "texels_per_pixel"),
        (options.samples != 1, "samples"),
    ];
    these.iter().chain(others).find(|(is_set, _)| *is_set).map_or(Ok(()), |(_, field)| {
        let message = format!("is set, but {why} with one sample a pixel");
        Err(Error::InvalidArgument { field, message })
    })
}
