//! The primitives of meshes, as the file has them.

use crate::accessor;
use crate::attributes::Attributes;
use crate::document::Document;
use crate::error::SceneError;
use crate::materials;
use crate::messages::Messages;
use crate::nodes::{PlacedNode, cut};
use crate::skins;
use crate::tangents;
use crate::uv_mapping::{Mappings, UvMapping};
use glam::{DVec3, Vec2, Vec3, Vec4};
use gltf::json;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Semantic};
use gltf::json::validation::Checked;

/// A primitive of the file, in its mesh's space.
pub(crate) struct Primitive {
    /// Where it is in the file.
    pub field: String,
    /// Its mesh's name.
    pub mesh_name: Option<String>,
    /// Index of its material in the file.
    pub material: Option<usize>,
    /// Which texture coordinates its material is drawn with: the number in `TEXCOORD_n`.
    pub uv_set: u32,
    /// Whether it has them.
    pub has_uvs: bool,
    /// Whether it has tangents: its own, or by texture coordinates.
    pub has_tangents: bool,
    pub positions: Vec<[f32; 3]>,
    /// As many as positions; zero where there is none.
    pub normals: Vec<Vec3>,
    /// As many as positions; zero where there is none.
    pub uvs: Vec<Vec2>,
    /// The same for the emissive texture, where it is mapped otherwise.
    pub light_uvs: Option<Vec<Vec2>>,
    /// [`crate::Triangle::colors`], as many as positions; none where the file has none.
    pub colors: Vec<[u8; 4]>,
    /// What its mesh may be morphed to.
    pub targets: Vec<MorphTarget>,
    /// How far it is to each, where a node does not say.
    pub weights: Vec<f64>,
    /// What moves each vertex, where the file says it.
    pub influences: Option<Vec<skins::Influence>>,
    /// Indices of vertices that exist.
    pub triangles: Vec<[u32; 3]>,
    /// Of each triangle's corners, [`tangents::read`]; empty where no material needs them, or nothing says
    /// what they are.
    pub tangents: Vec<[Vec4; 3]>,
}

/// What is added to vertices: as many as positions, or none.
pub(crate) struct MorphTarget {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

impl Primitive {
    /// Positions and normals, morphed by as many weights as there are; tangents stay.
    pub fn morphed(&self, weights: &[f64]) -> (Vec<DVec3>, Vec<DVec3>) {
        let wide = |vector: &[f32; 3]| DVec3::from_array(vector.map(f64::from));
        let mut positions: Vec<DVec3> = self.positions.iter().map(wide).collect();
        let mut normals: Vec<DVec3> = self.normals.iter().map(|normal| normal.as_dvec3()).collect();
        for (target, weight) in self.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let all = [(&mut positions, &target.positions), (&mut normals, &target.normals)];
            for (vectors, added) in all {
                for (vector, added) in vectors.iter_mut().zip(added) {
                    *vector += wide(added) * *weight;
                }
            }
        }
        (positions, normals)
    }

    /// Leaves out the vertices that no triangle has, for many primitives may share their accessors; returns
    /// how many those were.
    fn drop_unused(&mut self) -> usize {
        let mut used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|index| used[*index as usize] = true);
        keep(&mut self.positions, &used);
        keep(&mut self.normals, &used);
        keep(&mut self.uvs, &used);
        keep(&mut self.colors, &used);
        self.light_uvs.iter_mut().for_each(|uvs| keep(uvs, &used));
        self.influences.iter_mut().for_each(|influences| keep(influences, &used));
        for target in &mut self.targets {
            keep(&mut target.positions, &used);
            keep(&mut target.normals, &used);
        }
        let place = |next: &mut u32, used: &bool| Some(std::mem::replace(next, *next + u32::from(*used)));
        let places: Vec<u32> = used.iter().scan(0, place).collect();
        self.triangles.iter_mut().flatten().for_each(|index| *index = places[*index as usize]);
        used.len() - self.positions.len()
    }
}

/// Of as many as vertices, or of none, those that are used.
fn keep<T>(values: &mut Vec<T>, used: &[bool]) {
    let mut used = used.iter();
    values.retain(|_| used.next() == Some(&true));
    values.shrink_to_fit();
}

/// The primitives of each of the file's meshes; those of meshes that no node has are not read.
pub(crate) fn read(
    document: &Document,
    nodes: &[PlacedNode],
    messages: &mut Messages,
) -> Result<Vec<Vec<Primitive>>, SceneError> {
    let mut meshes: Vec<Option<Vec<Primitive>>> = document.root.meshes.iter().map(|_| None).collect();
    for node in nodes {
        let Some(index) = node.mesh else { continue };
        let missing = || document.invalid(format!("nodes[{}].mesh", node.index), "does not exist");
        let slot = meshes.get_mut(index).ok_or_else(missing)?;
        if slot.is_none() {
            *slot = Some(read_mesh(document, index, messages)?);
        }
    }
    Ok(meshes.into_iter().map(Option::unwrap_or_default).collect())
}

fn read_mesh(
    document: &Document,
    index: usize,
    messages: &mut Messages,
) -> Result<Vec<Primitive>, SceneError> {
    let mesh = &document.root.meshes[index];
    let place = match &mesh.name {
        Some(name) => format!("meshes[{index}] '{name}'"),
        None => format!("meshes[{index}]"),
    };
    let mut primitives = Vec::new();
    for (number, source) in mesh.primitives.iter().enumerate() {
        let field = format!("{place}.primitives[{number}]");
        let attributes = Attributes { document, source, field: &field };
        if let Some(mode) = mode_of_triangles(&attributes, messages)? {
            let mut primitive = read_primitive(&attributes, mode, cut(mesh.name.as_deref()), messages)?;
            let weights = mesh.weights.iter().flatten();
            primitive.weights = weights.map(|weight| f64::from(*weight)).collect();
            primitives.push(primitive);
        }
    }
    Ok(primitives)
}

/// How a primitive's corners are triangles; none if they are not.
fn mode_of_triangles(
    attributes: &Attributes<'_>,
    messages: &mut Messages,
) -> Result<Option<Mode>, SceneError> {
    match attributes.source.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => Ok(Some(mode)),
        Checked::Valid(mode) => {
            messages.warn(attributes.field, format!("{mode:?} are not triangles: left out"));
            Ok(None)
        }
        Checked::Invalid => Err(attributes.document.invalid(attributes.field, "mode is unknown")),
    }
}

fn read_primitive(
    attributes: &Attributes<'_>,
    mode: Mode,
    mesh_name: Option<String>,
    messages: &mut Messages,
) -> Result<Primitive, SceneError> {
    let &Attributes { document, source, field } = attributes;
    let left = document.budget.left();
    // Vertices
    let positions = attributes.read::<3>(&Semantic::Positions)?;
    let positions = positions.ok_or_else(|| document.invalid(field, "has no POSITION"))?;
    let count = positions.len();
    let normals = attributes.of_vertices::<3>(&Semantic::Normals, count)?;
    let normals = normals.unwrap_or_else(|| vec![[0.0; 3]; count]);
    let normals: Vec<Vec3> = normals.into_iter().map(Vec3::from_array).collect();
    let colors = colors(attributes, count)?;
    let influences = skins::read(attributes, count, messages)?;
    // Texture coordinates, as the material has them
    let material = source.material.map(|m| m.value());
    let of_file = material.and_then(|index| document.root.materials.get(index));
    let Mappings { drawn, light, .. } = of_file.map(Mappings::of).unwrap_or_default();
    let uvs = mapped(attributes, drawn, count)?;
    let light_uvs = if light == drawn { None } else { Some(mapped(attributes, light, count)?) };
    if light_uvs == Some(None) {
        let text = format!("has no TEXCOORD_{}: its emissive texture is read at (0, 0)", light.set);
        messages.warn(field, text);
    }
    let has_uvs = uvs.is_some();
    let [uvs, light_uvs] =
        [Some(uvs), light_uvs].map(|uvs| Some(uvs?.unwrap_or_else(|| vec![Vec2::ZERO; count])));
    let uvs = uvs.unwrap_or_default();
    let targets = targets(attributes, count)?;
    let of_vertices = left - document.budget.left();
    // Corners, three a triangle, and their tangents
    let triangles = triangles(attributes, mode, count, messages)?;
    let mut tangents = None;
    if of_file.is_some_and(materials::has_tangents) {
        let uvs = has_uvs.then_some(&uvs[..]);
        let vertices =
            tangents::Vertices { positions: &positions, normals: &normals, uvs, triangles: &triangles };
        tangents = tangents::read(attributes, &vertices)?;
    }
    let mut primitive = Primitive {
        field: field.to_owned(),
        mesh_name,
        material,
        uv_set: drawn.set,
        has_uvs,
        has_tangents: tangents.is_some(),
        positions,
        normals,
        uvs,
        light_uvs,
        colors,
        influences,
        targets,
        weights: vec![],
        triangles,
        tangents: tangents.unwrap_or_default(),
    };
    let unused = primitive.drop_unused() as u64;
    document.budget.give(of_vertices / (count as u64).max(1) * unused);
    Ok(primitive)
}

/// What a primitive may be morphed to.
fn targets(attributes: &Attributes<'_>, count: usize) -> Result<Vec<MorphTarget>, SceneError> {
    let &Attributes { document, source, field } = attributes;
    let read = |accessor: Option<json::Index<json::Accessor>>, name: String| {
        let Some(accessor) = accessor else { return Ok(vec![]) };
        let added = accessor::floats::<3>(document, accessor.value(), &name)?;
        if added.len() == count {
            return Ok(added);
        }
        Err(document.invalid(name, format!("{} for {count} positions", added.len())))
    };
    let target = |(number, target): (usize, &json::mesh::MorphTarget)| {
        let field = format!("{field}.targets[{number}]");
        let positions = read(target.positions, format!("{field}.POSITION"))?;
        Ok(MorphTarget { positions, normals: read(target.normals, format!("{field}.NORMAL"))? })
    };
    source.targets.iter().flatten().enumerate().map(target).collect()
}

/// Texture coordinates as a material's textures are read at, where the file has them.
fn mapped(
    attributes: &Attributes<'_>,
    mapping: UvMapping,
    count: usize,
) -> Result<Option<Vec<Vec2>>, SceneError> {
    let uvs = attributes.of_vertices::<2>(&Semantic::TexCoords(mapping.set), count)?;
    let apply = |uv| mapping.apply(Vec2::from_array(uv));
    Ok(uvs.map(|uvs| uvs.into_iter().map(apply).collect()))
}

/// The vertices' colours, with alpha or without, as [`crate::Triangle::colors`] are; none without them.
fn colors(attributes: &Attributes<'_>, count: usize) -> Result<Vec<[u8; 4]>, SceneError> {
    let name = Semantic::Colors(0);
    let accessor = attributes.accessor(&name).and_then(|at| attributes.document.root.accessors.get(at));
    let has_alpha = accessor.is_some_and(|accessor| accessor.type_ == Checked::Valid(Type::Vec4));
    let colors = if has_alpha {
        attributes.of_vertices::<4>(&name, count)?
    } else {
        let opaque = |[red, green, blue]: [f32; 3]| [red, green, blue, 1.0];
        let colors = attributes.of_vertices::<3>(&name, count)?;
        colors.map(|colors| colors.into_iter().map(opaque).collect())
    };
    let byte = |part: f32| (part * 255.0).round() as u8;
    let packed = |color: [f32; 4]| {
        let [red, green, blue, alpha] = color.map(|part| part.clamp(0.0, 1.0));
        [byte(red.sqrt()), byte(green.sqrt()), byte(blue.sqrt()), byte(alpha)]
    };
    Ok(colors.unwrap_or_default().into_iter().map(packed).collect())
}

/// A primitive's triangles, of vertices that exist.
fn triangles(
    attributes: &Attributes<'_>,
    mode: Mode,
    count: usize,
    messages: &mut Messages,
) -> Result<Vec<[u32; 3]>, SceneError> {
    let &Attributes { document, source, field } = attributes;
    let corners = match source.indices {
        Some(indices) => accessor::indices(document, indices.value(), &format!("{field}.indices"))?,
        None => (0..count as u32).collect(),
    };
    if let Some(at) = corners.iter().position(|&i| i as usize >= count) {
        let (file, field) = (document.file.clone(), format!("{field}.indices[{at}]"));
        return Err(SceneError::IndexOutOfRange { file, field, index: corners[at], count });
    }
    let (triangles, left_over) = assemble(mode, &corners);
    if left_over > 0 {
        messages.warn(field, format!("{left_over} corners are no whole triangle: left out"));
    }
    Ok(triangles)
}

/// Triangles of a list, strip or fan of corners, and how many corners are left over.
fn assemble(mode: Mode, corners: &[u32]) -> (Vec<[u32; 3]>, usize) {
    let windows = corners.windows(3);
    let triangles: Vec<[u32; 3]> = match mode {
        // Every other triangle of a strip is turned around
        Mode::TriangleStrip => windows
            .enumerate()
            .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
            .collect(),
        Mode::TriangleFan => windows.map(|w| [corners[0], w[1], w[2]]).collect(),
        _ => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    };
    let left_over = match mode {
        Mode::TriangleStrip | Mode::TriangleFan => corners.len().min(if corners.len() < 3 { 2 } else { 0 }),
        _ => corners.len() % 3,
    };
    (triangles, left_over)
}
