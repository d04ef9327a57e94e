//! `EXT_lights_area`: rectangles that hang on nodes and have no visible geometry.

use crate::SceneError;
use crate::load::Loader;
use crate::nodes::PlacedNode;
use arealight::PolygonLight;
use glam::{DVec3, Vec3};
use serde::Deserialize;

/// Luminous efficacy of 555 nm light, lm/W: `EXT_lights_area` gives luminance in cd/m², and radiance is that
/// divided by this. A light of 683 nits has a radiance of 1.
pub const LUMENS_PER_WATT: f64 = 683.0;

#[derive(Deserialize)]
struct Root {
    #[serde(default)]
    lights: Vec<AreaLight>,
}

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

fn white() -> [f32; 3] {
    [1.0; 3]
}

fn thousand() -> f64 {
    1000.0
}

fn one() -> f64 {
    1.0
}

#[derive(Deserialize)]
struct Reference {
    light: usize,
}

const NAME: &str = "EXT_lights_area";

/// Adds the area lights of the nodes.
pub(crate) fn add(loader: &mut Loader, nodes: &[PlacedNode]) -> Result<(), SceneError> {
    if nodes.iter().all(|node| node.area_light.is_none()) {
        return Ok(());
    }
    let document = &loader.document;
    let root = document.root.extensions.as_ref().and_then(|e| e.others.get(NAME));
    let root = root.cloned().ok_or_else(|| document.invalid(format!("extensions.{NAME}"), "is missing"))?;
    let root = Root::deserialize(root);
    let root = root.map_err(|e| document.invalid(format!("extensions.{NAME}"), e.to_string()))?;
    for node in nodes {
        let Some(reference) = &node.area_light else { continue };
        let field = format!("nodes[{}].extensions.{NAME}", node.index);
        let reference = Reference::deserialize(reference);
        let reference = reference.map_err(|e| loader.document.invalid(&field, e.to_string()))?;
        let light = root.lights.get(reference.light);
        let light = light.ok_or_else(|| {
            let problem = format!("light {} of {}", reference.light, root.lights.len());
            loader.document.invalid(field, problem)
        })?;
        let name = [&node.name, &light.name].into_iter().flatten().find(|name| !name.is_empty());
        let name = name.map_or_else(|| format!("area light {}", reference.light), Clone::clone);
        match polygon(light, node, name.clone()) {
            Ok(polygon) => loader.scene.lights.push(polygon),
            Err(problem) => loader.warn(format!("light '{name}'"), format!("{problem}: left out")),
        }
    }
    Ok(())
}

/// The light's rectangle in the world, or why there is none.
fn polygon(light: &AreaLight, node: &PlacedNode, name: String) -> Result<PolygonLight, String> {
    match light.shape.as_str() {
        "rect" => {}
        "disk" => return Err("disks are not supported yet".into()),
        other => return Err(format!("type '{other}' is not known")),
    }
    // The scale is the largest of the node's three, without a sign
    let [x, y, z] = [node.world.matrix3.x_axis, node.world.matrix3.y_axis, node.world.matrix3.z_axis];
    let scale = x.length().max(y.length()).max(z.length());
    let [half_width, half_height] =
        [scale * light.size * light.rect.aspect, scale * light.size].map(|s| s * 0.5);
    if ![half_width, half_height].iter().all(|half| *half > 0.0 && half.is_finite()) {
        return Err(format!("a rectangle of {} by {}", 2.0 * half_width, 2.0 * half_height));
    }
    // Right-angled axes, also under shear; it emits along -Z
    let front = (-z).normalize_or_zero();
    let right = (x - front * x.dot(front)).normalize_or_zero();
    let up = front.cross(right) * if front.cross(right).dot(y) < 0.0 { -1.0 } else { 1.0 };
    if front == DVec3::ZERO || right == DVec3::ZERO {
        return Err("its node's scale is zero".into());
    }
    let center = node.world.translation;
    let corner = |u: f64, v: f64| center + right * (u * half_width) + up * (v * half_height);
    let mut vertices = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    if up.cross(right).dot(front) < 0.0 {
        vertices.reverse();
    }
    let radiance = Vec3::from_array(light.color) * (light.intensity / LUMENS_PER_WATT) as f32;
    let polygon = PolygonLight { name, vertices, radiance, ..PolygonLight::default() };
    polygon.validate().map_err(|e| e.to_string())?;
    Ok(polygon)
}
