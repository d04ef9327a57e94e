//! `KHR_lights_punctual`: points, spots and suns, which have no area. Where a size is given they are small
//! spheres and disks of the same intensity.

use crate::area_lights::{LUMENS_PER_WATT, one, white};
use crate::bounds::Bounds;
use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::PUNCTUAL_LIGHTS;
use crate::messages::Messages;
use crate::node_lights;
use crate::nodes::PlacedNode;
use crate::shaping::{LEVELS, Said};
use arealight::{Light, LightShape, Profile};
use glam::{DVec3, Vec3};
use serde::Deserialize;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_4, PI};

#[derive(Deserialize, Clone)]
struct PunctualLight {
    name: Option<String>,
    #[serde(rename = "type")]
    kind: String,
    #[serde(default = "white")]
    color: [f32; 3],
    /// Candela, or lux of a directional light.
    #[serde(default = "one")]
    intensity: f64,
    #[serde(default)]
    spot: Spot,
    #[serde(default)]
    extras: Value,
}

/// A spot's angles from its axis, in radians.
#[derive(Deserialize, Clone)]
#[serde(default, rename_all = "camelCase")]
struct Spot {
    inner_cone_angle: f64,
    outer_cone_angle: f64,
}

impl Default for Spot {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: FRAC_PI_4 }
    }
}

/// The sun's angular radius, in radians: half of 0.533 degrees.
const SUN_RADIUS: f64 = 4.65e-3;

/// How far away a sun is, in diagonals of the scene: its direction differs by less than its radius from end
/// to end.
const SUN_DISTANCE: f64 = 1000.0;

/// The punctual lights of the nodes that have a size: that which the light's `extras.arealight.radius` says,
/// else `size`, in metres. Suns shine on what is in `bounds`.
pub(crate) fn lights(
    document: &Document,
    nodes: &[PlacedNode],
    size: Option<f64>,
    bounds: Bounds,
    messages: &mut Messages,
) -> Result<Vec<Light>, SceneError> {
    let said =
        node_lights::referenced(document, PUNCTUAL_LIGHTS, nodes, |node| node.punctual_light.as_ref())?;
    let mut lights = Vec::new();
    for (node, place, light) in said {
        let light: &PunctualLight = &light;
        // A sun's size is its own
        let own = (light.kind == "directional").then_some(SUN_RADIUS);
        let name = node_lights::name(node, light.name.as_ref(), "punctual light", place);
        let made = Said::of_light(&light.extras).and_then(|said| {
            let Some(radius) = said.radius.or(size).or(own) else {
                messages.warn(
                    PUNCTUAL_LIGHTS,
                    "points have no area: lights without a size are left out (--light-size gives them one)",
                );
                return Ok(Vec::new());
            };
            said.shape(make(light, node, radius, bounds, &name, messages)?, node)
        });
        match made {
            Ok(behind) => lights.extend(behind),
            Err(problem) => messages.warn(format!("light '{name}'"), format!("{problem}: left out")),
        }
    }
    Ok(lights)
}

/// The light of a radius, or why there is none.
fn make(
    light: &PunctualLight,
    node: &PlacedNode,
    radius: f64,
    bounds: Bounds,
    name: &str,
    messages: &mut Messages,
) -> Result<Light, String> {
    if radius <= 0.0 || !radius.is_finite() {
        return Err(format!("a radius of {radius} m"));
    }
    // A sphere or a disk of radius r and radiance L has the intensity L pi r^2, towards its front
    let center = node.world.translation;
    let of_intensity = 1.0 / (PI * radius * radius);
    let (shape, brightness) = match light.kind.as_str() {
        "point" => {
            messages.note(PUNCTUAL_LIGHTS, format!("points are spheres with a radius of {radius} m"));
            (LightShape::Sphere { center, radius }, of_intensity)
        }
        "spot" => {
            messages.note(PUNCTUAL_LIGHTS, format!("spots are disks with a radius of {radius} m"));
            (disk(center, front(node)?, radius), of_intensity)
        }
        "directional" => {
            if bounds.is_empty() {
                return Err("a sun over nothing".to_owned());
            }
            messages.note(PUNCTUAL_LIGHTS, "suns are disks of half a degree, far away");
            let (front, distance) = (front(node)?, SUN_DISTANCE * bounds.diagonal().max(1e-3));
            // What arrives at right angles is L pi sin(a)^2
            let sine = SUN_RADIUS.sin();
            (
                disk(bounds.center() - front * distance, front, distance * SUN_RADIUS.tan()),
                1.0 / (PI * sine * sine),
            )
        }
        other => return Err(format!("type '{other}' is not known")),
    };
    let radiance = Vec3::from_array(light.color) * (light.intensity / LUMENS_PER_WATT * brightness) as f32;
    let cone = || Profile::cone(light.spot.inner_cone_angle, light.spot.outer_cone_angle, LEVELS);
    let profile = (light.kind == "spot").then(cone).transpose().map_err(|fault| fault.to_string())?;
    Ok(Light { name: name.to_owned(), radiance, shape, profile, ..Light::default() })
}

/// Where a node's light shines to: along -Z.
fn front(node: &PlacedNode) -> Result<DVec3, String> {
    let front = (-node.world.matrix3.z_axis).normalize_or_zero();
    if front == DVec3::ZERO { Err("its node's scale is zero".to_owned()) } else { Ok(front) }
}

fn disk(center: DVec3, front: DVec3, radius: f64) -> LightShape {
    let axis_u = front.any_orthonormal_vector() * radius;
    LightShape::Disk { center, axis_u, axis_v: front.cross(axis_u) }
}
