//! `KHR_draco_mesh_compression`: primitives whose data are there in Draco's form alone become as if they had
//! been stored plainly.

use crate::accessor;
use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::DRACO;
use crate::scene::MAX_TRIANGLES;
use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};
use gltf::json;
use gltf::json::accessor::ComponentType;
use gltf::json::validation::Checked::Valid;
use serde_json::json;

/// What the primitives of a file may be together.
struct Budget {
    points: u64,
    faces: u64,
}

/// Decodes what no accessor holds plainly.
pub(crate) fn decompress(document: &mut Document) -> Result<(), SceneError> {
    let mut budget = Budget { points: accessor::MAX_ELEMENTS, faces: MAX_TRIANGLES as u64 };
    for m in 0..document.root.meshes.len() {
        for p in 0..document.root.meshes[m].primitives.len() {
            let field = format!("meshes[{m}].primitives[{p}]");
            let primitive = document.root.meshes[m].primitives[p].clone();
            if let Some(extension) = compressed(document, &primitive).cloned() {
                let primitive = plain(document, primitive, &extension, &field, &mut budget)?;
                document.root.meshes[m].primitives[p] = primitive;
            }
        }
    }
    Ok(())
}

/// The extension of a primitive with an accessor that has no data.
fn compressed<'a>(
    document: &Document,
    primitive: &'a json::mesh::Primitive,
) -> Option<&'a serde_json::Value> {
    let extension = primitive.extensions.as_ref()?.others.get(DRACO)?;
    let is_empty = |index: usize| {
        let accessor = document.root.accessors.get(index);
        accessor.is_some_and(|accessor| accessor.buffer_view.is_none() && accessor.sparse.is_none())
    };
    let mut accessors = primitive.attributes.values().map(json::Index::value);
    accessors.any(is_empty).then_some(extension)
}

/// A primitive with accessors of what its extension holds.
fn plain(
    document: &mut Document,
    mut primitive: json::mesh::Primitive,
    extension: &serde_json::Value,
    field: &str,
    budget: &mut Budget,
) -> Result<json::mesh::Primitive, SceneError> {
    let field = format!("{field}.extensions.{DRACO}");
    let number = |value: &serde_json::Value| value.as_u64().and_then(|number| u32::try_from(number).ok());
    let view = number(&extension["bufferView"]);
    let view = view.ok_or_else(|| document.invalid(&field, "has no bufferView"))?;
    let mesh = decode(document, view as usize, &field, budget)?;

    // The attributes that Draco has; others stay where they are
    for (semantic, index) in &mut primitive.attributes {
        let Valid(semantic) = semantic else { continue };
        let Some(id) = number(&extension["attributes"][semantic.to_string()]) else { continue };
        let place = format!("{field}.attributes.{}", semantic.to_string());
        *index = attribute(document, &mesh, index.value(), id, &place)?;
    }
    // Its faces are triangles, whatever the mode was
    let corners: Vec<u8> = mesh.faces().iter().flatten().flat_map(|point| point.0.to_le_bytes()).collect();
    let count = 3 * mesh.num_faces();
    let view = document.push(corners);
    let accessor = json!({ "componentType": 5125, "type": "SCALAR", "count": count, "bufferView": view });
    let accessor: json::Accessor =
        serde_json::from_value(accessor).map_err(|error| document.invalid(&field, error.to_string()))?;
    primitive.indices = Some(document.root.push(accessor));
    primitive.mode = Valid(json::mesh::Mode::Triangles);
    Ok(primitive)
}

/// Decodes a buffer view, within what is left of the budget.
fn decode(document: &Document, view: usize, field: &str, budget: &mut Budget) -> Result<Mesh, SceneError> {
    let (bytes, _) = document.view(view)?;
    let limits = DecodeLimits::default()
        .with_max_points(budget.points)
        .with_max_faces(budget.faces)
        .with_max_decoded_bytes(document.budget.left());
    let mut mesh = Mesh::new();
    let decoded = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh);
    decoded.map_err(|error| document.invalid(field, format!("cannot be decoded: {error}")))?;
    budget.points -= (mesh.num_points() as u64).min(budget.points);
    budget.faces -= (mesh.num_faces() as u64).min(budget.faces);
    let size: usize = (0..mesh.num_attributes()).map(|id| mesh.attribute(id).buffer().data().len()).sum();
    document.take(field, size as u64)?;
    Ok(mesh)
}

/// An accessor like the one at `index`, of a decoded attribute.
fn attribute(
    document: &mut Document,
    mesh: &Mesh,
    index: usize,
    id: u32,
    field: &str,
) -> Result<json::Index<json::Accessor>, SceneError> {
    let attribute = mesh.attribute_by_unique_id(id);
    let attribute =
        attribute.ok_or_else(|| document.invalid(field, format!("Draco has no attribute {id}")))?;
    let declared = document.root.accessors.get(index).cloned();
    let mut accessor = declared.ok_or_else(|| document.invalid(field, "its accessor does not exist"))?;
    let (Valid(shape), Valid(component)) = (accessor.type_, accessor.component_type) else {
        return Err(document.invalid(field, "its accessor has an unknown type"));
    };
    let components = shape.multiplicity();
    if components != usize::from(attribute.num_components()) {
        let problem =
            format!("Draco has {} components, the accessor {components}", attribute.num_components());
        return Err(document.invalid(field, problem));
    }
    document.take(field, 8 * (mesh.num_points() * components) as u64)?;
    // Whole numbers of up to 24 bits are exact in between
    let values = attribute.read_f32s(mesh.num_points(), components);
    let size = component.0.size();
    let mut bytes = Vec::with_capacity(values.len() * size);
    for value in values {
        match component.0 {
            ComponentType::F32 => bytes.extend(value.to_le_bytes()),
            ComponentType::I8 => bytes.extend((value as i8).to_le_bytes()),
            ComponentType::U8 => bytes.push(value as u8),
            ComponentType::I16 => bytes.extend((value as i16).to_le_bytes()),
            ComponentType::U16 => bytes.extend((value as u16).to_le_bytes()),
            ComponentType::U32 => bytes.extend((value as u32).to_le_bytes()),
        }
    }
    accessor.count = (mesh.num_points() as u64).into();
    accessor.byte_offset = None;
    accessor.sparse = None;
    accessor.buffer_view = Some(document.push(bytes));
    Ok(document.root.push(accessor))
}
