//! Tangents of a primitive: the file's own, or where it has none those of `MikkTSpace`, as glTF asks for.

use crate::attributes::Attributes;
use crate::error::SceneError;
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::mesh::Semantic;

/// What tangents are made of.
pub(crate) struct Vertices<'a> {
    pub positions: &'a [[f32; 3]],
    /// Zero where there is none.
    pub normals: &'a [Vec3],
    /// None where the file has none.
    pub uvs: Option<&'a [Vec2]>,
    pub triangles: &'a [[u32; 3]],
}

/// The tangents of each triangle's corners, none where nothing says what they are: in xyz the direction of
/// growing u, unit, and in w the side of the bitangent, `cross(normal, tangent) w`. In the mesh's space.
pub(crate) fn read(
    attributes: &Attributes<'_>,
    vertices: &Vertices<'_>,
) -> Result<Option<Vec<[Vec4; 3]>>, SceneError> {
    if let Some(given) = attributes.of_vertices::<4>(&Semantic::Tangents, vertices.positions.len())? {
        let corner = |index: u32| Vec4::from_array(given[index as usize]);
        return Ok(Some(vertices.triangles.iter().map(|corners| corners.map(corner)).collect()));
    }
    let Some(uvs) = vertices.uvs else { return Ok(None) };
    let mut mesh = Mesh { vertices, uvs, tangents: vec![[Vec4::ZERO; 3]; vertices.triangles.len()] };
    // It has no error that can happen
    Ok(generate_tangents(&mut mesh).is_ok().then_some(mesh.tangents))
}

struct Mesh<'a> {
    vertices: &'a Vertices<'a>,
    uvs: &'a [Vec2],
    tangents: Vec<[Vec4; 3]>,
}

impl Mesh<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.vertices.triangles[face][corner] as usize
    }
}

impl Geometry for Mesh<'_> {
    fn num_faces(&self) -> usize {
        self.vertices.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertices.positions[self.vertex(face, corner)]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        let given = self.vertices.normals[self.vertex(face, corner)];
        if given != Vec3::ZERO {
            return given.to_array();
        }
        let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from_array(self.position(face, corner)));
        (b - a).cross(c - a).normalize_or_zero().to_array()
    }

    /// With v upwards, as `MikkTSpace` has it: rows of a texture run downwards in glTF.
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let uv = self.uvs[self.vertex(face, corner)];
        [uv.x, 1.0 - uv.y]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let tangent = space.map_or(Vec4::ZERO, |space| Vec4::from_array(space.tangent_encoded()));
        self.tangents[face][corner] = tangent;
    }
}
