//! Lights that a root extension lists and nodes refer to by their place in the list.

use crate::document::Document;
use crate::error::SceneError;
use crate::nodes::PlacedNode;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

#[derive(Deserialize)]
#[serde(bound(deserialize = "L: DeserializeOwned"))]
struct Root<L> {
    #[serde(default = "Vec::new")]
    lights: Vec<L>,
}

#[derive(Deserialize)]
struct Reference {
    light: usize,
}

/// Each node with the light that it refers to, and the light's place; `reference` is what the node has of the
/// extension of this name.
///
/// # Errors
/// [`SceneError`] names the field where the extension or a light is missing, or is not what it should be.
pub(crate) fn referenced<'n, L: DeserializeOwned + Clone>(
    document: &Document,
    extension: &str,
    nodes: &'n [PlacedNode],
    reference: impl Fn(&PlacedNode) -> Option<&Value>,
) -> Result<Vec<(&'n PlacedNode, usize, L)>, SceneError> {
    let nodes: Vec<_> = nodes.iter().filter_map(|node| Some((node, reference(node)?.clone()))).collect();
    if nodes.is_empty() {
        return Ok(vec![]);
    }
    let place = format!("extensions.{extension}");
    let root = document.root.extensions.as_ref().and_then(|e| e.others.get(extension));
    let root = root.cloned().ok_or_else(|| document.invalid(&place, "is missing"))?;
    let root = Root::<L>::deserialize(root).map_err(|e| document.invalid(&place, e.to_string()))?;
    let light_of = |(node, reference): (&'n PlacedNode, Value)| {
        let field = format!("nodes[{}].{place}", node.index);
        let Reference { light } =
            Reference::deserialize(reference).map_err(|e| document.invalid(&field, e.to_string()))?;
        let found = root.lights.get(light).cloned();
        let problem = || document.invalid(&field, format!("light {light} of {}", root.lights.len()));
        Ok((node, light, found.ok_or_else(problem)?))
    };
    nodes.into_iter().map(light_of).collect()
}

/// What messages call a light: its node's name, else its own, else its place among those of a `kind`.
pub(crate) fn name(node: &PlacedNode, own: Option<&String>, kind: &str, place: usize) -> String {
    let name = node.name.as_ref().into_iter().chain(own).find(|name| !name.is_empty());
    name.map_or_else(|| format!("{kind} {place}"), Clone::clone)
}
