//! What `extras.arealight` of a light, or of the node of an emissive mesh, says of it: its size, its profile,
//! and what it is seen through.

use crate::nodes::PlacedNode;
use arealight::{Light, Opening, Profile};
use glam::DVec3;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// Levels of the profiles of a scene's lights.
pub(crate) const LEVELS: u32 = 8;

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
    #[serde(deserialize_with = "whole")]
    columns: u32,
    #[serde(deserialize_with = "whole")]
    rows: u32,
    depth: f64,
}

/// Some writers know no whole numbers.
fn whole<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    let number = f64::deserialize(from)?;
    let is_whole = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number);
    is_whole.then_some(number as u32).ok_or_else(|| D::Error::custom(format!("{number} is no whole number")))
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
#[serde(default, deny_unknown_fields)]
pub(crate) struct Said {
    /// Of a punctual light, in metres.
    pub radius: Option<f64>,
    /// A disk's width over its height: `EXT_lights_area` has no ellipses.
    pub aspect: Option<f64>,
    /// As Blender has it, in radians.
    spread: Option<f64>,
    /// Rows of degrees and factors.
    profile: Option<Vec<Vec<f64>>>,
    doors: Option<Doors>,
    grid: Option<Grid>,
    opening: Option<Window>,
}

impl Said {
    /// Whether a node's `extras.arealight` is of these, not a shape.
    pub fn is_said(said: &Value) -> bool {
        ["spread", "profile", "doors", "grid", "opening"].iter().any(|key| said.get(key).is_some())
    }

    /// By the `extras` of a light, which are whatever a file likes.
    pub fn of_light(extras: &Value) -> Result<Self, String> {
        extras.get("arealight").filter(|said| said.is_object()).map_or(Ok(Self::default()), Self::new)
    }

    /// By `extras.arealight`.
    pub fn new(said: &Value) -> Result<Self, String> {
        Self::deserialize(said).map_err(|error| format!("extras.arealight: {error}"))
    }

    /// A node's light as it is seen, checked; of a grid a light a cell.
    pub fn shape(self, light: Light, node: &PlacedNode) -> Result<Vec<Light>, String> {
        let profile = match (self.spread, self.profile) {
            (Some(spread), _) => Some(Profile::spread(spread, LEVELS)),
            (None, rows) => rows.map(|rows| Profile::new(&rows, LEVELS)),
        };
        let mut profile = profile.transpose().map_err(|fault| fault.to_string())?.or(light.profile);
        if node.world.matrix3.determinant() < 0.0 {
            profile = profile.as_ref().map(Profile::mirrored);
        }
        let light = Light { links: node.links, profile, ..light };
        // Of a length of the node's along the light's front
        let front = light.shape.area_vector().normalize_or(DVec3::Z);
        let scale = (node.world.matrix3.inverse() * front).length().recip();
        let made = match (self.doors, self.grid, self.opening) {
            (None, None, None) => Ok(vec![light]),
            (Some(doors), None, None) => {
                let opening = Opening::doors(&light.shape, doors.length * scale, doors.angle);
                opening.map(|opening| vec![Light { opening: Some(opening), ..light }])
            }
            (None, Some(grid), None) => light.behind_grid(grid.columns, grid.rows, grid.depth * scale),
            (None, None, Some(window)) => {
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
}
