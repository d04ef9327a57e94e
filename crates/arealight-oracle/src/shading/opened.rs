//! Lights seen through openings.

use super::RelativeLight;
use super::profiled::normal_of;
use crate::frame::SurfaceFrame;
use crate::polygon::clip_by;
use arealight::Profile;
use glam::DVec3;

impl RelativeLight {
    /// The planes through the shading point, their normals inwards, that bound what is seen of the light:
    /// none without an opening. `None` where nothing is seen.
    pub(super) fn bounds(&self) -> Option<Vec<DVec3>> {
        let Some(opening) = &self.opening else { return Some(vec![]) };
        let (center, u, v) = (opening.center, opening.axis_u, opening.axis_v);
        let normal = u.cross(v);
        let side: f64 = self.vertices.iter().map(|vertex| (*vertex - center).dot(normal)).sum();
        if center.dot(normal) * side <= 0.0 {
            return (!opening.housed).then(Vec::new);
        }
        let plane = |(out, along): (DVec3, DVec3)| {
            let normal = along.cross(center + out).normalize_or_zero();
            if normal.dot(out) > 0.0 { -normal } else { normal }
        };
        Some([(u, v), (-u, v), (v, u), (-v, u)].map(plane).to_vec())
    }

    /// As these, with the square about the cone that a profile ends at: cubature may miss a narrow one.
    pub(super) fn limits(&self) -> Option<Vec<DVec3>> {
        let mut bounds = self.bounds()?;
        let end = self.profile.as_ref().map_or(0.0, Profile::end);
        if let Some(normal) = normal_of(&self.vertices).filter(|_| end > 0.01) {
            let foot = normal * normal.dot(self.vertices[0]).signum() * (end.powi(-2) - 1.0).sqrt();
            let (u, v) = normal.any_orthonormal_pair();
            bounds.extend([foot + u, foot - u, foot + v, foot - v]);
        }
        Some(bounds)
    }

    /// What is seen of the outline, in a surface's frame.
    pub(super) fn seen(&self, frame: &SurfaceFrame) -> Vec<DVec3> {
        let Some(bounds) = self.bounds() else { return vec![] };
        let vertices = self.vertices.iter().map(|vertex| frame.to_surface(*vertex)).collect();
        bounds.iter().fold(vertices, |left, normal| {
            let normal = frame.to_surface(*normal);
            clip_by(left, |vertex| normal.dot(vertex))
        })
    }
}
