//! Families of poses of a textured light, and how far off a footprint may be on them: what tests and
//! `arealight bench textures` judge by.

use crate::material::Surface;
use crate::polygon::transformed_form_factor;
use crate::stream::Stream;
use arealight::{Footprint, Light, LightShape, LightTable, LightTexture};
use glam::{DMat3, DVec2, DVec3, Vec3};
use serde::Serialize;

/// Where a family's lights and lobes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Family {
    /// About the mirror direction, roughness from .05 to .2.
    Sharp,
    /// The same, roughness from .2 to 1.
    Rough,
    /// Through the surface's plane, roughness from .05 to 1.
    Horizon,
    /// Anywhere above a Lambert surface.
    Diffuse,
}

impl Family {
    /// Every family.
    pub const ALL: [Self; 4] = [Self::Sharp, Self::Rough, Self::Horizon, Self::Diffuse];

    /// What it is, in a few words.
    pub fn description(self) -> &'static str {
        match self {
            Self::Sharp => "mirrored, roughness to .2",
            Self::Rough => "mirrored, rougher",
            Self::Horizon => "through the horizon",
            Self::Diffuse => "diffuse",
        }
    }
}

/// A textured rectangle, and a surface at the origin, in the surface frame: the normal is z.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    /// Lambert of albedo 1, or GGX of F0 = F90 = 1: one lobe and no Fresnel term.
    pub surface: Surface,
    /// To the viewer, of unit length, with y = 0.
    pub view: DVec3,
    /// Seen from the front counter-clockwise; the image's top row runs from the first to the second.
    pub vertices: [DVec3; 4],
}

impl Pose {
    /// M⁻¹ of the surface's one lobe, and what that reflects of a white sky, by the table.
    pub fn lobe(&self, table: &LightTable) -> (DMat3, f64) {
        if self.surface.f0 == DVec3::ZERO {
            return (DMat3::IDENTITY, 1.0);
        }
        let lobe = table.lookup(self.surface.alpha.sqrt(), self.view.z);
        (lobe.inverse, lobe.albedo)
    }

    /// How many times as wide as high the light is.
    pub fn aspect(&self) -> f64 {
        let [a, b, _, d] = self.vertices;
        a.distance(b) / a.distance(d)
    }

    /// The light, of radiance 1, with the whole of a layer.
    pub fn light(&self, layer: u32) -> Light {
        let uvs = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        Light {
            shape: LightShape::Polygon(self.vertices.to_vec()),
            radiance: Vec3::ONE,
            texture: Some(LightTexture { layer, uvs }),
            ..Light::default()
        }
    }
}

/// `count` poses in which the lobe sees the light's front well enough for an error to be seen: a thousandth
/// of its energy. Another seed gives others.
pub fn poses(family: Family, count: usize, seed: u64, table: &LightTable) -> Vec<Pose> {
    let mut random = Stream::from_seed((seed << 8) + family as u64 + 1);
    let mut poses = Vec::with_capacity(count);
    while poses.len() < count {
        let pose = pose(&mut random, family);
        let above = pose.vertices.iter().all(|vertex| vertex.z > 0.0);
        if above != (family == Family::Horizon)
            && transformed_form_factor(&pose.lobe(table).0, &pose.vertices) > 1e-3
        {
            poses.push(pose);
        }
    }
    poses
}

fn pose(random: &mut Stream, family: Family) -> Pose {
    let theta = random.between(0.0, 85.0_f64.to_radians());
    let roughness = match family {
        Family::Sharp => random.between(0.05, 0.2),
        Family::Rough => random.between(0.2, 1.0),
        Family::Horizon | Family::Diffuse => random.between(0.05, 1.0),
    };
    let alpha = roughness * roughness;
    let surface = if family == Family::Diffuse {
        Surface { diffuse_albedo: DVec3::ONE, f0: DVec3::ZERO, f90: 0.0, alpha, ..Surface::default() }
    } else {
        Surface { diffuse_albedo: DVec3::ZERO, f0: DVec3::ONE, f90: 1.0, alpha, ..Surface::default() }
    };
    // As large as screens are, as far as they are
    let width = random.between(0.3_f64.ln(), 2.0_f64.ln()).exp();
    let height = width * random.between(0.4, 1.0);
    let distance = random.between(0.4, 2.5);
    let mirror = DVec3::new(-theta.sin(), 0.0, theta.cos());
    let center = match family {
        Family::Sharp | Family::Rough => {
            let aside = direction(random) * (0.5 * width * random.unit());
            mirror * distance + aside
        }
        Family::Horizon => {
            let phi = random.between(0.5, 1.5) * std::f64::consts::PI;
            DVec3::new(phi.cos(), phi.sin(), 0.0) * distance
                + DVec3::Z * (0.25 * height * random.between(-1.0, 1.0))
        }
        Family::Diffuse => {
            let direction = direction(random);
            direction.with_z(direction.z.abs()) * distance
        }
    };
    let normal =
        (-center.normalize_or(DVec3::Z) + 0.9 * direction(random) * random.unit()).normalize_or(DVec3::Z);
    let tangent = normal.cross(direction(random)).normalize_or(normal.any_orthonormal_vector());
    let (u, v) = (tangent * (0.5 * width), normal.cross(tangent) * (0.5 * height));
    Pose {
        surface,
        view: mirror.with_x(-mirror.x),
        vertices: [center - u - v, center + u - v, center + u + v, center - u + v],
    }
}

/// A unit vector, uniform on the sphere.
fn direction(random: &mut Stream) -> DVec3 {
    let (z, phi) = (random.between(-1.0, 1.0), random.between(0.0, std::f64::consts::TAU));
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// The errors of one filter over poses and pictures.
#[derive(Debug, Clone, Default)]
pub struct Errors {
    squares: f64,
    found: f64,
    expected: f64,
    relative: Vec<f64>,
}

/// Errors in percent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    /// The root of the mean square, over the mean.
    pub rmse: f64,
    /// The median of the largest channel's error over the brightest.
    pub median: f64,
    /// How much too bright on average.
    pub bias: f64,
}

impl Errors {
    /// Adds an answer and the truth.
    pub fn add(&mut self, found: DVec3, expected: DVec3) {
        self.squares += (found - expected).length_squared() / 3.0;
        self.found += found.element_sum() / 3.0;
        self.expected += expected.element_sum() / 3.0;
        self.relative.push((found - expected).abs().max_element() / expected.max_element());
    }

    /// NaN where an answer was or nothing was added.
    pub fn summary(&self) -> Summary {
        let mut sorted = self.relative.clone();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len() as f64;
        Summary {
            rmse: 100.0 * (self.squares / count).sqrt() / (self.expected / count),
            median: 100.0 * sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN),
            bias: 100.0 * (self.found / self.expected - 1.0),
        }
    }
}

/// The largest errors that are allowed, in percent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bar {
    /// Of [`Summary::rmse`].
    pub rmse: f64,
    /// Of [`Summary::median`].
    pub median: f64,
}

impl Bar {
    /// Whether errors are within the bar; NaN is not.
    pub fn holds(&self, found: &Summary) -> bool {
        found.rmse <= self.rmse && found.median <= self.median
    }

    /// That of the kernel on a family, with pictures such as [`crate::texture::Texture::checker`], `gradient`
    /// and `noise`. At the horizon few poses before mirrors decide the first. There is none for a yardstick.
    pub fn of(footprint: Footprint, family: Family) -> Option<Self> {
        let (rmse, median) = match (footprint, family) {
            (Footprint::Mips, _) => return None,
            (Footprint::Kernel, Family::Horizon) => (45.0, 2.5),
            (Footprint::Kernel, Family::Sharp) => (7.5, 2.5),
            (Footprint::Kernel, Family::Rough) => (4.0, 1.0),
            (Footprint::Kernel, Family::Diffuse) => (2.5, 1.0),
        };
        Some(Self { rmse, median })
    }
}
