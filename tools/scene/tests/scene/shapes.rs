//! Shapes, in units of metres, with normals and texture coordinates.

use crate::writer::Shape;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

impl Shape {
    fn vertex(&mut self, position: DVec3, normal: DVec3, uv: DVec2) {
        let round = |x: f64| ((x * 65536.0).round() / 65536.0) as f32;
        self.positions.push(position.to_array().map(round));
        self.normals.push(normal.normalize_or(DVec3::Y).to_array().map(round));
        self.uvs.push(uv.to_array().map(round));
    }

    /// Two triangles for each cell of a grid of vertices, `columns` a row, whose first vertex is `first`.
    pub fn grid(&mut self, first: u32, columns: u32, rows: u32) {
        for y in 0..rows - 1 {
            for x in 0..columns - 1 {
                let a = first + y * columns + x;
                let (b, c, d) = (a + 1, a + 1 + columns, a + columns);
                self.indices.extend([a, b, c, a, c, d]);
            }
        }
    }

    /// The shape without texture coordinates, for materials without textures.
    pub fn plain(mut self) -> Self {
        self.uvs.clear();
        self
    }
}

/// A rectangle in the plane y = 0 that faces up, its texture repeated every `tile`.
pub fn floor(width: f64, depth: f64, tile: f64) -> Shape {
    let mut shape = Shape::default();
    for (x, z) in [(-0.5, 0.5), (0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] {
        let position = DVec3::new(x * width, 0.0, z * depth);
        shape.vertex(position, DVec3::Y, DVec2::new(position.x, position.z) / tile);
    }
    shape.indices = vec![0, 1, 2, 0, 2, 3];
    shape
}

/// A flat polygon in the plane z = 0 that faces +Z; counter-clockwise.
pub fn polygon(outline: &[[f64; 2]]) -> Shape {
    let vertices: Vec<DVec3> = outline.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect();
    let outline = arealight::LightShape::Polygon(vertices);
    let light = arealight::Light { shape: outline, ..arealight::Light::default() };
    let mut shape =
        Shape { indices: arealight_tool_kernels::light_sampling::triangles(&light), ..Shape::default() };
    for &vertex in light.shape.vertices() {
        shape.vertex(vertex, DVec3::Z, vertex.truncate());
    }
    shape
}

/// A rectangle around the origin in the plane z = 0 that faces +Z.
pub fn panel(width: f64, height: f64) -> Shape {
    let (x, y) = (width * 0.5, height * 0.5);
    polygon(&[[-x, -y], [x, -y], [x, y], [-x, y]])
}

/// A regular polygon; every other vertex at `inner` times the radius (1 for a plain one, less for a star).
pub fn star(count: u32, radius: f64, inner: f64) -> Shape {
    let vertex = |i: u32| {
        let (sin, cos) = (f64::from(i) / f64::from(count) * TAU + PI * 0.5).sin_cos();
        let radius = if i.is_multiple_of(2) { radius } else { radius * inner };
        [radius * cos, radius * sin]
    };
    polygon(&(0..count).map(vertex).collect::<Vec<_>>())
}

/// A surface of revolution about +Y. The profile's points are (radius, height), from the bottom to the top
/// outside; `normal` gives the outward normal there, in the same coordinates.
pub fn lathe(profile: &[(DVec2, DVec2)], segments: u32) -> Shape {
    let mut shape = Shape::default();
    for (row, (point, normal)) in profile.iter().enumerate() {
        for i in 0..=segments {
            let turn = f64::from(i) / f64::from(segments);
            let (sin, cos) = (turn * TAU).sin_cos();
            let around = |p: &DVec2| DVec3::new(p.x * sin, p.y, p.x * cos);
            let uv = DVec2::new(turn, 1.0 - row as f64 / (profile.len() - 1) as f64);
            shape.vertex(around(point), around(normal), uv);
        }
    }
    shape.grid(0, segments + 1, profile.len() as u32);
    shape
}

pub fn sphere(radius: f64, segments: u32, rings: u32) -> Shape {
    let point = |i: u32| {
        let (sin, cos) = (f64::from(i) / f64::from(rings) * PI).sin_cos();
        let direction = DVec2::new(sin, -cos);
        (direction * radius, direction)
    };
    lathe(&(0..=rings).map(point).collect::<Vec<_>>(), segments)
}

/// A flat disk at y = 0 that faces +Y.
pub fn disk(radius: f64, segments: u32) -> Shape {
    lathe(&[(DVec2::new(radius, 0.0), DVec2::Y), (DVec2::ZERO, DVec2::Y)], segments)
}

/// A cylinder around +Y with caps, its middle at the origin.
pub fn cylinder(radius: f64, height: f64, segments: u32) -> Shape {
    let point = |x: f64, end: f64, normal: DVec2| (DVec2::new(x, end * 0.5 * height), normal);
    let profile = [
        point(0.0, -1.0, DVec2::NEG_Y),
        point(radius, -1.0, DVec2::NEG_Y),
        point(radius, -1.0, DVec2::X),
        point(radius, 1.0, DVec2::X),
        point(radius, 1.0, DVec2::Y),
        point(0.0, 1.0, DVec2::Y),
    ];
    lathe(&profile, segments)
}

/// A cylinder around +Y, of a height between half spheres of `rings` rings.
pub fn capsule(radius: f64, height: f64, segments: u32, rings: u32) -> Shape {
    let half = |end: f64| {
        (0..=rings).map(move |i| {
            let part = f64::from(if end < 0.0 { i } else { rings - i }) / f64::from(rings);
            let (sin, cos) = (part * PI * 0.5).sin_cos();
            let direction = DVec2::new(sin, end * cos);
            (direction * radius + DVec2::Y * (end * 0.5 * height), direction)
        })
    };
    lathe(&half(-1.0).chain(half(1.0)).collect::<Vec<_>>(), segments)
}

/// A box around the origin with sharp edges.
pub fn cuboid(size: [f64; 3]) -> Shape {
    let mut shape = Shape::default();
    for face in 0..6 {
        let first = shape.positions.len() as u32;
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][face % 3] * if face < 3 { 1.0 } else { -1.0 };
        let across = [DVec3::Y, DVec3::Z, DVec3::X][face % 3];
        let up = axis.cross(across);
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let corner = (axis + across * x + up * y) * DVec3::from(size) * 0.5;
            shape.vertex(corner, axis, DVec2::new(x + 1.0, 1.0 - y) * 0.5);
        }
        shape.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    shape
}

/// A box around the origin with rounded edges, `steps` cells a quarter of a rounding.
pub fn rounded_box(size: [f64; 3], rounding: f64, steps: u32) -> Shape {
    let mut shape = Shape::default();
    let inner = DVec3::from(size) * 0.5 - rounding;
    let columns = 2 * steps + 2;
    // Along a face: first the rounding at one end, then that at the other; between them it is flat
    let place = |i: u32| {
        let half = f64::from(i % (steps + 1)) / f64::from(steps);
        if i <= steps { (-1.0, ((half - 1.0) * PI * 0.25).tan()) } else { (1.0, (half * PI * 0.25).tan()) }
    };
    for face in 0..6 {
        let first = shape.positions.len() as u32;
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][face % 3] * if face < 3 { 1.0 } else { -1.0 };
        let across = [DVec3::Y, DVec3::Z, DVec3::X][face % 3];
        let up = axis.cross(across);
        for row in 0..columns {
            for column in 0..columns {
                let ((end_x, x), (end_y, y)) = (place(column), place(row));
                let normal = (axis + across * x + up * y).normalize_or(axis);
                let corner = (axis + across * end_x + up * end_y) * inner;
                let uv = DVec2::new(f64::from(column), f64::from(row)) / f64::from(columns - 1);
                shape.vertex(corner + normal * rounding, normal, uv);
            }
        }
        shape.grid(first, columns, columns);
    }
    shape
}
