//! How a triangle's texture lies in the world.

use glam::{DVec2, DVec3};

/// An affine function from positions in a plane to texture coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UvMap {
    anchor: DVec3,
    uv: DVec2,
    /// How u and v rise with the position; in the plane.
    gradients: [DVec3; 2],
}

/// The tolerance of [`UvMap::agrees`].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct UvTolerance {
    /// How far coordinates may be off.
    pub uv: DVec2,
    /// How far positions may be off, in the world's unit.
    pub position: f64,
}

impl UvMap {
    /// The map of a triangle that has an area.
    pub fn new([p, q, r]: [DVec3; 3], [a, b, c]: [DVec2; 3]) -> Self {
        let (along, across) = (q - p, r - p);
        let normal = along.cross(across);
        // The basis dual to the two edges
        let square = normal.length_squared();
        let (along, across) = (across.cross(normal) / square, normal.cross(along) / square);
        let gradient = |b: f64, c: f64| along * b + across * c;
        Self { anchor: p, uv: a, gradients: [gradient(b.x - a.x, c.x - a.x), gradient(b.y - a.y, c.y - a.y)] }
    }

    /// The texture coordinate of a position.
    pub fn at(&self, position: DVec3) -> DVec2 {
        let offset = position - self.anchor;
        self.uv + DVec2::new(offset.dot(self.gradients[0]), offset.dot(self.gradients[1]))
    }

    /// Whether it gives `uv` at `position`.
    pub fn agrees(&self, position: DVec3, uv: DVec2, tolerance: UvTolerance) -> bool {
        let slope = DVec2::new(self.gradients[0].length(), self.gradients[1].length());
        // Both the map's own vertices and this one are rounded, and so are the float32 coordinates
        let rounding = slope * (2.0 * tolerance.position) + uv.abs() * (4.0 * f64::from(f32::EPSILON));
        (self.at(position) - uv).abs().cmple(tolerance.uv + rounding).all()
    }
}
