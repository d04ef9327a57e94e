//! Disks, spheres and tubes as the GPU reads them.

use crate::gpu::{GpuLight, GpuShape};
use crate::light_fault::LightFault;
use crate::{Light, LightShape};
use glam::{DVec3, Vec3};

impl Light {
    /// A disk, sphere or tube as the GPU reads it, relative to `origin`: the subtraction is made in float64.
    pub(crate) fn pack_shape(&self, origin: DVec3) -> Result<GpuShape, LightFault> {
        self.check_radiance()?;
        if self.is_shaped() {
            return Err(LightFault::ProfileNotFlat);
        }
        let texture_layer = self.disk_texture()?;
        let empty = GpuShape {
            radiance: self.radiance.to_array(),
            flags: u32::from(self.links) << GpuLight::LINKS_SHIFT
                | if self.two_sided { GpuShape::TWO_SIDED } else { 0 },
            ..bytemuck::Zeroable::zeroed()
        };
        match self.shape {
            LightShape::Polygon(_) | LightShape::Mesh { .. } => Ok(empty),
            LightShape::Disk { center, axis_u, axis_v } => {
                let [u, v] = [vector("axis_u", axis_u, axis_u)?, vector("axis_v", axis_v, axis_v)?];
                let radius = longer_half_axis(u.as_dvec3(), v.as_dvec3());
                if !radius.is_some_and(in_range) {
                    return Err(LightFault::NoArea { axis_u, axis_v });
                }
                Ok(GpuShape {
                    kind: GpuShape::DISK,
                    center: vector("center", center, center - origin)?.to_array(),
                    axis_u: u.to_array(),
                    axis_v: v.to_array(),
                    // Not below the longer half axis
                    radius: (radius.unwrap_or_default() as f32).next_up(),
                    detail: texture_layer.unwrap_or(GpuLight::NO_TEXTURE),
                    ..empty
                })
            }
            LightShape::Sphere { center, radius } => Ok(GpuShape {
                kind: GpuShape::SPHERE,
                center: vector("center", center, center - origin)?.to_array(),
                radius: narrow_radius(radius)?,
                ..empty
            }),
            LightShape::Tube { p0, p1, radius, ends } => {
                // Each end by itself, so that an error names it; then the middle
                vector("p0", p0, p0 - origin)?;
                vector("p1", p1, p1 - origin)?;
                let half = ((p1 - p0) * 0.5).as_vec3();
                if half == Vec3::ZERO {
                    return Err(LightFault::NoAxis { value: p0 });
                }
                Ok(GpuShape {
                    kind: GpuShape::TUBE,
                    center: ((p0 - origin) * 0.5 + (p1 - origin) * 0.5).as_vec3().to_array(),
                    axis_u: half.to_array(),
                    radius: narrow_radius(radius)?,
                    detail: ends as u32,
                    ..empty
                })
            }
        }
    }

    /// The layer that a disk shows; that of other shapes is refused.
    fn disk_texture(&self) -> Result<Option<u32>, LightFault> {
        let Some(texture) = &self.texture else { return Ok(None) };
        let fault = match self.shape {
            LightShape::Disk { .. } if texture.uvs.is_empty() => return Ok(Some(texture.layer)),
            LightShape::Disk { .. } => LightFault::TextureCount { uvs: texture.uvs.len(), vertices: 0 },
            _ => LightFault::TextureOfSolid,
        };
        Err(fault)
    }
}

/// A vector of a shape, relative to an origin, in float32; `value` is what the field holds.
fn vector(field: &'static str, value: DVec3, relative: DVec3) -> Result<Vec3, LightFault> {
    let narrow = relative.as_vec3();
    if narrow.is_finite() && value.as_vec3().is_finite() {
        Ok(narrow)
    } else {
        Err(LightFault::NotFinite { field, value })
    }
}

fn narrow_radius(value: f64) -> Result<f32, LightFault> {
    if in_range(value) { Ok(value as f32) } else { Err(LightFault::BadRadius { value }) }
}

/// Whether a length is a normal positive number of float32, and not its largest.
fn in_range(length: f64) -> bool {
    length >= f64::from(f32::MIN_POSITIVE) && length < f64::from(f32::MAX) * 0.5
}

/// The longer half axis of an ellipse of two conjugate ones; `None` where they are parallel or zero.
fn longer_half_axis(u: DVec3, v: DVec3) -> Option<f64> {
    // Both numbers of float32, whose squares and their products float64 holds after scaling
    let size = u.abs().max_element().max(v.abs().max_element());
    let (u, v) = (u / size, v / size);
    if !u.is_finite() || !v.is_finite() || u.cross(v) == DVec3::ZERO {
        return None;
    }
    let (sum, difference) =
        (u.length_squared() + v.length_squared(), u.length_squared() - v.length_squared());
    Some(size * (0.5 * (sum + difference.hypot(2.0 * u.dot(v)))).sqrt())
}
