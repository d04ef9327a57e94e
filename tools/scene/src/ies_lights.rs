//! `EXT_lights_ies`: luminaires by their LM-63 files. A point there, here as large as the file says.

use crate::area_lights::{LUMENS_PER_WATT, Placing};
use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::IES_LIGHTS;
use crate::messages::Messages;
use crate::node_lights;
use crate::nodes::PlacedNode;
use crate::shaping::{LEVELS, Said};
use arealight::{IesProfile, Light, LightShape, Profile};
use glam::Vec3;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::f64::consts::PI;

#[derive(Deserialize, Clone)]
#[serde(rename_all = "camelCase")]
struct IesLight {
    name: Option<String>,
    uri: Option<String>,
    buffer_view: Option<usize>,
    #[serde(default)]
    extras: Value,
}

/// What a node says of its luminaire.
#[derive(Deserialize)]
#[serde(default)]
struct Instance {
    multiplier: f64,
    color: [f32; 3],
}

impl Default for Instance {
    fn default() -> Self {
        Self { multiplier: 1.0, color: [1.0; 3] }
    }
}

/// A file as a flat light has it.
#[derive(Clone)]
struct Luminaire {
    file: IesProfile,
    profile: Profile,
    /// Luminance times area, candela.
    candela: f64,
}

/// The luminaires of the nodes; `size` is the radius of those whose file says none, in metres.
pub(crate) fn lights(
    document: &Document,
    nodes: &[PlacedNode],
    size: Option<f64>,
    messages: &mut Messages,
) -> Result<Vec<Light>, SceneError> {
    let said = node_lights::referenced(document, IES_LIGHTS, nodes, |node| node.ies_light.as_ref())?;
    let mut files: BTreeMap<usize, Result<Luminaire, String>> = BTreeMap::new();
    let mut lights = Vec::new();
    for (node, place, light) in said {
        let light: &IesLight = &light;
        let name = node_lights::name(node, light.name.as_ref(), "luminaire", place);
        if let Entry::Vacant(unread) = files.entry(place) {
            let field = format!("extensions.{IES_LIGHTS}.lights[{place}]");
            let read = luminaire(&text(document, light, &field)?);
            if let Ok(read) = &read {
                warn_of_upward_light(&read.file, &name, messages);
            }
            unread.insert(read.map_err(|problem| format!("{field}: {problem}")));
        }
        let made = files[&place].as_ref().map_err(Clone::clone);
        let made = made.and_then(|file| make(file, node, size, &name));
        let shaped = made.and_then(|made| Said::of_light(&light.extras)?.shape(made, node));
        match shaped {
            Ok(behind) => lights.extend(behind),
            Err(problem) => messages.warn(format!("light '{name}'"), format!("{problem}: left out")),
        }
    }
    Ok(lights)
}

/// The text of a file, wherever it is; bytes that are no UTF-8 are in no number of it.
fn text(document: &Document, light: &IesLight, field: &str) -> Result<String, SceneError> {
    let bytes = match (light.buffer_view, &light.uri) {
        (Some(view), _) => document.view(view)?.0.to_vec(),
        (None, Some(uri)) => document.resource(field, uri)?,
        (None, None) => return Err(document.invalid(field, "has neither uri nor bufferView")),
    };
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn luminaire(text: &str) -> Result<Luminaire, String> {
    let file = IesProfile::parse(text).map_err(|error| error.to_string())?;
    let (profile, candela) = file.profile(LEVELS).map_err(|fault| fault.to_string())?;
    Ok(Luminaire { file, profile, candela })
}

fn warn_of_upward_light(file: &IesProfile, name: &str, messages: &mut Messages) {
    let [down, up] = file.lumens();
    let percent = 100.0 * up / (down + up).max(1e-300);
    if percent > 1.0 {
        let text = format!("{percent:.0} % of its lumens go up: a flat light sends none there");
        messages.warn(format!("light '{name}'"), text);
    }
}

/// A luminaire's light, or why there is none. It shines along -Z; azimuth 0 is +X.
fn make(of: &Luminaire, node: &PlacedNode, size: Option<f64>, name: &str) -> Result<Light, String> {
    let said = node.ies_light.as_ref().map(Instance::deserialize).transpose();
    let Instance { multiplier, color } = said.map_err(|error| error.to_string())?.unwrap_or_default();
    if !(0.0..1e30).contains(&multiplier) {
        return Err(format!("multiplier: {multiplier}"));
    }
    let Placing { right, front, .. } = Placing::new(node)?;
    let (center, [width, length, _]) = (node.world.translation, of.file.opening);
    // Not the node's scale: the light's power doesn't follow that
    let (shape, area) = match (of.file.is_round_opening, width > 0.0 && length > 0.0, size) {
        (false, true, _) => {
            let (u, v) = (0.5 * length * right, 0.5 * width * right.cross(front));
            let vertices = vec![center - u + v, center + u + v, center + u - v, center - u - v];
            (LightShape::Polygon(vertices), width * length)
        }
        (true, _, _) | (_, _, Some(_)) => {
            // Length along azimuth 0; a circle may say its width alone
            let across = if width > 0.0 { 0.5 * width } else { size.unwrap_or_default() };
            let (u, v) = (if length > 0.0 { 0.5 * length } else { across }, across);
            let (axis_u, axis_v) = (u * right, v * front.cross(right));
            (LightShape::Disk { center, axis_u, axis_v }, PI * u * v)
        }
        _ => return Err("its file has no size (--light-size gives it one)".into()),
    };
    let radiance = Vec3::from_array(color) * (multiplier * of.candela / (LUMENS_PER_WATT * area)) as f32;
    let profile = Some(of.profile.clone());
    Ok(Light { name: name.to_owned(), radiance, shape, profile, ..Light::default() })
}
