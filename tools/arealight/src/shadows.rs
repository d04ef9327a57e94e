//! `--shadows`: what a picture's shadows are made of.

use arealight::plan::{ShadeOptions, ShadowFilter};
use std::fmt;
use std::str::FromStr;

/// How a picture gets shadows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadows {
    /// Not at all: lights shine through objects.
    Off,
    /// By so many rays a pixel.
    Rays(u32, ShadowFilter),
}

impl Shadows {
    /// The default of a picture with so many samples a pixel: four rays a pixel in all, one a sample at
    /// least, filtered.
    pub fn for_samples(samples: u32) -> Self {
        Self::Rays((ShadeOptions::MOST_SHADOW_RAYS / samples.max(1)).max(1), ShadowFilter::Gather)
    }
}

impl fmt::Display for Shadows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Off => f.write_str("off"),
            Self::Rays(count, ShadowFilter::Off) => write!(f, "rays:{count}"),
            Self::Rays(count, ShadowFilter::Gather) => write!(f, "filtered:{count}"),
        }
    }
}

impl FromStr for Shadows {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let most = ShadeOptions::MOST_SHADOW_RAYS;
        let rays = |count: &str, filter| {
            let count = count.parse().ok().filter(|count| (1..=most).contains(count));
            count.map(|count| Self::Rays(count, filter))
        };
        let level = match text.split_once(':') {
            None if text == "off" => Some(Self::Off),
            Some(("rays", count)) => rays(count, ShadowFilter::Off),
            Some(("filtered", count)) => rays(count, ShadowFilter::Gather),
            _ => None,
        };
        level.ok_or_else(|| format!("must be off, rays:N or filtered:N, with N from 1 to {most}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_read_as_they_are_written() {
        for level in [Shadows::Off, Shadows::Rays(2, ShadowFilter::Off), Shadows::for_samples(1)] {
            assert_eq!(level.to_string().parse(), Ok(level));
        }
        let levels = [1, 2, 4, 64].map(|samples| Shadows::for_samples(samples).to_string());
        assert_eq!(levels, ["filtered:4", "filtered:2", "filtered:1", "filtered:1"]);
        for wrong in ["", "on", "rays", "rays:0", "filtered:5", "rays:-1", "soft:2"] {
            assert!(wrong.parse::<Shadows>().is_err(), "{wrong}");
        }
    }
}
