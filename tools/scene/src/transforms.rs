//! From a node's space to its parent's, and from the spaces of its instances to its own
//! (`EXT_mesh_gpu_instancing`: one mesh, many times).

use crate::accessor;
use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::INSTANCING;
use crate::numbers::Place;
use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json;

/// The most nodes and instances a scene may have, where it has instances; a file beyond is refused.
const MAX_INSTANCES: usize = 1 << 20;

/// From a node's space to its parent's, or what is wrong with it.
pub(crate) fn of_node(place: &Place) -> Result<DAffine3, String> {
    if let Some(matrix) = &place.matrix {
        return Ok(DAffine3::from_mat4(DMat4::from_cols_array(matrix)));
    }
    let scale = place.scale.map_or(DVec3::ONE, DVec3::from_array);
    let translation = place.translation.map_or(DVec3::ZERO, DVec3::from_array);
    let rotation = place.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    let length = rotation.length();
    if !(length > 1e-6 && length.is_finite()) {
        return Err(format!("rotation: {:?} is not a quaternion of unit length", rotation.to_array()));
    }
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation / length, translation))
}

/// From each instance's space to the node's, where `placed` are there already; none where the node's mesh is
/// there once.
pub(crate) fn of_instances(
    document: &Document,
    index: usize,
    node: &json::Node,
    placed: usize,
) -> Result<Option<Vec<DAffine3>>, SceneError> {
    let said = node.extensions.as_ref().and_then(|extensions| extensions.others.get(INSTANCING));
    let Some(attributes) = said.and_then(|said| said.get("attributes")) else { return Ok(None) };
    let field = |name: &str| format!("nodes[{index}].{INSTANCING}.{name}");
    let accessor = |name: &str| attributes.get(name).and_then(serde_json::Value::as_u64);
    let accessor = |name: &str| accessor(name).map(|at| usize::try_from(at).unwrap_or(usize::MAX));
    let read3 = |name: &str| accessor(name).map(|at| accessor::floats::<3>(document, at, &field(name)));
    let read4 = |name: &str| accessor(name).map(|at| accessor::floats::<4>(document, at, &field(name)));
    let (translations, scales) = (read3("TRANSLATION").transpose()?, read3("SCALE").transpose()?);
    let rotations = read4("ROTATION").transpose()?;
    // As many as the attributes have, which is the same number
    let counts = [&translations, &scales].map(|values| values.as_ref().map(Vec::len));
    let mut counts = counts.into_iter().chain([rotations.as_ref().map(Vec::len)]).flatten();
    let Some(count) = counts.next() else { return Ok(None) };
    if counts.any(|other| other != count) {
        return Err(document.invalid(field("attributes"), "are of different counts"));
    }
    if placed + count > MAX_INSTANCES {
        return Err(document.too_large("instances", (placed + count) as u64, MAX_INSTANCES as u64));
    }
    let instance = |i: usize| {
        let local = of_node(&Place {
            matrix: None,
            translation: translations.as_ref().map(|values| values[i].map(f64::from)),
            rotation: rotations.as_ref().map(|values| values[i].map(f64::from)),
            scale: scales.as_ref().map(|values| values[i].map(f64::from)),
            weights: None,
        });
        local.map_err(|problem| document.invalid(field(&format!("[{i}]")), problem))
    };
    (0..count).map(instance).collect::<Result<_, _>>().map(Some)
}
