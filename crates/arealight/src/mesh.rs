//! Meshes of emitters: several flat faces that are one light.
//!
//! The faces of a light have one radiance, one two-sidedness and one record with shared bounds. Each is an
//! outline of its own, convex or concave, which need not touch another. What a light sends is the sum of what
//! its faces send, each by itself: of a one-sided light those that face the surface. That is exact where no
//! face hides another from the surface, as in a convex mesh; what a concave mesh, or a two-sided closed one,
//! hides of itself is added all the same.

use crate::light_fault::LightFault;
use crate::light_shape::area_of;
use crate::{FaceClusters, LightShape};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

impl LightShape {
    /// The most vertices of a face: what float32 counts.
    pub const MAX_FACE: u32 = crate::light_fault::MAX_FACE;

    /// Several flat faces: the vertices of all, one face after another, and how many each has.
    pub fn mesh(vertices: Vec<DVec3>, faces: Vec<u32>) -> Self {
        Self::Mesh { vertices, faces, clusters: FaceClusters::default() }
    }

    /// The triangles of a mesh, each a face: `triangles` are indices into `positions`, three a triangle,
    /// counter-clockwise from the front. Those without an area are left out. Coplanar neighbours cost less as
    /// one face of several vertices.
    ///
    /// ```
    /// # use arealight::LightShape;
    /// # use glam::DVec3;
    /// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let shape = LightShape::from_triangles(&corners, &tetrahedron)?;
    /// assert_eq!((shape.outlines().count(), shape.vertices().len()), (4, 12));
    /// # Ok::<(), arealight::LightFault>(())
    /// ```
    ///
    /// # Errors
    /// [`LightFault`] where an index is out of range or no triangle has an area.
    pub fn from_triangles(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, LightFault> {
        let mut shape = Self::default();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= positions.len()) {
                let count = positions.len();
                return Err(LightFault::TriangleOutOfRange { triangle, index, count });
            }
            let corners = corners.map(|index| positions[index as usize]);
            // What is not finite stays, so that it is named
            if area_of(&corners) != DVec3::ZERO {
                shape.add_face(&corners);
            }
        }
        if shape.vertices().is_empty() { Err(LightFault::TrianglesNoArea) } else { Ok(shape) }
    }

    /// Adds a flat face, an outline as that of a polygon: a polygon becomes a mesh of two faces, one without
    /// vertices the face alone. A disk, sphere or tube is replaced by the face.
    pub fn add_face(&mut self, outline: &[DVec3]) {
        let (mut vertices, mut faces) = match std::mem::take(self) {
            Self::Mesh { vertices, faces, .. } => (vertices, faces),
            Self::Polygon(vertices) => {
                let faces = if vertices.is_empty() { vec![] } else { vec![count_of(&vertices)] };
                (vertices, faces)
            }
            Self::Disk { .. } | Self::Sphere { .. } | Self::Tube { .. } => (vec![], vec![]),
        };
        vertices.extend(outline);
        faces.push(count_of(outline));
        *self = Self::mesh(vertices, faces);
    }

    /// A mesh whose faces are sorted so that far ones are looked at in clusters, not each: its time follows
    /// what a point sees of it. What the shape of a cluster makes of the area that it shows, and what its
    /// distance makes of that, may each be off by `error`, from 0 on, of what it shows on average: the root
    /// of a mean square over directions. What the mesh sends errs by about a tenth of that, .05 say
    /// (docs/shapes.md). Half vectors look at each face.
    ///
    /// Ten thousand faces take a fortieth of a second: make them once, not in each frame. Other shapes stay
    /// as they are, and so do all with an error of 0.
    #[must_use]
    pub fn clustered(self, error: f64) -> Self {
        let Self::Mesh { faces, .. } = &self else { return self };
        let finite = self.vertices().iter().all(|vertex| vertex.is_finite());
        if self.check_faces().is_err() || !finite || error.is_nan() || error <= 0.0 {
            return self;
        }
        let outlines: Vec<_> = self.outlines().map(|outline| (outline, area_of(outline))).collect();
        let (order, clusters) = crate::face_clusters::clustered(&outlines, error);
        let vertices = order.iter().flat_map(|face| outlines[*face].0).copied().collect();
        let faces = order.iter().map(|face| faces[*face]).collect();
        Self::Mesh { vertices, faces, clusters }
    }

    /// The clusters of a mesh's faces; none of other shapes.
    pub(crate) fn clusters(&self) -> &FaceClusters {
        static NONE: FaceClusters = FaceClusters { error: 0.0, clusters: Vec::new() };
        match self {
            Self::Mesh { clusters, .. } => clusters,
            _ => &NONE,
        }
    }

    /// Whether it has more than one face.
    pub fn is_mesh(&self) -> bool {
        self.faces().len() > 1
    }

    /// How many vertices each face of a mesh has; none of other shapes.
    pub(crate) fn faces(&self) -> &[u32] {
        match self {
            Self::Mesh { faces, .. } => faces,
            _ => &[],
        }
    }

    /// The outlines of the faces: of a polygon its only one, of disks, spheres and tubes none. Where a mesh
    /// says that it has more vertices than there are, what there is.
    pub fn outlines(&self) -> impl Iterator<Item = &[DVec3]> {
        let whole = match self {
            Self::Polygon(vertices) => Some(&vertices[..]),
            _ => None,
        };
        let faces = self.faces().iter().scan(self.vertices(), |rest, &count| {
            let (face, after) = rest.split_at((count as usize).min(rest.len()));
            *rest = after;
            Some(face)
        });
        whole.into_iter().chain(faces)
    }

    /// Checks that the faces share out the vertices.
    pub(crate) fn check_faces(&self) -> Result<(), LightFault> {
        let Self::Mesh { vertices, faces, .. } = self else { return Ok(()) };
        for (face, &count) in faces.iter().enumerate() {
            if count < 3 {
                return Err(LightFault::FaceTooFewVertices { face, count });
            }
            if count > Self::MAX_FACE {
                return Err(LightFault::FaceTooManyVertices { face, count });
            }
        }
        let faces: u64 = faces.iter().map(|&count| u64::from(count)).sum();
        let vertices = vertices.len();
        if faces == vertices as u64 { Ok(()) } else { Err(LightFault::FaceCount { faces, vertices }) }
    }

    /// The radius of a disk that from any distance covers as much as the faces add up to, or more: what
    /// bounds that know a light by the sphere that holds it count on, which hold for a convex mesh as it is.
    pub(crate) fn covering_radius(&self, two_sided: bool) -> f64 {
        // Towards d the faces cover sum(A |n.d|), by Cauchy and Schwarz at most sqrt(sum(A) d.M d) with M =
        // sum(A n n^T); those that face it half of that and of the sum of the area vectors
        let (mut total, mut vector, mut moments) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for outline in self.outlines() {
            let area = area_of(outline);
            let size = area.length();
            total += size;
            vector += area;
            let normal = area.normalize_or_zero();
            moments += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z) * size;
        }
        // Wolkowicz and Styan 1980: a symmetric matrix' largest eigenvalue is at most its mean and sqrt(2/3)
        // times what it differs from that by
        let mean = total / 3.0;
        let rest = (moments - DMat3::from_diagonal(DVec3::splat(mean))).to_cols_array();
        let spread = rest.iter().map(|value| value * value).sum::<f64>().sqrt();
        let covered = (total * (mean + (2.0_f64 / 3.0).sqrt() * spread)).sqrt();
        let covered = if two_sided { covered } else { 0.5 * (covered + vector.length()) };
        (covered / PI).sqrt()
    }
}

fn count_of(outline: &[DVec3]) -> u32 {
    // What does not fit is refused by the light's check
    u32::try_from(outline.len()).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuLight;
    use crate::{Effects, Light, LightTexture, PackedLights};

    /// Two squares of the plane z = 0, counter-clockwise from above.
    fn squares() -> Light {
        let square =
            |x: f64| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| DVec3::new(x + u, v, 0.0));
        let mut light = Light { name: "sign".into(), ..Light::default() };
        light.shape.add_face(&square(0.0));
        light.shape.add_face(&square(2.0));
        light
    }

    /// The cube of side 2 about the origin, its front outside.
    fn cube() -> Light {
        let mut light = Light { name: "cube".into(), ..Light::default() };
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let [mut n, mut u] = [DVec3::ZERO; 2];
                n[axis] = sign;
                u[(axis + 1) % 3] = 1.0;
                let v = n.cross(u);
                light.shape.add_face(&[n - u - v, n + u - v, n + u + v, n - u + v]);
            }
        }
        light
    }

    fn with_faces(faces: &[u32]) -> Light {
        let (vertices, faces) = (squares().shape.vertices().to_vec(), faces.to_vec());
        Light { shape: LightShape::mesh(vertices, faces), ..squares() }
    }

    #[test]
    fn a_face_added_to_a_polygon_makes_a_mesh() {
        let (whole, squares) = (squares().shape, squares().shape.vertices().to_vec());
        let mut shape = LightShape::Polygon(squares[..4].to_vec());
        assert!(!shape.is_mesh());
        shape.add_face(&squares[4..]);
        assert_eq!((shape.is_mesh(), &shape), (true, &whole));
        assert_eq!(shape.outlines().map(<[_]>::len).collect::<Vec<_>>(), [4, 4]);
        // The twin: one face alone is a polygon
        let mut alone = LightShape::default();
        alone.add_face(&squares[..4]);
        assert!(!alone.is_mesh() && alone.is_convex_quad());
    }

    #[test]
    fn a_mesh_is_one_record_whose_faces_have_rows() {
        let packed = PackedLights::new(&[squares(), cube()], DVec3::ZERO).unwrap();
        assert_eq!((packed.lights.len(), packed.summary().quad_count), (2, 0));
        // Before the vertices of each face: its normal, and how many they are
        for row in [0, 5] {
            assert_eq!(packed.vertices[row], [0.0, 0.0, 1.0, 4.0]);
            assert!(packed.vertices[row + 1..row + 5].iter().all(|vertex| vertex[3] == 0.0));
        }
        let [squares, cube] = [packed.lights[0], packed.lights[1]];
        assert_eq!((squares.vertex_count, cube.first_vertex, cube.vertex_count), (10, 10, 30));
        assert!(packed.lights.iter().all(|light| light.flags & GpuLight::MESH != 0));
        assert_eq!(packed.summary().effects, Effects::POLYGON | Effects::MESH);
        assert_eq!((packed.lights[0].center, packed.lights[1].center), ([1.5, 0.5, 0.0], [0.0; 3]));
        // The twin: a polygon has vertices alone
        let polygon = LightShape::Polygon(self::squares().shape.vertices().to_vec());
        let polygon = Light { shape: polygon, ..Light::default() };
        let packed = PackedLights::new(&[polygon], DVec3::ZERO).unwrap();
        assert_eq!((packed.lights[0].vertex_count, packed.lights[0].flags & GpuLight::MESH), (8, 0));
        assert!(packed.vertices.iter().all(|vertex| vertex[3] == 0.0));
    }

    #[test]
    fn a_mesh_is_flat_where_its_faces_face_one_way() {
        let mut shape = squares().shape;
        assert!(shape.is_flat() && !shape.is_convex_quad());
        shape.vertices_mut()[4..].reverse();
        assert!(!shape.is_flat(), "one of them faces down");
        assert!(!cube().shape.is_flat());
        assert_eq!(cube().shape.area_vector(), DVec3::ZERO);
        assert_eq!(cube().effects(), Effects::POLYGON | Effects::MESH);
    }

    #[test]
    fn the_radius_covers_what_the_faces_add_up_to() {
        // What the faces that face a direction cover, by search
        let covered = |shape: &LightShape| {
            let directions =
                (0..64).flat_map(|i| (0..64).map(move |j| (f64::from(i) * 0.1, f64::from(j) * 0.1)));
            let towards = directions.map(|(u, v)| DVec3::new(u.cos() * v.sin(), u.sin() * v.sin(), v.cos()));
            let of = |d: DVec3| shape.outlines().map(|outline| area_of(outline).dot(d).max(0.0)).sum::<f64>();
            towards.map(of).fold(0.0, f64::max)
        };
        // Ten sheets, one behind another
        let mut sheets = Light::default();
        for z in 0..10 {
            let raised = squares().shape.vertices()[..4]
                .iter()
                .map(|v| *v + DVec3::Z * 0.01 * f64::from(z))
                .collect::<Vec<_>>();
            sheets.shape.add_face(&raised);
        }
        for light in [squares(), cube(), sheets.clone()] {
            let bound = light.shape.covering_radius(false).powi(2) * PI;
            let most = covered(&light.shape);
            assert!(bound >= most * (1.0 - 1e-9) && bound < 1.01 * most, "{}: {bound}, {most}", light.name);
        }
        let radius = |light: &Light| {
            f64::from(PackedLights::new(std::slice::from_ref(light), DVec3::ZERO).unwrap().lights[0].radius)
        };
        assert!((radius(&cube()) - 3.0_f64.sqrt()).abs() < 1e-6, "a convex mesh's sphere covers more");
        assert!((radius(&sheets) - (10.0 / PI).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn bad_faces_are_named() {
        let bad = |faces: &[u32]| with_faces(faces).validate().unwrap_err().to_string();
        assert_eq!(bad(&[6, 2]), "faces[1]: 2 vertices, a face has at least 3");
        assert_eq!(
            bad(&[4, 3]),
            "faces: 7 vertices in all, but the light has 8: each face has vertices of its own"
        );
        assert!(bad(&[]).starts_with("faces: 0 vertices in all"));
        assert!(bad(&[u32::MAX, 4]).starts_with("faces[0]: 4294967295 vertices, a face has at most"));
        let mut textured = squares();
        textured.texture = Some(LightTexture { layer: 0, uvs: vec![glam::DVec2::ZERO; 8] });
        assert_eq!(
            textured.validate().unwrap_err().to_string(),
            "texture: a mesh is not textured; give the faces that are lights of their own"
        );
        let mut cut = squares();
        let error = cut.cut_holes(&[squares().shape.vertices()[..3].to_vec()]).unwrap_err().to_string();
        assert_eq!(error, "holes: only polygons have holes: cut them into a face before it is added");
        let from = |triangles: &[[u32; 3]]| {
            LightShape::from_triangles(squares().shape.vertices(), triangles).unwrap_err().to_string()
        };
        assert_eq!(from(&[[0, 1, 2], [0, 1, 8]]), "triangles[1]: vertex 8, but there are 8");
        assert_eq!(from(&[[0, 1, 1]]), "triangles: none has an area");
        // The twin
        squares().validate().unwrap();
        // No number of faces panics before it is checked
        let unchecked = with_faces(&[9, 9]);
        assert_eq!(unchecked.shape.outlines().map(<[_]>::len).collect::<Vec<_>>(), [8, 0]);
        assert!(unchecked.shape.center().is_finite());
    }
}
