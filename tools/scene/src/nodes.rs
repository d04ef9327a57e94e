//! The tree of nodes, flattened: who is where in the world.

use crate::bounds::MAX_COORDINATE;
use crate::camera::Camera;
use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::{AREA_LIGHTS, IES_LIGHTS, PUNCTUAL_LIGHTS};
use crate::messages::Messages;
use crate::scene::SceneFog;
use crate::transforms;
use glam::{DAffine3, DVec3};
use gltf::json;
use serde_json::Value;
use std::collections::HashMap;

/// A node with its place in the world.
pub(crate) struct PlacedNode {
    /// Index in the file.
    pub index: usize,
    /// Index among those placed: each instance of a node has its own.
    pub number: usize,
    /// The file's name for it.
    pub name: Option<String>,
    /// From the node's space to the world's. Finite.
    pub world: DAffine3,
    /// Its mesh.
    pub mesh: Option<usize>,
    /// Its skin.
    pub skin: Option<usize>,
    /// How far its mesh is morphed to each target; none where the mesh says.
    pub weights: Option<Vec<f64>>,
    /// Its camera.
    camera: Option<usize>,
    /// Its `EXT_lights_area` extension.
    pub area_light: Option<Value>,
    /// Its `KHR_lights_punctual` extension.
    pub punctual_light: Option<Value>,
    /// Its `EXT_lights_ies` extension.
    pub ies_light: Option<Value>,
    /// What its `extras` say that its emissive mesh stands for.
    pub shape: Option<Value>,
    /// The groups that its surfaces are in, a bit each.
    pub groups: u8,
    /// The groups that its light shines on; 0 for all.
    pub links: u8,
}

/// As much of a name as is kept, since thousands may have it.
pub(crate) fn cut(name: Option<&str>) -> Option<String> {
    name.map(|name| name.chars().take(200).collect())
}

/// Every node of the file's default scene, parents first.
pub(crate) fn place(document: &Document, messages: &mut Messages) -> Result<Vec<PlacedNode>, SceneError> {
    let roots = root_nodes(&document.root, messages);
    let nodes = &document.root.nodes;
    let mut seen = vec![false; nodes.len()];
    let mut placed = Vec::new();
    let mut hidden = 0;
    // Traverse depth first with a stack of our own: a file may nest deeper than the thread's stack
    let mut stack: Vec<(usize, DAffine3)> =
        roots.into_iter().rev().map(|root| (root, DAffine3::IDENTITY)).collect();
    while let Some((index, parent)) = stack.pop() {
        let field = || format!("nodes[{index}]");
        let node = nodes.get(index).ok_or_else(|| document.invalid(field(), "does not exist"))?;
        if std::mem::replace(&mut seen[index], true) {
            return Err(SceneError::NodeTwice { file: document.file.clone(), node: index });
        }
        // Combine its own transform with its parent's
        let local = transforms::of_node(&document.places[index]).map_err(|p| document.invalid(field(), p))?;
        let world = parent * local;
        let columns = world.to_cols_array();
        if columns.iter().any(|x| x.is_nan() || x.abs() > MAX_COORDINATE) {
            return Err(document.not_finite(format!("{}: its world transform", field()), columns));
        }
        if is_hidden(node) {
            hidden += 1;
            continue;
        }
        let extension = |name: &str| node.extensions.as_ref().and_then(|e| e.others.get(name)).cloned();
        let mut said = said(&node.extras);
        let [groups, links] = ["groups", "links"].map(|name| {
            take_bits(said.as_mut(), name).unwrap_or_else(|| {
                let text = format!("extras.arealight.{name} must be a whole number from 0 to 255: left out");
                messages.warn(field(), text);
                0
            })
        });
        let said = said.filter(|said| said.as_object().is_none_or(|object| !object.is_empty()));
        let once = PlacedNode {
            index,
            number: placed.len(),
            name: cut(node.name.as_deref()),
            world,
            mesh: node.mesh.map(|m| m.value()),
            skin: node.skin.map(|s| s.value()),
            weights: document.places[index].weights.clone(),
            camera: node.camera.map(|c| c.value()),
            area_light: extension(AREA_LIGHTS),
            punctual_light: extension(PUNCTUAL_LIGHTS),
            ies_light: extension(IES_LIGHTS),
            shape: said,
            groups,
            links,
        };
        match transforms::of_instances(document, index, node, placed.len())? {
            None => placed.push(once),
            // The node itself is there once, with its camera and its light; its mesh is where the instances
            // are
            Some(instances) => {
                let first = placed.len() + 1;
                let instance = |(at, local): (usize, DAffine3)| PlacedNode {
                    number: first + at,
                    name: once.name.clone(),
                    world: world * local,
                    mesh: once.mesh,
                    shape: once.shape.clone(),
                    weights: once.weights.clone(),
                    skin: None,
                    camera: None,
                    area_light: None,
                    punctual_light: None,
                    ies_light: None,
                    links: once.links,
                    groups: once.groups,
                    index,
                };
                let instances: Vec<PlacedNode> = instances.into_iter().enumerate().map(instance).collect();
                placed.push(PlacedNode { mesh: None, ..once });
                placed.extend(instances);
            }
        }
        let children = node.children.iter().flatten().rev();
        stack.extend(children.map(|child| (child.value(), world)));
    }
    if hidden > 0 {
        messages.note(
            "KHR_node_visibility",
            format!("{hidden} hidden nodes, and what is below them, are left out"),
        );
    }
    Ok(placed)
}

/// Where each of the file's nodes is that is in the scene: without its instances.
pub(crate) fn worlds(placed: &[PlacedNode]) -> HashMap<usize, DAffine3> {
    let mut worlds = HashMap::new();
    for node in placed {
        worlds.entry(node.index).or_insert(node.world);
    }
    worlds
}

/// Whether the file hides a node and all that is below it, by `KHR_node_visibility`.
fn is_hidden(node: &json::Node) -> bool {
    let said = node.extensions.as_ref().and_then(|extensions| extensions.others.get("KHR_node_visibility"));
    said.and_then(|said| said.get("visible")).and_then(Value::as_bool) == Some(false)
}

/// The default scene's nodes; without one the first scene's, without scenes every node that has no parent.
fn root_nodes(root: &json::Root, messages: &mut Messages) -> Vec<usize> {
    let chosen = root.scene.map_or(0, |scene| scene.value());
    let Some(scene) = root.scenes.get(chosen) else {
        let mut is_child = vec![false; root.nodes.len()];
        for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
            is_child[child.value()] = true;
        }
        let parentless = (0..is_child.len()).filter(|i| !is_child[*i]).collect();
        messages.warn("scenes", "there is none: every node is shown");
        return parentless;
    };
    if root.scene.is_none() {
        messages.warn("scene", "there is no default scene: the first is shown");
    }
    scene.nodes.iter().map(json::Index::value).collect()
}

/// The name of the scene that is shown, if it has one.
pub(crate) fn scene_name(root: &json::Root) -> Option<String> {
    let scene = root.scenes.get(root.scene.map_or(0, |scene| scene.value()))?;
    scene.name.clone().filter(|name| !name.is_empty())
}

/// The fog of a scene whose `extras.arealight.fog` has a `density`, and may have an `anisotropy` of 0 and an
/// `albedo` of 1.
pub(crate) fn fog(root: &json::Root, messages: &mut Messages) -> Option<SceneFog> {
    let scene = root.scenes.get(root.scene.map_or(0, |scene| scene.value()))?;
    let said = said(&scene.extras)?.get("fog")?.clone();
    let number = |name: &str, default| said.get(name).map_or(Some(default), Value::as_f64);
    let fog = number("density", 0.0).zip(number("anisotropy", 0.0)).zip(number("albedo", 1.0));
    let fog = fog.map(|((density, anisotropy), albedo)| SceneFog { density, anisotropy, albedo });
    let found = fog.filter(|fog| {
        let is_medium = fog.density > 0.0 && fog.density <= 1e6 && fog.anisotropy.abs() < 1.0;
        is_medium && (0.0..=1.0).contains(&fog.albedo)
    });
    if found.is_none() {
        messages.warn(
            "the scene's extras.arealight.fog",
            "must have a density above 0, an anisotropy between -1 and 1, an albedo from 0 to 1: left out",
        );
    }
    found
}

/// What of a node's or a scene's `extras` is ours, if there is any.
fn said(extras: &json::Extras) -> Option<Value> {
    let extras: Value = serde_json::from_str(extras.as_ref()?.get()).ok()?;
    extras.get("arealight").cloned()
}

/// Takes eight bits out of what a node says; 0 where it says nothing of them, none where they are no such
/// number.
fn take_bits(said: Option<&mut Value>, name: &str) -> Option<u8> {
    let value = said.and_then(|said| said.as_object_mut()?.remove(name));
    let bits = |number: &f64| number.fract() == 0.0 && (0.0..=255.0).contains(number);
    value.map_or(Some(0), |value| value.as_f64().filter(bits).map(|bits| bits as u8))
}

/// The nodes' cameras.
pub(crate) fn cameras(document: &Document, nodes: &[PlacedNode], messages: &mut Messages) -> Vec<Camera> {
    let mut cameras = Vec::new();
    for node in nodes {
        let Some(camera) = node.camera.and_then(|c| document.root.cameras.get(c)) else { continue };
        let name = node.name.clone().or_else(|| camera.name.clone());
        let name = name.unwrap_or_else(|| format!("camera {}", cameras.len()));
        let place = format!("camera '{name}'");
        let [x, y, z] = [node.world.matrix3.x_axis, node.world.matrix3.y_axis, node.world.matrix3.z_axis];
        // A camera looks along its node's -Z; where a mirror or shear is in the way, Z and then Y decide
        let forward = (-z).normalize_or_zero();
        if forward == DVec3::ZERO || x.cross(z).length() == 0.0 || forward.cross(y).length() == 0.0 {
            messages.warn(place, "its node's scale is zero: left out");
            continue;
        }
        let looking = Camera::looking(name, node.world.translation, forward, y);
        let (made, wrong) = match (&camera.perspective, &camera.orthographic) {
            (Some(perspective), _) => (looking.perspective(perspective), "yfov must be between 0 and pi"),
            (None, Some(orthographic)) => {
                (looking.orthographic(orthographic), "xmag and ymag must be more than 0 and at most 1e15")
            }
            (None, None) => (None, "it is neither perspective nor orthographic"),
        };
        match made {
            Some(camera) => cameras.push(camera),
            None => messages.warn(place, format!("{wrong}: left out")),
        }
    }
    cameras
}
