//! The kernel that evaluates disks, spheres and tubes, and its arguments: for the tests and the benchmarks.

use arealight::kernels::Kernel;
use arealight_oracle::ellipse::Ellipse;
use arealight_oracle::tube::Tube;
use glam::{DMat3, DVec3};

/// Form factors of shapes over a list of arguments.
pub static SHAPES: Kernel = Kernel::new("shapes", include_bytes!("../spirv/shapes.spv"));

/// The functions that the kernel calls: its first specialisation constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum ShapeFunction {
    /// `arealight_ellipse_form_factor` of a center a and axes b and c, two-sided where d.w is not 0.
    Ellipse = 0,
    /// `arealight_sphere_form_factor` of a center a and a radius a.w, two-sided where d.w is not 0.
    Sphere = 1,
    /// The form factor of the silhouette of a sphere of a center a and a radius a.w, under the matrix of
    /// columns b, c and d.
    Silhouette = 2,
    /// `arealight_arctangent` of a.y and a.x.
    Arctangent = 3,
    /// The published disk, of a center a and axes b and c: with its sphere for the horizon, and the cheap
    /// one.
    Published = 4,
    /// `arealight_tube_form_factor` of a center a, half an axis b and a radius a.w, under the matrix of rows
    /// c, d, and the fourth components of c, d and b.
    Tube = 5,
    /// `arealight_lobe_shape` of an ellipse of a center a and axes b and c, and of a sphere of that center
    /// and the radius b.x: see the kernel for the lobe's matrix.
    Lobe = 6,
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

/// The arguments of a disk before a lobe: its matrix has these two first rows, and a third one across them of
/// length `alpha`.
pub fn lobe_arguments(ellipse: &Ellipse, rows: [DVec3; 2], alpha: f64) -> ShapeArguments {
    [
        narrow(ellipse.center, rows[0].x),
        narrow(ellipse.axis_u, rows[0].y),
        narrow(ellipse.axis_v, rows[0].z),
        narrow(rows[1], alpha),
    ]
}
