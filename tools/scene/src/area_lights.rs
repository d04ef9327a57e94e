//! `EXT_lights_area`: rectangles and disks that hang on nodes and have no visible geometry.

use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::AREA_LIGHTS;
use crate::messages::Messages;
use crate::node_lights;
use crate::nodes::PlacedNode;
use crate::shaping::Said;
use arealight::{Light, LightShape};
use glam::{DVec3, Vec3};
use serde::Deserialize;
use serde_json::{Map, Value};

/// Luminous efficacy of 555 nm light, lm/W: `EXT_lights_area` gives luminance in cd/m², and radiance is that
/// divided by this. A light of 683 nits has a radiance of 1.
pub const LUMENS_PER_WATT: f64 = 683.0;

#[derive(Deserialize, Clone)]
struct AreaLight {
    name: Option<String>,
    #[serde(rename = "type", default = "rectangle")]
    shape: String,
    #[serde(default = "white")]
    color: [f32; 3],
    #[serde(default = "thousand")]
    intensity: f64,
    #[serde(default = "one")]
    size: f64,
    #[serde(default)]
    rect: Rectangle,
    #[serde(default)]
    extras: Value,
    #[serde(default, rename = "extensions")]
    _extensions: Value,
    /// What the extension does not have, such as fields of its drafts.
    #[serde(flatten)]
    others: Map<String, Value>,
}

#[derive(Deserialize, Clone)]
struct Rectangle {
    #[serde(default = "one")]
    aspect: f64,
}

impl Default for Rectangle {
    fn default() -> Self {
        Self { aspect: 1.0 }
    }
}

fn rectangle() -> String {
    "rect".into()
}

pub(crate) fn white() -> [f32; 3] {
    [1.0; 3]
}

fn thousand() -> f64 {
    1000.0
}

pub(crate) fn one() -> f64 {
    1.0
}

/// The area lights of the nodes.
pub(crate) fn lights(
    document: &Document,
    nodes: &[PlacedNode],
    messages: &mut Messages,
) -> Result<Vec<Light>, SceneError> {
    let said = node_lights::referenced(document, AREA_LIGHTS, nodes, |node| node.area_light.as_ref())?;
    let mut lights = Vec::new();
    for (node, place, light) in said {
        let light: &AreaLight = &light;
        let name = node_lights::name(node, light.name.as_ref(), "area light", place);
        let shape = Said::of_light(&light.extras).and_then(|said| {
            let shape = match light.shape.as_str() {
                "rect" => polygon(light, node),
                "disk" => disk(light, node, said.aspect.unwrap_or(1.0)),
                other => Err(format!("type '{other}' is not known")),
            };
            Ok((shape?, said))
        });
        let radiance = radiance(light);
        for field in light.others.keys() {
            let text = format!("{field} is no field of {AREA_LIGHTS}: left out");
            messages.warn(format!("light '{name}'"), text);
        }
        let light = |shape| Light { name: name.clone(), radiance, shape, ..Light::default() };
        match shape.and_then(|(shape, said)| said.shape(light(shape), node)) {
            Ok(behind) => lights.extend(behind),
            Err(problem) => messages.warn(format!("light '{name}'"), format!("{problem}: left out")),
        }
    }
    Ok(lights)
}

/// A node's scale as the extension has it, with unit vectors to the light's right, up and front:
/// right-angled, also under shear.
pub(crate) struct Placing {
    scale: f64,
    pub right: DVec3,
    up: DVec3,
    pub front: DVec3,
}

impl Placing {
    pub fn new(node: &PlacedNode) -> Result<Self, String> {
        // The scale is the largest of the node's three, without a sign
        let [x, y, z] = [node.world.matrix3.x_axis, node.world.matrix3.y_axis, node.world.matrix3.z_axis];
        let scale = x.length().max(y.length()).max(z.length());
        // It emits along -Z
        let front = (-z).normalize_or_zero();
        let right = (x - front * x.dot(front)).normalize_or_zero();
        // In a mirror, where the image of azimuth 180 degrees is
        let right = if node.world.matrix3.determinant() < 0.0 { -right } else { right };
        let up = front.cross(right) * if front.cross(right).dot(y) < 0.0 { -1.0 } else { 1.0 };
        if front == DVec3::ZERO || right == DVec3::ZERO {
            return Err("its node's scale is zero".into());
        }
        Ok(Self { scale, right, up, front })
    }
}

fn radiance(light: &AreaLight) -> Vec3 {
    Vec3::from_array(light.color) * (light.intensity / LUMENS_PER_WATT) as f32
}

/// The light's rectangle in the world, or why there is none.
fn polygon(light: &AreaLight, node: &PlacedNode) -> Result<LightShape, String> {
    let Placing { scale, right, up, front } = Placing::new(node)?;
    let [half_width, half_height] =
        [scale * light.size * light.rect.aspect, scale * light.size].map(|s| s * 0.5);
    if ![half_width, half_height].iter().all(|half| *half > 0.0 && half.is_finite()) {
        return Err(format!("a rectangle of {} by {}", 2.0 * half_width, 2.0 * half_height));
    }
    let center = node.world.translation;
    let corner = |u: f64, v: f64| center + right * (u * half_width) + up * (v * half_height);
    // The first edge goes to the right: a profile's azimuth begins there
    let mut vertices = vec![corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)];
    if up.cross(right).dot(front) < 0.0 {
        vertices.reverse();
    }
    Ok(LightShape::Polygon(vertices))
}

/// The light's disk in the world, an ellipse where the file says so, or why there is none.
fn disk(light: &AreaLight, node: &PlacedNode, aspect: f64) -> Result<LightShape, String> {
    let Placing { scale, right, front, .. } = Placing::new(node)?;
    let [half_width, half_height] = [scale * light.size * aspect, scale * light.size].map(|s| s * 0.5);
    if ![half_width, half_height].iter().all(|half| *half > 0.0 && half.is_finite()) {
        return Err(format!("a disk of the diameters {} and {}", 2.0 * half_width, 2.0 * half_height));
    }
    let (axis_u, axis_v) = (right * half_width, front.cross(right) * half_height);
    Ok(LightShape::Disk { center: node.world.translation, axis_u, axis_v })
}
