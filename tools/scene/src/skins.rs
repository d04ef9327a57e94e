//! Skins: meshes that hang on joints.
//!
//! A skinned mesh is where its joints are, each vertex at the weighted mean of the places that up to four of
//! them put it at; the mesh's own node says nothing of it (glTF 2.0, 3.7.3.3).

use crate::load::Loader;
use crate::nodes::PlacedNode;
use crate::{SceneError, accessor};
use glam::{DAffine3, DMat4};
use gltf::json;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use std::collections::HashMap;

/// What moves a vertex: joints, by their number in the skin, and their weights, whose sum is 1.
pub(crate) type Influence = [(usize, f64); 4];

/// What moves each of a primitive's vertices; none where the file does not say.
pub(crate) fn read(
    loader: &mut Loader,
    source: &json::mesh::Primitive,
    field: &str,
    count: usize,
) -> Result<Option<Vec<Influence>>, SceneError> {
    let attribute = |semantic| source.attributes.get(&Checked::Valid(semantic)).map(json::Index::value);
    let of_vertices = [attribute(Semantic::Joints(0)), attribute(Semantic::Weights(0))];
    let [Some(joints), Some(weights)] = of_vertices else { return Ok(None) };
    if attribute(Semantic::Joints(1)).is_some() {
        loader.warn(field, "JOINTS_1 is not supported: four joints move a vertex");
    }
    let document = &loader.document;
    let joints = accessor::floats::<4>(document, joints, &format!("{field}.JOINTS_0"))?;
    let weights = accessor::floats::<4>(document, weights, &format!("{field}.WEIGHTS_0"))?;
    if joints.len() != count || weights.len() != count {
        let problem = format!("{} joints and {} weights for {count} positions", joints.len(), weights.len());
        return Err(document.invalid(format!("{field}.JOINTS_0"), problem));
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

/// From the mesh's space at binding to the world, for each joint of a node's skin, which is that number in
/// the file. None if the skin's joints are not all in `worlds`, the places of the scene's nodes.
pub(crate) fn pose(
    loader: &mut Loader,
    worlds: &HashMap<usize, DAffine3>,
    node: &PlacedNode,
    skin: usize,
) -> Result<Option<Vec<DAffine3>>, SceneError> {
    let Some(skin) = loader.document.root.skins.get(skin) else { return Ok(None) };
    let joints = skin.joints.iter().map(|joint| worlds.get(&joint.value()).copied());
    let Some(joints) = joints.collect::<Option<Vec<DAffine3>>>() else {
        let text = "its skin has a joint that is not in the scene: skin ignored";
        loader.warn(format!("nodes[{}]", node.index), text);
        return Ok(None);
    };
    let Some(accessor) = skin.inverse_bind_matrices.as_ref() else { return Ok(Some(joints)) };
    let field = format!("nodes[{}].skin.inverseBindMatrices", node.index);
    let inverses = accessor::floats::<16>(&loader.document, accessor.value(), &field)?;
    if inverses.len() < joints.len() {
        let problem = format!("{} for {} joints", inverses.len(), joints.len());
        return Err(loader.document.invalid(field, problem));
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
