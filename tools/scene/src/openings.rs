//! What lights are seen through: `extras.arealight` of a light, or of the node of an emissive mesh, has
//! `doors`, a `grid` or an `opening`.

use crate::nodes::PlacedNode;
use arealight::{Light, Opening};
use glam::DVec3;
use serde::Deserialize;
use serde_json::Value;

/// Doors at the four sides, of a length in the node's units and opened by an angle in radians.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Doors {
    length: f64,
    angle: f64,
}

/// Cells before a rectangle, of a depth in the node's units.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Grid {
    columns: u32,
    rows: u32,
    depth: f64,
}

/// A parallelogram in the node's space: its middle and half axes.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Window {
    center: [f64; 3],
    axis_u: [f64; 3],
    axis_v: [f64; 3],
    #[serde(default)]
    housed: bool,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Said {
    doors: Option<Doors>,
    grid: Option<Grid>,
    opening: Option<Window>,
}

/// Whether `extras.arealight` says any of these.
pub(crate) fn is_said(extras: &Value) -> bool {
    ["doors", "grid", "opening"].iter().any(|key| extras.get(key).is_some())
}

/// A node's light as it is seen: behind what `extras.arealight` says, checked; of a grid a light a cell.
pub(crate) fn behind(light: Light, extras: &Value, node: &PlacedNode) -> Result<Vec<Light>, String> {
    let light = Light { links: node.links, ..light };
    let said = if is_said(extras) {
        Said::deserialize(extras).map_err(|error| format!("extras.arealight: {error}"))?
    } else {
        Said::default()
    };
    // Of a length of the node's along the light's front
    let front = light.shape.area_vector().normalize_or(DVec3::Z);
    let scale = (node.world.matrix3.inverse() * front).length().recip();
    let made = match said {
        Said { doors: None, grid: None, opening: None } => Ok(vec![light]),
        Said { doors: Some(doors), grid: None, opening: None } => {
            let opening = Opening::doors(&light.shape, doors.length * scale, doors.angle);
            opening.map(|opening| vec![Light { opening: Some(opening), ..light }])
        }
        Said { doors: None, grid: Some(grid), opening: None } => {
            light.behind_grid(grid.columns, grid.rows, grid.depth * scale)
        }
        Said { doors: None, grid: None, opening: Some(window) } => {
            let [center, axis_u, axis_v] =
                [window.center, window.axis_u, window.axis_v].map(DVec3::from_array);
            let opening = Opening { center, axis_u, axis_v, housed: window.housed };
            Ok(vec![Light { opening: Some(opening.moved(&node.world)), ..light }])
        }
        _ => return Err("extras.arealight: one of doors, grid and opening, not several".into()),
    };
    let lights = made.map_err(|fault| fault.to_string())?;
    lights.iter().try_for_each(Light::validate).map_err(|fault| fault.to_string())?;
    Ok(lights)
}
