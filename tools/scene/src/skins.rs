//! Skins: meshes that hang on joints.
//!
//! A skinned mesh is where its joints are, each vertex at the weighted mean of the places that up to four of
//! them put it at; the mesh's own node says nothing of it (glTF 2.0, 3.7.3.3).

use crate::accessor;
use crate::attributes::Attributes;
use crate::document::Document;
use crate::error::SceneError;
use crate::messages::Messages;
use crate::nodes::PlacedNode;
use glam::{DAffine3, DMat4};
use gltf::json::mesh::Semantic;
use std::collections::HashMap;

/// What moves a vertex: joints, by their number in the skin, and their weights, whose sum is 1.
pub(crate) type Influence = [(usize, f64); 4];

/// What moves each of a primitive's vertices; none where the file does not say.
pub(crate) fn read(
    attributes: &Attributes<'_>,
    count: usize,
    messages: &mut Messages,
) -> Result<Option<Vec<Influence>>, SceneError> {
    let names = [Semantic::Joints(0), Semantic::Weights(0)];
    if names.iter().any(|name| attributes.accessor(name).is_none()) {
        return Ok(None);
    }
    let [joints, weights] = names.map(|name| attributes.read::<4>(&name));
    let (joints, weights) = (joints?.unwrap_or_default(), weights?.unwrap_or_default());
    if attributes.accessor(&Semantic::Joints(1)).is_some() {
        messages.warn(attributes.field, "JOINTS_1 is not supported: four joints move a vertex");
    }
    if joints.len() != count || weights.len() != count {
        let problem = format!("{} joints and {} weights for {count} positions", joints.len(), weights.len());
        return Err(attributes.document.invalid(format!("{}.JOINTS_0", attributes.field), problem));
    }
    let influence = |(joints, weights): (&[f32; 4], &[f32; 4])| -> Influence {
        let weights = weights.map(|weight| f64::from(weight.max(0.0)));
        let sum: f64 = weights.iter().sum();
        // A vertex without weights hangs on its first joint
        let weights = if sum > 0.0 { weights.map(|weight| weight / sum) } else { [1.0, 0.0, 0.0, 0.0] };
        std::array::from_fn(|i| (joints[i] as usize, weights[i]))
    };
    Ok(Some(joints.iter().zip(&weights).map(influence).collect()))
}

/// From the mesh's space at binding to the world, for each joint of a node's skin. None if it has no skin, or
/// the skin's joints are not all in `worlds`, the places of the scene's nodes.
pub(crate) fn pose<'w>(
    document: &Document,
    worlds: impl Fn() -> &'w HashMap<usize, DAffine3>,
    node: &PlacedNode,
    messages: &mut Messages,
) -> Result<Option<Vec<DAffine3>>, SceneError> {
    let Some(skin) = node.skin.and_then(|skin| document.root.skins.get(skin)) else { return Ok(None) };
    let worlds = worlds();
    let joints = skin.joints.iter().map(|joint| worlds.get(&joint.value()).copied());
    let Some(joints) = joints.collect::<Option<Vec<DAffine3>>>() else {
        let text = "its skin has a joint that is not in the scene: skin ignored";
        messages.warn(format!("nodes[{}]", node.index), text);
        return Ok(None);
    };
    let Some(accessor) = skin.inverse_bind_matrices.as_ref() else { return Ok(Some(joints)) };
    let field = format!("nodes[{}].skin.inverseBindMatrices", node.index);
    let inverses = accessor::floats::<16>(document, accessor.value(), &field)?;
    if inverses.len() < joints.len() {
        let problem = format!("{} for {} joints", inverses.len(), joints.len());
        return Err(document.invalid(field, problem));
    }
    let matrix = |columns: &[f32; 16]| DMat4::from_cols_array(&columns.map(f64::from));
    let joint = |(world, inverse): (&DAffine3, &[f32; 16])| *world * DAffine3::from_mat4(matrix(inverse));
    Ok(Some(joints.iter().zip(&inverses).map(joint).collect()))
}

/// Where the joints put each vertex; the number of the first vertex that has a joint which the skin has not.
pub(crate) fn transforms(pose: &[DAffine3], influences: &[Influence]) -> Result<Vec<DAffine3>, usize> {
    let mean = |(vertex, influence): (usize, &Influence)| {
        let mut sum = DMat4::ZERO;
        for &(joint, weight) in influence.iter().filter(|(_, weight)| *weight > 0.0) {
            sum += DMat4::from(*pose.get(joint).ok_or(vertex)?) * weight;
        }
        Ok(DAffine3::from_mat4(sum))
    };
    influences.iter().enumerate().map(mean).collect()
}
