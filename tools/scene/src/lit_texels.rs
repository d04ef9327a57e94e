//! Which parts of an image are black.

use crate::scene::Image;
use glam::DVec2;

/// Counts texels that are not black in any frame, in any rectangle at once: sums over all texels above and to
/// the left.
pub(crate) struct LitTexels {
    width: usize,
    height: usize,
    /// A row and a column more than the image has; the first of each is zero.
    sums: Vec<u32>,
}

impl LitTexels {
    pub fn new(image: &Image) -> Self {
        let (width, height) = (image.width as usize, image.height as usize);
        let stride = width + 1;
        let mut sums = vec![0_u32; stride * (height + 1)];
        let frames = || image.frames.iter().map(|(_, texels)| texels).chain([&image.texels]);
        for y in 0..height {
            let mut row_sum = 0;
            for x in 0..width {
                row_sum += u32::from(frames().any(|texels| texels[y * width + x] & 0x00ff_ffff != 0));
                sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row_sum;
            }
        }
        Self { width, height, sums }
    }

    /// Whether bilinear samples between the texture coordinates `low` and `high` are all black. What is
    /// outside of the image stands for all of it.
    pub fn is_black(&self, low: DVec2, high: DVec2) -> bool {
        let texels = |low: f64, high: f64, side: usize| {
            let last = side as f64;
            let first = (low * last - 0.5).floor().max(0.0);
            let past = ((high * last - 0.5).floor() + 2.0).min(last);
            if low >= 0.0 && high <= 1.0 { first as usize..past as usize } else { 0..side }
        };
        let (x, y) = (texels(low.x, high.x, self.width), texels(low.y, high.y, self.height));
        let sum = |x: usize, y: usize| u64::from(self.sums[y * (self.width + 1) + x]);
        sum(x.end, y.end) + sum(x.start, y.start) == sum(x.start, y.end) + sum(x.end, y.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_is_where_no_sample_is_lit() {
        // One texel of 8 x 4 is lit: (5, 2)
        let texels = (0..32).map(|i| u32::from_le_bytes([0, u8::from(i == 21), 0, 255])).collect();
        let lit = LitTexels::new(&Image { width: 8, height: 4, texels, ..Image::default() });
        let black = |x0: f64, y0: f64, x1: f64, y1: f64| {
            lit.is_black(DVec2::new(x0 / 8.0, y0 / 4.0), DVec2::new(x1 / 8.0, y1 / 4.0))
        };
        assert!(!black(0.0, 0.0, 8.0, 4.0) && !black(5.2, 2.2, 5.8, 2.8));
        // Bilinear samples reach to the next texels' centres
        assert!(black(1.0, 1.0, 4.4, 3.0) && !black(1.0, 1.0, 4.6, 3.0));
        assert!(black(6.6, 1.0, 7.4, 3.0) && !black(6.4, 1.0, 7.4, 3.0));
        assert!(black(5.0, 0.6, 6.0, 1.4) && !black(5.0, 0.6, 6.0, 1.6));
        // What repeats may show all of a row
        assert!(black(0.0, 2.0, 1.0, 3.0) && !black(-80.0, 2.0, -79.0, 3.0) && black(-80.0, 0.0, -79.0, 1.0));
    }
}
