//! Large pictures in bands of rows, so that memory is bounded whatever their size.

use arealight_tool_kernels::gpu::VisibilityConstants;
use glam::Vec3;
use std::ops::Range;

/// Samples that are on the device at once: 170 bytes each, 1.4 GB.
pub const MOST_SAMPLES: u64 = 1 << 23;

/// Rows beyond a band that its shadows are filtered with: the filter reads 6, and what it reads has read 6
/// more.
const MARGIN: u32 = 16;

/// Rows of a picture that are rendered together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Band {
    /// What is kept.
    pub kept: Range<u32>,
    /// What is rendered: that, and a margin where there are other bands.
    pub rendered: Range<u32>,
}

impl Band {
    /// A picture's bands from the top, each of at most `most` samples but for a single row and its margin.
    pub fn of([width, height]: [u32; 2], most: u64) -> Vec<Self> {
        let rows = most / u64::from(width.max(1));
        if rows >= u64::from(height) {
            return vec![Self { kept: 0..height, rendered: 0..height }];
        }
        let step = (rows as u32).saturating_sub(2 * MARGIN).max(1);
        let band = |first: u32| {
            let kept = first..first.saturating_add(step).min(height);
            let rendered = kept.start.saturating_sub(MARGIN)..kept.end.saturating_add(MARGIN).min(height);
            Self { kept, rendered }
        };
        (0..height).step_by(step as usize).map(band).collect()
    }

    /// The size of what is rendered.
    pub fn size(&self, width: u32) -> [u32; 2] {
        [width, self.rendered.end - self.rendered.start]
    }

    /// The camera of a picture of `height` rows that sees what is rendered.
    pub fn camera(&self, picture: VisibilityConstants, height: u32) -> VisibilityConstants {
        let of_height = |rows: u32| f64::from(rows) / f64::from(height);
        // The plane at distance 1 from y = -1, the bottom, to 1; rows count from the top
        let middle = 1.0 - of_height(self.rendered.start + self.rendered.end);
        let part = of_height(self.rendered.end - self.rendered.start);
        let up = Vec3::from(picture.up).as_dvec3();
        let moved = |from: [f32; 3]| (Vec3::from(from).as_dvec3() + middle * up).as_vec3().to_array();
        let first_row = self.rendered.start;
        let mut band = VisibilityConstants { up: (part * up).as_vec3().to_array(), first_row, ..picture };
        // A pinhole turns, and lines of sight that are parallel begin elsewhere
        if picture.orthographic == 0 {
            band.forward = moved(picture.forward);
        } else {
            band.camera = moved(picture.camera);
        }
        band
    }

    /// Of the values of what is rendered, row by row, those of what is kept.
    pub fn keep<T>(&self, width: u32, mut values: Vec<T>) -> Vec<T> {
        let at = |row: u32| (row - self.rendered.start) as usize * width as usize;
        values.truncate(at(self.kept.end));
        values.drain(..at(self.kept.start));
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_keep_each_row_once() {
        assert_eq!(Band::of([640, 360], MOST_SAMPLES), [Band { kept: 0..360, rendered: 0..360 }]);
        for (size, most) in [([100, 1000], 100 * 100), ([8192, 2100], MOST_SAMPLES), ([7, 50], 1)] {
            let bands = Band::of(size, most);
            assert!(bands.len() > 1);
            let kept: Vec<u32> = bands.iter().flat_map(|band| band.kept.clone()).collect();
            assert_eq!(kept, (0..size[1]).collect::<Vec<_>>());
            for band in &bands {
                let rows = band.size(size[0])[1];
                assert!(u64::from(rows * size[0]) <= most || rows <= 1 + 2 * MARGIN, "{band:?}");
                let values = band.rendered.clone().flat_map(|row| vec![row; size[0] as usize]).collect();
                let kept: Vec<u32> = band.kept.clone().flat_map(|row| vec![row; size[0] as usize]).collect();
                assert_eq!(band.keep(size[0], values), kept);
            }
        }
    }

    #[test]
    fn a_band_sees_what_the_picture_does_there() {
        let picture = VisibilityConstants {
            camera: [1.0, 2.0, 3.0],
            orthographic: 0,
            right: [0.5, 0.0, 0.0],
            supersample: 1,
            up: [0.0, 0.4, 0.1],
            first_row: 0,
            forward: [0.0, 0.0, -1.0],
            reserved3: 0,
            background: [0.0; 3],
            reserved4: 0,
        };
        // As the kernel sends a ray through the middle of a row: where it starts, and its direction
        let ray = |camera: &VisibilityConstants, row: u32, rows: u32| {
            let across = Vec3::from(camera.up) * (1.0 - (row as f32 + 0.5) / rows as f32 * 2.0);
            let [start, forward] = [camera.camera, camera.forward].map(Vec3::from);
            if camera.orthographic == 0 { [start, forward + across] } else { [start + across, forward] }
        };
        let off = |[a, b]: [Vec3; 2], [c, d]: [Vec3; 2]| a.distance(c) + b.distance(d);
        for orthographic in [0, 1] {
            let picture = VisibilityConstants { orthographic, ..picture };
            for band in Band::of([10, 200], 10 * 60) {
                let camera = band.camera(picture, 200);
                let rows = band.size(10)[1];
                for row in band.kept.clone() {
                    let (expected, found) =
                        (ray(&picture, row, 200), ray(&camera, row - band.rendered.start, rows));
                    assert!(off(expected, found) < 1e-6, "{row}: {found:?}, not {expected:?}");
                }
            }
            // The twin: of another row
            assert!(off(ray(&picture, 3, 200), ray(&picture, 4, 200)) > 1e-3);
        }
    }
}
