//! Meshes as triangles in the world.

use crate::bounds::MAX_COORDINATE;
use crate::document::Document;
use crate::error::SceneError;
use crate::materials::Materials;
use crate::messages::Messages;
use crate::nodes::PlacedNode;
use crate::primitives::Primitive;
use crate::scene::{MAX_TRIANGLES, SceneMaterial, Triangle};
use crate::skins;
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3, Vec4};
use std::ops::Range;

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

/// Appends a node's mesh to the scene's triangles, where its node is, or the pose of its skin.
pub(crate) fn place<'a>(
    document: &Document,
    (node, pose): (&PlacedNode, Option<&[DAffine3]>),
    mesh: &'a [Primitive],
    materials: &Materials,
    triangles: &mut Vec<Triangle>,
    messages: &mut Messages,
) -> Result<Vec<Instance<'a>>, SceneError> {
    let mut instances = Vec::with_capacity(mesh.len());
    for primitive in mesh {
        let total = triangles.len() + primitive.triangles.len();
        if total > MAX_TRIANGLES {
            return Err(document.too_large("triangles", total as u64, MAX_TRIANGLES as u64));
        }
        // A list that grows has room for twice what is in it
        let size = 2 * size_of::<Triangle>() * primitive.triangles.len();
        document.take(format!("{}: its triangles", primitive.field), size as u64)?;
        let material = materials.index(primitive.material);
        warn_of_missing(primitive, &materials.list[material as usize], messages);
        let moves = moves(document, (node, pose), primitive, messages)?;
        instances.push(place_primitive(document, node, &moves, primitive, material, triangles)?);
    }
    Ok(instances)
}

/// Warns of texture coordinates and tangents that a material needs and its primitive has not.
fn warn_of_missing(primitive: &Primitive, material: &SceneMaterial, messages: &mut Messages) {
    if !primitive.has_uvs && material.textures().next().is_some() {
        let text = format!("has no TEXCOORD_{}: its textures are read at (0, 0)", primitive.uv_set);
        messages.warn(primitive.field.as_str(), text);
    } else if !primitive.has_tangents && material.anisotropy_strength > 0.0 {
        let text = "has neither TANGENT nor TEXCOORD_0: its anisotropy has some direction";
        messages.warn(primitive.field.as_str(), text);
    }
}

/// Appends a primitive's triangles, moved into the world.
fn place_primitive<'a>(
    document: &Document,
    node: &PlacedNode,
    moves: &[Move],
    primitive: &'a Primitive,
    material: u32,
    triangles: &mut Vec<Triangle>,
) -> Result<Instance<'a>, SceneError> {
    let at = |vertex: usize| &moves[if moves.len() == 1 { 0 } else { vertex }];
    let (in_space, normals) = primitive.morphed(node.weights.as_ref().unwrap_or(&primitive.weights));
    let positions: Vec<DVec3> =
        in_space.iter().enumerate().map(|(i, p)| at(i).to_world.transform_point3(*p)).collect();
    if let Some(bad) = positions.iter().position(|p| p.is_nan() || p.abs().max_element() > MAX_COORDINATE) {
        let field = format!("{}.POSITION[{bad}] in the world", primitive.field);
        return Err(document.not_finite(field, positions[bad].to_array()));
    }
    let normal = |(i, n): (usize, &DVec3)| (at(i).of_normals * *n).normalize_or_zero().as_vec3();
    let normals: Vec<Vec3> = normals.iter().enumerate().map(normal).collect();
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
        triangles.push(Triangle { positions, normals, uvs, tangents, colors, material, groups: node.groups });
        kept.push(corners.map(|i| i as u32));
    }
    let largest = in_space.iter().fold(0.0_f64, |largest, p| largest.max(p.abs().max_element()));
    let stretch = moves.iter().map(|vertex| vertex.stretch).fold(0.0, f64::max);
    let name = node.name.as_ref().or(primitive.mesh_name.as_ref()).filter(|name| !name.is_empty());
    Ok(Instance {
        name: name.map_or_else(|| format!("node {}", node.index), Clone::clone),
        material,
        positions,
        uvs: primitive.light_uvs.as_ref().unwrap_or(&primitive.uvs),
        drawn: triangles.len() - kept.len()..triangles.len(),
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
    document: &Document,
    (node, pose): (&PlacedNode, Option<&[DAffine3]>),
    primitive: &Primitive,
    messages: &mut Messages,
) -> Result<Vec<Move>, SceneError> {
    let Some(pose) = pose else { return Ok(vec![Move::new(node.world)]) };
    let Some(influences) = &primitive.influences else {
        messages.warn(primitive.field.as_str(), "has no JOINTS_0 and WEIGHTS_0: it is where its node is");
        return Ok(vec![Move::new(node.world)]);
    };
    let moved = skins::transforms(pose, influences).map_err(|vertex| {
        let field = format!("{}.JOINTS_0[{vertex}]", primitive.field);
        let problem = format!("the skin of nodes[{}] has {} joints", node.index, pose.len());
        document.invalid(field, problem)
    })?;
    Ok(moved.into_iter().map(Move::new).collect())
}
