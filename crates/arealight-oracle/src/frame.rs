//! The surface frame of a shading point.

use glam::{DMat3, DVec2, DVec3};

/// Below this squared sine between view and normal the tangent is taken from a fixed axis: what is left of
/// the view after its normal part is subtracted would be rounding error.
const PARALLEL: f64 = 1e-28;

/// Below this squared sine between a tangent and the normal the tangent has no direction: what float32 leaves
/// of it is rounding.
const AXIS_PARALLEL: f64 = 1e-10;

/// An orthonormal, right-handed frame in which z is the normal and the view lies in the xz plane, x ≥ 0.
///
/// The twin of `arealight_surface_frame`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceFrame {
    /// Columns: tangent, bitangent, normal, all in the frame of the inputs.
    axes: DMat3,
    /// Cosine between normal and view, in [-1, 1].
    cos_view: f64,
    /// Its sine, not negative.
    sin_view: f64,
}

impl SurfaceFrame {
    /// The frame of a normal and a direction to the viewer, of any length above zero. A zero or non-finite
    /// normal counts as +z, such a view as the normal. Where the view is (anti)parallel to the normal the
    /// tangent is some perpendicular direction.
    pub fn new(normal: DVec3, view: DVec3) -> Self {
        let normal = direction_or(normal, DVec3::Z);
        let view = direction_or(view, normal);
        // Subtract the normal's part of the view; near the normal take an axis that is far from it
        let mut tangent = view - normal * normal.dot(view);
        if tangent.length_squared() < PARALLEL {
            tangent = if normal.x.abs() < 0.5 { DVec3::X } else { DVec3::Y };
            tangent -= normal * normal.dot(tangent);
        }
        // Once more: the first subtraction left an error of 1e-16 / sine
        tangent = tangent.normalize_or(DVec3::X);
        tangent = (tangent - normal * normal.dot(tangent)).normalize_or(DVec3::X);
        let axes = DMat3::from_cols(tangent, normal.cross(tangent), normal);
        // The sine from the tangent: from the cosine it would be wrong by 1e-8 near the normal
        Self { axes, cos_view: normal.dot(view), sin_view: tangent.dot(view).max(0.0) }
    }

    /// A vector of the surface frame's coordinates, from one in the coordinates of the inputs.
    pub fn to_surface(&self, vector: DVec3) -> DVec3 {
        self.axes.transpose() * vector
    }

    /// A vector in the coordinates of the inputs, from one of the surface frame's.
    pub fn from_surface(&self, vector: DVec3) -> DVec3 {
        self.axes * vector
    }

    /// The direction of `tangent` in the surface's plane, unit, in the frame's x and y. One along the normal,
    /// or zero, counts as the first axis that is far from the normal, whatever the view.
    pub fn axis(&self, tangent: DVec3) -> DVec2 {
        let normal = self.axes.z_axis;
        let project = |v: DVec3| v - normal * normal.dot(v);
        let mut flat = project(direction_or(tangent, normal));
        if flat.length_squared() < AXIS_PARALLEL {
            flat = project(if normal.x.abs() < 0.6 { DVec3::X } else { DVec3::Y });
        }
        self.to_surface(flat).truncate().normalize_or(DVec2::X)
    }

    /// Cosine of the angle between normal and view, in [-1, 1]; negative for a view below the surface.
    pub fn cos_view(&self) -> f64 {
        self.cos_view
    }

    /// The unit view direction in the surface frame, `(sin, 0, cos)`. A view below the surface counts as
    /// grazing: `(1, 0, 0)`.
    pub fn view(&self) -> DVec3 {
        if self.cos_view > 0.0 { DVec3::new(self.sin_view, 0.0, self.cos_view) } else { DVec3::X }
    }
}

/// `vector` at length one, for every finite vector but zero (tiny and huge ones too); else `fallback`.
pub(crate) fn direction_or(vector: DVec3, fallback: DVec3) -> DVec3 {
    let largest = vector.abs().max_element();
    if !vector.is_finite() || largest == 0.0 {
        return fallback;
    }
    // Twice, because the reciprocal of a subnormal number would overflow
    let scaled = vector / largest;
    scaled.normalize_or(fallback)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Largest deviation of the axes from an orthonormal, right-handed frame.
    fn defect(frame: &SurfaceFrame) -> f64 {
        let gram = frame.axes.transpose() * frame.axes - DMat3::IDENTITY;
        let columns = gram.to_cols_array();
        columns.iter().fold((frame.axes.determinant() - 1.0).abs(), |worst, entry| worst.max(entry.abs()))
    }

    fn direction() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0_f64, 0.0..std::f64::consts::TAU).prop_map(|(z, phi)| {
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * phi.cos(), r * phi.sin(), z)
        })
    }

    proptest! {
        #[test]
        fn the_frame_is_orthonormal_and_holds_the_view(
            normal in direction(), view in direction(), n in -200.0..200.0_f64, v in -200.0..200.0_f64,
        ) {
            let frame = SurfaceFrame::new(normal * n.exp2(), view * v.exp2());
            // a handful of rounding errors of 1.1e-16
            prop_assert!(defect(&frame) < 2e-15);
            let local = frame.to_surface(view);
            prop_assert!(local.y.abs() < 1e-15 && local.x > -1e-15, "{local}");
            prop_assert!((local.z - frame.cos_view()).abs() < 1e-15);
            prop_assert!(local.z < 0.0 || (frame.view() - local).length() < 2e-15);
            prop_assert!((frame.from_surface(local) - view).length() < 1e-15);
        }

        #[test]
        fn a_view_near_the_normal_keeps_the_frame_orthonormal(
            normal in direction(), aside in direction(), log in -20.0..-3.0_f64, flip: bool,
        ) {
            let sign = if flip { -1.0 } else { 1.0 };
            let frame = SurfaceFrame::new(normal, normal * sign + aside * 10_f64.powf(log));
            prop_assert!(defect(&frame) < 2e-15, "{frame:?}");
        }
    }

    #[test]
    fn subtracting_once_would_not_do() {
        // The twin of the test above: the common construction, at a view 1e-10 from the normal
        let normal = DVec3::new(0.48, 0.6, 0.64);
        let view = (normal + DVec3::new(1e-10, 0.0, 0.0)).normalize_or(normal);
        let tangent = (view - normal * normal.dot(view)).normalize_or(DVec3::X);
        assert!(tangent.dot(normal).abs() > 1e-9);
        assert!(defect(&SurfaceFrame::new(normal, view)) < 2e-15);
    }

    #[test]
    fn what_has_no_direction_falls_back() {
        assert_eq!(SurfaceFrame::new(DVec3::ZERO, DVec3::NAN).axes.z_axis, DVec3::Z);
        assert_eq!(SurfaceFrame::new(DVec3::X, DVec3::ZERO).cos_view(), 1.0);
        assert_eq!(SurfaceFrame::new(DVec3::Z, -DVec3::Z).view(), DVec3::X);
        let tiny = SurfaceFrame::new(DVec3::new(0.0, 0.0, 5e-324), DVec3::new(1e300, 0.0, 1e300));
        assert!((tiny.cos_view() - 0.5_f64.sqrt()).abs() < 1e-15);
    }
}
