//! Clusters as a host has them: parts of a view by columns, rows and slices of depth, each with the lights
//! that reach into it.

use arealight::{Light, reach};
use arealight_scene::Camera;
use glam::DVec3;

/// How a view is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid {
    /// Columns and rows of the picture, and slices of depth, each as much deeper than wide.
    pub counts: [u32; 3],
    /// The picture in pixels.
    pub size: [u32; 2],
}

/// The lists of a view.
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    grid: Grid,
    /// Unit, the view's direction.
    forward: DVec3,
    /// Where the first slice begins and the last one ends, along the view.
    depths: [f64; 2],
    /// Where each cluster's lights are in `lights`, and the end.
    starts: Vec<u32>,
    lights: Vec<u32>,
}

/// A part of depth by which the cells of the CPU reach farther than those of the GPU, which rounds to
/// float32.
const MARGIN: f64 = 1e-4;

impl Clusters {
    // doc: fill
    /// Lists the lights that may reflect more than `threshold`, in W/(m² sr), somewhere in a cluster, by
    /// their places in `lights`. `density` is of the surfaces: [`reach::radius`]. `depths` are along the
    /// view.
    pub fn fill(
        lights: &[Light],
        camera: &Camera,
        grid: Grid,
        depths: [f64; 2],
        (threshold, density): (f64, f64),
    ) -> Self {
        // How far each light reaches: a sphere about its middle, and a box
        let reaches: Vec<_> = lights
            .iter()
            .map(|light| {
                let radius = reach::radius(light, threshold, density);
                (light.shape.center(), radius, reach::bounds(light, radius))
            })
            .collect();
        let (mut starts, mut listed) = (vec![0], vec![]);
        for [low, high] in grid.cells(camera, depths) {
            let reached = reaches.iter().enumerate().filter(|(_, (center, radius, [from, to]))| {
                let nearest = center.clamp(low, high);
                from.cmple(high).all()
                    && to.cmpge(low).all()
                    && nearest.distance_squared(*center) <= radius * radius
            });
            listed.extend(reached.map(|(light, _)| light as u32));
            starts.push(listed.len() as u32);
        }
        Self { grid, forward: camera.forward, depths, starts, lights: listed }
    }
    // doc end

    /// The buffer that the shader reads, where `record_of` says which record each light became.
    pub fn words(&self, record_of: &[u32]) -> Vec<u32> {
        let [near, far] = self.depths;
        let [x, y, z] = self.grid.counts;
        let float = |value: f64| (value as f32).to_bits();
        let [forward_x, forward_y, forward_z] = self.forward.to_array().map(float);
        let scale = f64::from(z) / (far / near).ln();
        let mut words = vec![x, y, z, float(near), float(scale), forward_x, forward_y, forward_z];
        let first = words.len() as u32 + 2 * (self.starts.len() as u32 - 1);
        for ends in self.starts.windows(2) {
            words.extend([first + ends[0], ends[1] - ends[0]]);
        }
        words.extend(self.lights.iter().map(|light| record_of[*light as usize]));
        words
    }

    /// The lights of the cluster that a position is in, seen in a pixel by a camera.
    pub fn at(&self, camera: &Camera, pixel: [u32; 2], position: DVec3) -> &[u32] {
        let [near, far] = self.depths;
        let [x, y, z] = self.grid.counts;
        let depth = (position - camera.position).dot(self.forward);
        let slice =
            ((depth / near).ln() / (far / near).ln() * f64::from(z)).clamp(0.0, f64::from(z - 1)) as u32;
        let [column, row] =
            [0, 1].map(|axis: usize| pixel[axis] * self.grid.counts[axis] / self.grid.size[axis]);
        let cluster = ((slice * y + row) * x + column) as usize;
        &self.lights[self.starts[cluster] as usize..self.starts[cluster + 1] as usize]
    }

    /// How many lights the lists have in all.
    pub fn listed(&self) -> usize {
        self.lights.len()
    }
}

impl Grid {
    /// Boxes along the axes about the clusters, a slice after the other, row by row from the top.
    fn cells(self, camera: &Camera, [near, far]: [f64; 2]) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let [columns, rows, slices] = self.counts;
        let [width, height] = self.size.map(f64::from);
        let tan = [camera.half_height * width / height, camera.half_height];
        // Pixels belong to a cell by their corner, and are seen through their middle
        let side = move |index: u32, count: u32, pixels: f64| {
            let [from, to] = [index, index + 1].map(|edge| f64::from(edge) / f64::from(count));
            [2.0 * from - 1.0, 2.0 * (to + 1.0 / pixels) - 1.0]
        };
        let depth = move |slice: u32| near * (far / near).powf(f64::from(slice) / f64::from(slices));
        let cell = move |slice: u32, row: u32, column: u32| {
            let depths = [depth(slice) * (1.0 - MARGIN), depth(slice + 1) * (1.0 + MARGIN)];
            let (across, down) = (side(column, columns, width), side(row, rows, height));
            let corners = (0..8).map(|corner: usize| {
                let pick = |pair: [f64; 2], bit: usize| pair[corner >> bit & 1];
                let plane = camera.forward + camera.right * (pick(across, 0) * tan[0])
                    - camera.up * (pick(down, 1) * tan[1]);
                camera.position + plane * pick(depths, 2)
            });
            corners
                .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
        };
        (0..slices).flat_map(move |slice| {
            (0..rows).flat_map(move |row| (0..columns).map(move |column| cell(slice, row, column)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiles::lamps;
    use arealight_scene::Bounds;

    #[test]
    fn a_position_s_cluster_has_each_light_that_reaches_it() {
        let lights = lamps(100, 40.0, DVec3::ZERO);
        let bounds = Bounds { min: DVec3::new(-20.0, 0.0, -20.0), max: DVec3::new(20.0, 0.0, 20.0) };
        let camera = Camera::framing("c", bounds, DVec3::new(0.2, -1.0, -1.0), DVec3::Y, 1.6);
        let grid = Grid { counts: [7, 5, 6], size: [64, 40] };
        let (threshold, density) = (0.02, 0.4);
        let clusters = Clusters::fill(&lights, &camera, grid, [1.0, 200.0], (threshold, density));
        let (mut inside, mut outside) = (0, 0);
        for pixel in (0..40).flat_map(|y| (0..64).map(move |x| [x, y])) {
            // Where its ray meets the floor
            let at = [0, 1].map(|axis: usize| (f64::from(pixel[axis]) + 0.5) / f64::from(grid.size[axis]));
            let [start, direction] = camera.ray([2.0 * at[0] - 1.0, 1.0 - 2.0 * at[1]], 1.6);
            let position = start - direction * (start.y / direction.y);
            if direction.y >= 0.0 || position.abs().max_element() > 20.0 {
                continue;
            }
            let listed = clusters.at(&camera, pixel, position);
            for (index, light) in lights.iter().enumerate() {
                let radius = reach::radius(light, threshold, density);
                let [low, high] = reach::bounds(light, radius);
                let reached = position.distance(light.shape.center()) <= radius
                    && position.cmpge(low).all()
                    && position.cmple(high).all();
                assert!(!reached || listed.contains(&(index as u32)), "{pixel:?} {position} {index}");
                inside += usize::from(reached);
                outside += usize::from(!listed.contains(&(index as u32)));
            }
        }
        // Neither is for want of lights
        assert!(inside > 1000 && outside > 10_000, "{inside} {outside}");
    }

    #[test]
    fn words_say_where_each_list_is() {
        let lights = lamps(4, 4.0, DVec3::ZERO);
        let bounds = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(2.0) };
        let camera = Camera::framing("c", bounds, DVec3::NEG_Z, DVec3::Y, 1.0);
        let grid = Grid { counts: [2, 2, 2], size: [8, 8] };
        let clusters = Clusters::fill(&lights, &camera, grid, [1.0, 20.0], (1e-9, 1.0));
        // Every light reaches everywhere
        assert_eq!(clusters.listed(), 4 * 8);
        let words = clusters.words(&[10, 11, 12, 13]);
        assert_eq!(words[..3], [2, 2, 2]);
        for cluster in 0..8 {
            let [first, count] = [words[8 + 2 * cluster], words[9 + 2 * cluster]].map(|word| word as usize);
            assert_eq!(words[first..first + count], [10, 11, 12, 13]);
        }
        assert_eq!(words.len(), 8 + 16 + 32);
    }
}
