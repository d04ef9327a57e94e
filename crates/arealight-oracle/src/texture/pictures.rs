//! Pictures to test with, each hard in its own way.

use super::Texture;
use crate::stream::Stream;
use glam::DVec3;
use std::f64::consts::TAU;

impl Texture {
    /// A texture of what `value` says of each column and row. Numbers of texels below one are raised to it.
    pub fn from_fn(width: usize, height: usize, value: impl Fn(usize, usize) -> DVec3) -> Self {
        let (width, height) = (width.max(1), height.max(1));
        let texels = (0..width * height).map(|i| value(i % width, i / width)).collect();
        Self { width, height, texels }
    }

    /// A board of `fields` × `fields` fields, nearly black and white with a tinge of colour: hard edges, and
    /// as much contrast in every direction.
    pub fn checker(width: usize, height: usize, fields: usize) -> Self {
        Self::from_fn(width, height, |column, row| {
            let field = column * fields / width + row * fields / height;
            if field.is_multiple_of(2) { DVec3::new(1.0, 0.95, 0.9) } else { DVec3::new(0.02, 0.03, 0.05) }
        })
    }

    /// Red rises to the right, green downwards, blue falls along the diagonal: where a blur is displaced it
    /// shows.
    pub fn gradient(width: usize, height: usize) -> Self {
        Self::from_fn(width, height, |column, row| {
            let (u, v) = ((column as f64 + 0.5) / width as f64, (row as f64 + 0.5) / height as f64);
            DVec3::new(u, v, 1.0 - 0.5 * (u + v))
        })
    }

    /// Noise whose amplitude falls as one over the frequency, as that of photographs does; mean one half, at
    /// least 0. The same seed gives the same picture everywhere.
    pub fn noise(width: usize, height: usize, seed: u64) -> Self {
        // A sum of waves whose frequencies are spread evenly over the octaves has that spectrum
        const WAVES: usize = 192;
        let mut stream = Stream::from_seed(seed);
        let mut random = || stream.unit();
        let highest = (width.min(height) as f64 / 3.0).max(1.0);
        let waves: Vec<_> = (0..WAVES)
            .map(|i| {
                let frequency = highest.powf((i as f64 + random()) / WAVES as f64);
                let (sin, cos) = (TAU * random()).sin_cos();
                // Channels are alike, but not the same
                let phase = random();
                let phases = [phase, phase + 0.15 * random(), phase + 0.3 * random()];
                ([frequency * cos, frequency * sin], phases)
            })
            .collect();
        let amplitude = 0.42 / (WAVES as f64).sqrt();
        Self::from_fn(width, height, |column, row| {
            let (u, v) = ((column as f64 + 0.5) / width as f64, (row as f64 + 0.5) / height as f64);
            let mut sum = [0.5; 3];
            for ([across, down], phases) in &waves {
                for channel in 0..3 {
                    sum[channel] += amplitude * (TAU * (across * u + down * v + phases[channel])).sin();
                }
            }
            DVec3::from_array(sum).max(DVec3::ZERO)
        })
    }

    /// A bright disk, a twentieth of the picture across and off its middle, on a faint ground: what is
    /// hardest, for a lobe that looks beside it sees nothing, and one that looks at it everything.
    pub fn spot(width: usize, height: usize) -> Self {
        Self::from_fn(width, height, |column, row| {
            let (u, v) = ((column as f64 + 0.5) / width as f64, (row as f64 + 0.5) / height as f64);
            let inside = (u - 0.37).hypot(v - 0.58) < 0.025;
            if inside { DVec3::new(100.0, 80.0, 60.0) } else { DVec3::splat(0.05) }
        })
    }

    /// A bright frame, a sixteenth of the picture wide, around a dark middle: who sees too much of the edge
    /// is far too bright.
    pub fn framed(width: usize, height: usize) -> Self {
        Self::from_fn(width, height, |column, row| {
            let near_edge = |index: usize, count: usize| 16 * index.min(count - 1 - index) < count;
            let bright = near_edge(column, width) || near_edge(row, height);
            if bright { DVec3::new(1.0, 0.9, 0.8) } else { DVec3::splat(0.02) }
        })
    }
}
