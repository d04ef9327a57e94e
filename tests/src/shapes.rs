//! The kernel that evaluates shapes, and its arguments.

use crate::TestEngine;
use arealight::kernels::{Access, Binding, Kernel};
use arealight_oracle::ellipse::Ellipse;
use arealight_oracle::tube::{Ends, Tube};
use arealight_vk::Resource;
use glam::{DMat3, DVec3};

/// Form factors of shapes over a list of arguments.
pub static SHAPES: Kernel = Kernel {
    name: "shapes",
    spirv: include_bytes!("../spirv/shapes.spv"),
    local_size: [64, 1, 1],
    push_constant_size: 4,
    bindings: &[
        Binding::storage_buffer("arguments", Access::Read, "vec4[4] a call"),
        Binding::storage_buffer("ends", Access::Read, "int a call: arealight::TubeEnds"),
        Binding::storage_buffer("results", Access::Write, "vec4 a call"),
    ],
    constants: &[0, 1, 2],
};

/// The functions that the kernel calls: its first specialisation constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum ShapeFunction {
    /// `arealight_ellipse_form_factor` of a center a and axes b and c, two-sided where d.w is not 0.
    Ellipse = 0,
    /// `arealight_ellipse_bare`, likewise.
    EllipseBare = 1,
    /// `arealight_ellipse_vector_form_factor` of a center a and axes b and c.
    EllipseVector = 2,
    /// `arealight_sphere_form_factor` of a center a and a radius a.w, two-sided where d.w is not 0.
    Sphere = 3,
    /// The form factor of the silhouette of a sphere of a center a and a radius a.w, under the matrix of columns b, c and d.
    Silhouette = 4,
    /// `arealight_arctangent` of a.y and a.x.
    Arctangent = 5,
    /// The published disk, of a center a and axes b and c: with its sphere for the horizon, and the cheap one. The rung is
    /// whether its discriminant is clamped.
    Published = 6,
    /// `arealight_tube_form_factor` of a center a, half an axis b and a radius a.w, under the matrix of rows c, d, and the fourth
    /// components of c, d and b.
    Tube = 7,
    /// `arealight_lobe_shape` of an ellipse of a center a and axes b and c, and of a sphere of that center and the radius b.x:
    /// see the kernel for the lobe's matrix.
    Lobe = 8,
}

/// What a call is given.
pub type ShapeArguments = [[f32; 4]; 4];

fn narrow(v: DVec3, w: f64) -> [f32; 4] {
    [v.x as f32, v.y as f32, v.z as f32, w as f32]
}

/// An ellipse's arguments, which are two-sided.
pub fn ellipse_arguments(ellipse: &Ellipse) -> ShapeArguments {
    [
        narrow(ellipse.center, 0.0),
        narrow(ellipse.axis_u, 0.0),
        narrow(ellipse.axis_v, 0.0),
        [0.0, 0.0, 0.0, 1.0],
    ]
}

/// A sphere's arguments, under a matrix.
pub fn sphere_arguments(center: DVec3, radius: f64, matrix: &DMat3) -> ShapeArguments {
    [
        narrow(center, radius),
        narrow(matrix.x_axis, 0.0),
        narrow(matrix.y_axis, 0.0),
        narrow(matrix.z_axis, 1.0),
    ]
}

/// A tube's arguments, under a matrix. Its center and half its axis should be of float32.
pub fn tube_arguments(tube: &Tube, matrix: &DMat3) -> ShapeArguments {
    let last = matrix.row(2);
    [
        narrow((tube.start + tube.end) * 0.5, tube.radius),
        narrow((tube.end - tube.start) * 0.5, last.z),
        narrow(matrix.row(0), last.x),
        narrow(matrix.row(1), last.y),
    ]
}

/// The arguments of a disk before a lobe: its matrix has these two first rows, and a third one across them of length `alpha`.
pub fn lobe_arguments(ellipse: &Ellipse, rows: [DVec3; 2], alpha: f64) -> ShapeArguments {
    [
        narrow(ellipse.center, rows[0].x),
        narrow(ellipse.axis_u, rows[0].y),
        narrow(ellipse.axis_v, rows[0].z),
        narrow(rows[1], alpha),
    ]
}

impl TestEngine {
    /// What a white lobe reflects of ellipses and of spheres, clipped at a horizon (`AREALIGHT_HORIZON_*`).
    ///
    /// # Panics
    /// Where the device fails.
    pub fn lobes(&self, horizon: u32, rung: u32, arguments: &[ShapeArguments]) -> Vec<[f32; 2]> {
        let constants = [(0, ShapeFunction::Lobe as u32), (1, rung), (2, horizon)];
        let found = self.call(&constants, arguments, &vec![0; arguments.len()]);
        found.iter().map(|r| [r[0], r[1]]).collect()
    }

    /// Form factors of tubes with their ends; cut by a surface whose normal is z where asked for.
    ///
    /// # Panics
    /// Where the device fails.
    pub fn tubes(&self, cut: bool, rung: u32, arguments: &[ShapeArguments], ends: &[Ends]) -> Vec<f32> {
        let constants = [(0, ShapeFunction::Tube as u32), (1, rung), (2, u32::from(cut))];
        let ends: Vec<u32> = ends.iter().map(|ends| *ends as u32).collect();
        self.call(&constants, arguments, &ends).iter().map(|r| r[0]).collect()
    }

    fn call(&self, constants: &[(u32, u32)], arguments: &[ShapeArguments], ends: &[u32]) -> Vec<[f32; 4]> {
        let given = self.host().storage_buffer("arguments", arguments).expect("memory");
        let ends = self.host().storage_buffer("ends", ends).expect("memory");
        let inputs = [Resource::buffer(given.handle()), Resource::buffer(ends.handle())];
        self.dispatch(&SHAPES, constants, &inputs, arguments.len())
    }

    /// Calls a function on shapes, by form factor bits.
    ///
    /// # Panics
    /// Where the device fails.
    pub fn shapes(&self, function: ShapeFunction, rung: u32, arguments: &[ShapeArguments]) -> Vec<[f32; 4]> {
        self.call(&[(0, function as u32), (1, rung), (2, 0)], arguments, &vec![0; arguments.len()])
    }

    /// Form factors of ellipses, of both sides.
    ///
    /// # Panics
    /// Where the device fails, or a result is not in [0, 1] by its bits.
    pub fn ellipses(&self, function: ShapeFunction, rung: u32, ellipses: &[Ellipse]) -> Vec<f64> {
        let arguments: Vec<_> = ellipses.iter().map(ellipse_arguments).collect();
        let found = self.shapes(function, rung, &arguments);
        let factor = |(found, ellipse): (&[f32; 4], &Ellipse)| {
            assert!(found[0].to_bits() <= 1.0_f32.to_bits(), "{}: {ellipse:?}", found[0]);
            f64::from(found[0])
        };
        found.iter().zip(ellipses).map(factor).collect()
    }
}
