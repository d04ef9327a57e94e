//! Primitives, and their instances as triangles in the world.

use crate::document::Document;
use crate::load::Loader;
use crate::nodes::PlacedNode;
use crate::uv_mapping::{Mappings, UvMapping};
use crate::{MAX_COORDINATE, MAX_TRIANGLES, SceneError, Triangle, accessor, materials, skins, tangents};
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3, Vec4};
use gltf::json;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Semantic};
use gltf::json::validation::Checked;
use std::ops::Range;
use std::rc::Rc;

/// A primitive of the file, in its mesh's space.
pub(crate) struct Primitive {
    /// Where it is in the file.
    pub field: String,
    /// Its mesh's name.
    mesh_name: Option<String>,
    /// Index of its material in the file.
    pub material: Option<usize>,
    /// Which texture coordinates its material is drawn with: the number in `TEXCOORD_n`.
    pub uv_set: u32,
    /// Whether it has them.
    pub has_uvs: bool,
    /// Whether it has tangents: its own, or by texture coordinates.
    pub has_tangents: bool,
    positions: Vec<[f32; 3]>,
    /// As many as positions; zero where there is none.
    normals: Vec<Vec3>,
    /// As many as positions; zero where there is none.
    uvs: Vec<Vec2>,
    /// The same for the emissive texture, where it is mapped otherwise.
    light_uvs: Option<Vec<Vec2>>,
    /// [`Triangle::colors`], as many as positions; none where the file has none.
    colors: Vec<[u8; 4]>,
    /// What moves each vertex, where the file says it.
    influences: Option<Vec<skins::Influence>>,
    /// Indices of vertices that exist.
    triangles: Vec<[u32; 3]>,
    /// Of each triangle's corners, [`tangents::read`]; empty where no material needs them, or nothing says
    /// what they are.
    tangents: Vec<[Vec4; 3]>,
}

/// A primitive's shape in the world.
pub(crate) struct Instance<'a> {
    /// The node's name, else the mesh's.
    pub name: String,
    /// Index into the scene's materials.
    pub material: u32,
    /// World positions.
    pub positions: Vec<DVec3>,
    /// The emissive texture's coordinates, as many as positions; zero where the file has none.
    pub uvs: &'a [Vec2],
    /// Counter-clockwise from the front, without those that have no area.
    pub triangles: Vec<[u32; 3]>,
    /// The same among the scene's.
    pub drawn: Range<usize>,
    /// How far a position may be off because the file's numbers are `f32`, in the world's unit.
    pub rounding: f64,
}

/// The file's meshes, read when a node first uses them.
pub(crate) struct Meshes {
    read: Vec<Option<Rc<[Primitive]>>>,
}

impl Meshes {
    pub fn new(loader: &Loader) -> Self {
        Self { read: vec![None; loader.document.root.meshes.len()] }
    }

    /// The primitives of a node's mesh.
    pub fn of_node(&mut self, loader: &mut Loader, node: &PlacedNode) -> Result<Rc<[Primitive]>, SceneError> {
        let Some(index) = node.mesh else { return Ok(Rc::new([])) };
        if let Some(Some(known)) = self.read.get(index) {
            return Ok(known.clone());
        }
        let mesh = loader.document.root.meshes.get(index).cloned();
        let missing = || loader.document.invalid(format!("nodes[{}].mesh", node.index), "does not exist");
        let mesh = mesh.ok_or_else(missing)?;
        let place = match &mesh.name {
            Some(name) => format!("meshes[{index}] '{name}'"),
            None => format!("meshes[{index}]"),
        };
        if mesh.primitives.iter().any(|p| p.targets.as_ref().is_some_and(|targets| !targets.is_empty())) {
            loader.warn(place.as_str(), "morph targets ignored; the mesh is shown at rest");
        }
        let mut primitives = Vec::new();
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let field = format!("{place}.primitives[{number}]");
            primitives.extend(read(loader, primitive, field, mesh.name.clone())?);
        }
        let primitives: Rc<[Primitive]> = primitives.into();
        self.read[index] = Some(primitives.clone());
        Ok(primitives)
    }
}

/// Reads a primitive; none if it is not made of triangles.
fn read(
    loader: &mut Loader,
    source: &json::mesh::Primitive,
    field: String,
    mesh_name: Option<String>,
) -> Result<Option<Primitive>, SceneError> {
    let mode = match source.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
        Checked::Valid(mode) => {
            loader.warn(field, format!("{mode:?} are not triangles: left out"));
            return Ok(None);
        }
        Checked::Invalid => return Err(loader.document.invalid(field, "mode is unknown")),
    };
    let document = &loader.document;
    // Vertices
    let attribute = |semantic| source.attributes.get(&Checked::Valid(semantic)).map(json::Index::value);
    let place = |name: &str| format!("{field}.{name}");
    let Some(accessor) = attribute(Semantic::Positions) else {
        return Err(document.invalid(field, "has no POSITION"));
    };
    let positions = accessor::floats::<3>(document, accessor, &place("POSITION"))?;
    let count = positions.len();
    let normals = match attribute(Semantic::Normals) {
        Some(accessor) => accessor::floats::<3>(document, accessor, &place("NORMAL"))?,
        None => vec![[0.0; 3]; count],
    };
    let material = source.material.map(|m| m.value());
    let mappings = material.and_then(|index| document.root.materials.get(index)).map(Mappings::of);
    let Mappings { drawn, light, .. } = mappings.unwrap_or_default();
    let coordinates = attribute(Semantic::TexCoords(drawn.set));
    let mapped = |mapping: UvMapping| match attribute(Semantic::TexCoords(mapping.set)) {
        Some(accessor) => {
            let place = place(&format!("TEXCOORD_{}", mapping.set));
            let uvs = accessor::floats::<2>(document, accessor, &place)?;
            if uvs.len() != count {
                return Err(document.invalid(place, format!("{} for {count} positions", uvs.len())));
            }
            Ok(uvs.into_iter().map(|uv| mapping.apply(Vec2::from_array(uv))).collect())
        }
        None => Ok(vec![Vec2::ZERO; count]),
    };
    let uvs: Vec<Vec2> = mapped(drawn)?;
    let light_uvs = if light == drawn { None } else { Some(mapped(light)?) };
    let colors = match attribute(Semantic::Colors(0)) {
        Some(accessor) => colors(document, accessor, &place("COLOR_0"), count)?,
        None => vec![],
    };
    if normals.len() != count {
        return Err(document.invalid(place("NORMAL"), format!("{} for {count} positions", normals.len())));
    }
    // Corners, three a triangle
    let corners = match source.indices {
        Some(indices) => accessor::indices(document, indices.value(), &place("indices"))?,
        None => (0..count as u32).collect(),
    };
    if let Some(at) = corners.iter().position(|&i| i as usize >= count) {
        let (file, field) = (document.file.clone(), format!("{field}.indices[{at}]"));
        return Err(SceneError::IndexOutOfRange { file, field, index: corners[at], count });
    }
    let (triangles, left_over) = assemble(mode, &corners);
    if left_over > 0 {
        loader.warn(field.as_str(), format!("{left_over} corners are no whole triangle: left out"));
    }
    if light_uvs.is_some() && attribute(Semantic::TexCoords(light.set)).is_none() {
        let text = format!("has no TEXCOORD_{}: its emissive texture is read at (0, 0)", light.set);
        loader.warn(field.as_str(), text);
    }
    let influences = skins::read(loader, source, &field, count)?;
    let normals: Vec<Vec3> = normals.into_iter().map(Vec3::from_array).collect();
    // Tangents
    let mut tangents = None;
    if material
        .and_then(|index| loader.document.root.materials.get(index))
        .is_some_and(materials::has_tangents)
    {
        let uvs = coordinates.is_some().then_some(&uvs[..]);
        let vertices =
            tangents::Vertices { positions: &positions, normals: &normals, uvs, triangles: &triangles };
        tangents = tangents::read(loader, source, &field, &vertices)?;
    }
    Ok(Some(Primitive {
        field,
        mesh_name,
        material,
        uv_set: drawn.set,
        has_uvs: coordinates.is_some(),
        has_tangents: tangents.is_some(),
        positions,
        normals,
        uvs,
        light_uvs,
        colors,
        influences,
        triangles,
        tangents: tangents.unwrap_or_default(),
    }))
}

/// The vertices' colours, with alpha or without, as [`Triangle::colors`] are.
fn colors(
    document: &Document,
    accessor: usize,
    field: &str,
    count: usize,
) -> Result<Vec<[u8; 4]>, SceneError> {
    let has_alpha = document
        .root
        .accessors
        .get(accessor)
        .is_some_and(|accessor| accessor.type_ == Checked::Valid(Type::Vec4));
    let colors = if has_alpha {
        accessor::floats::<4>(document, accessor, field)?
    } else {
        let opaque = |[red, green, blue]: [f32; 3]| [red, green, blue, 1.0];
        accessor::floats::<3>(document, accessor, field)?.into_iter().map(opaque).collect()
    };
    if colors.len() != count {
        return Err(document.invalid(field, format!("{} for {count} positions", colors.len())));
    }
    let byte = |part: f32| (part * 255.0).round() as u8;
    let packed = |color: [f32; 4]| {
        let [red, green, blue, alpha] = color.map(|part| part.clamp(0.0, 1.0));
        [byte(red.sqrt()), byte(green.sqrt()), byte(blue.sqrt()), byte(alpha)]
    };
    Ok(colors.into_iter().map(packed).collect())
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

/// Adds a primitive's triangles to the scene, as its node places them, or the pose of its skin.
pub(crate) fn place<'a>(
    loader: &mut Loader,
    (node, pose): (&PlacedNode, Option<&[DAffine3]>),
    primitive: &'a Primitive,
    material: u32,
) -> Result<Instance<'a>, SceneError> {
    let total = loader.scene.triangles.len() + primitive.triangles.len();
    if total > MAX_TRIANGLES {
        return Err(loader.document.too_large("triangles", total as u64, MAX_TRIANGLES as u64));
    }
    // Move the vertices into the world
    let moves = moves(loader, (node, pose), primitive)?;
    let at = |vertex: usize| &moves[if moves.len() == 1 { 0 } else { vertex }];
    let in_space = primitive.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)));
    let positions: Vec<DVec3> =
        in_space.enumerate().map(|(i, p)| at(i).to_world.transform_point3(p)).collect();
    if let Some(bad) = positions.iter().position(|p| p.is_nan() || p.abs().max_element() > MAX_COORDINATE) {
        let field = format!("{}.POSITION[{bad}] in the world", primitive.field);
        return Err(loader.document.not_finite(field, positions[bad].to_array()));
    }
    let normal = |(i, n): (usize, &Vec3)| (at(i).of_normals * n.as_dvec3()).normalize_or_zero().as_vec3();
    let normals: Vec<Vec3> = primitive.normals.iter().enumerate().map(normal).collect();
    let mut kept = Vec::with_capacity(primitive.triangles.len());
    for (number, &[a, b, c]) in primitive.triangles.iter().enumerate() {
        let mirrored = at(a as usize).is_mirrored;
        let corners = if mirrored { [a, c, b] } else { [a, b, c] }.map(|i| i as usize);
        let [d, e, f] = primitive.tangents.get(number).map_or([Vec4::ZERO; 3], |of_corners| {
            std::array::from_fn(|i| {
                let (tangent, vertex) = (of_corners[i], [a, b, c][i] as usize);
                let direction = at(vertex).to_world.matrix3 * tangent.truncate().as_dvec3();
                let side = if mirrored { -tangent.w } else { tangent.w };
                direction.normalize_or_zero().as_vec3().extend(side)
            })
        });
        let tangents = if mirrored { [d, f, e] } else { [d, e, f] };
        let [p, q, r] = corners.map(|i| positions[i]);
        // A triangle without area cannot be seen; one without normals is flat
        let Some(flat) = (q - p).cross(r - p).try_normalize() else { continue };
        let normals = corners.map(|i| if normals[i] == Vec3::ZERO { flat.as_vec3() } else { normals[i] });
        let uvs = corners.map(|i| primitive.uvs[i]);
        let colors = corners.map(|i| primitive.colors.get(i).copied().unwrap_or(Triangle::WHITE));
        let positions = [p, q, r];
        loader.scene.triangles.push(Triangle {
            positions,
            normals,
            uvs,
            tangents,
            colors,
            material,
            lamp: false,
        });
        kept.push(corners.map(|i| i as u32));
    }
    let largest =
        primitive.positions.iter().flatten().fold(0.0_f64, |largest, x| largest.max(f64::from(x.abs())));
    let stretch = moves.iter().map(|vertex| vertex.stretch).fold(0.0, f64::max);
    let name = node.name.as_ref().or(primitive.mesh_name.as_ref()).filter(|name| !name.is_empty());
    Ok(Instance {
        name: name.map_or_else(|| format!("node {}", node.index), Clone::clone),
        material,
        positions,
        uvs: primitive.light_uvs.as_ref().unwrap_or(&primitive.uvs),
        drawn: loader.scene.triangles.len() - kept.len()..loader.scene.triangles.len(),
        triangles: kept,
        rounding: largest * stretch * f64::from(f32::EPSILON),
    })
}

/// What takes vertices into the world.
struct Move {
    to_world: DAffine3,
    /// Normals go by the cofactors; a mirror turns them around.
    of_normals: DMat3,
    /// Whether it turns the vertex order around.
    is_mirrored: bool,
    /// The most that a length grows along an axis.
    stretch: f64,
}

impl Move {
    fn new(to_world: DAffine3) -> Self {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = to_world.matrix3;
        let is_mirrored = x.cross(y).dot(z) < 0.0;
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        Self {
            to_world,
            of_normals: cofactors * if is_mirrored { -1.0 } else { 1.0 },
            is_mirrored,
            stretch: x.length().max(y.length()).max(z.length()),
        }
    }
}

/// One for all of a primitive's vertices, where its node is; or one for each, by the pose of its skin.
fn moves(
    loader: &mut Loader,
    (node, pose): (&PlacedNode, Option<&[DAffine3]>),
    primitive: &Primitive,
) -> Result<Vec<Move>, SceneError> {
    let Some(pose) = pose else { return Ok(vec![Move::new(node.world)]) };
    let Some(influences) = &primitive.influences else {
        loader.warn(primitive.field.as_str(), "has no JOINTS_0 and WEIGHTS_0: it is where its node is");
        return Ok(vec![Move::new(node.world)]);
    };
    let moved = skins::transforms(pose, influences).map_err(|vertex| {
        let field = format!("{}.JOINTS_0[{vertex}]", primitive.field);
        let problem = format!("the skin of nodes[{}] has {} joints", node.index, pose.len());
        loader.document.invalid(field, problem)
    })?;
    Ok(moved.into_iter().map(Move::new).collect())
}
