//! Emissive meshes that stand for a disk, a sphere or a tube, by a word in their node's `extras`.

use crate::images::Textures;
use crate::meshes::Instance;
use crate::messages::Messages;
use crate::nodes::PlacedNode;
use crate::scene::SceneMaterial;
use crate::shaping::Said as Shaping;
use crate::shown;
use crate::uv_map::{UvMap, UvTolerance};
use arealight::blockers::ROUND_MARGIN;
use arealight::{Light, LightShape, TubeEnds};
use glam::{DAffine3, DVec2, DVec3};
use serde::Deserialize;

/// What `extras.arealight` of a node says: in the node's space, about its origin and its Y axis.
#[derive(Deserialize)]
#[serde(
    tag = "shape",
    rename_all = "lowercase",
    deny_unknown_fields,
    expecting = "an object whose shape is disk, sphere, cylinder, pipe or capsule, with its sizes"
)]
enum Said {
    /// Faces +Y.
    Disk {
        radius: f64,
    },
    Sphere {
        radius: f64,
    },
    /// With caps; `height` is between them.
    Cylinder {
        radius: f64,
        height: f64,
    },
    /// A cylinder without caps.
    Pipe {
        radius: f64,
        height: f64,
    },
    /// `height` is between the middles of the half spheres.
    Capsule {
        radius: f64,
        height: f64,
    },
}

/// What a shape's light shows: a texture, and the texture coordinates of the corners of its box.
pub(crate) type ShownImage = Option<(u32, [DVec2; 4])>;

/// The shape that a node's word says its emissive mesh is, and what it shows. None where there is no such
/// word, or none that holds, and the mesh is what it is.
pub(crate) fn light(
    node: &PlacedNode,
    instance: &Instance,
    material: &SceneMaterial,
    textures: &Textures,
    messages: &mut Messages,
) -> Option<(Light, ShownImage)> {
    let said = node.shape.as_ref().filter(|said| !Shaping::is_said(said))?;
    let place = format!("light '{}' (node {})", instance.name, node.index);
    let texture = material.emission_texture;
    let shape = Said::deserialize(said).map_err(|error| error.to_string());
    let placed = shape.and_then(|said| said.placed(&node.world)).and_then(|shape| match texture {
        Some(texture) if matches!(shape, LightShape::Disk { .. }) => {
            let tolerance =
                UvTolerance { uv: shown::tolerance(textures, texture), position: instance.rounding };
            upright(&shape, instance, tolerance).map(|(shape, uvs)| (shape, Some((texture, uvs))))
        }
        _ => Ok((shape, None)),
    });
    let light = placed.and_then(|(shape, image)| {
        // Solids shine outwards, whatever their material says
        let two_sided = material.double_sided && matches!(shape, LightShape::Disk { .. });
        let (name, radiance) = (instance.name.clone(), material.emission);
        let light = Light { name, radiance, two_sided, links: node.links, shape, ..Light::default() };
        light.validate().map_err(|error| error.to_string())?;
        let fits = instance.positions.iter().all(|position| is_at(&light.shape, *position));
        fits.then_some((light, image)).ok_or_else(|| "its mesh is elsewhere, and would hide it".into())
    });
    match &light {
        Ok((_, None)) if texture.is_some() => {
            messages.warn(place, "its texture is not shown in what it lights: only disks are textured");
        }
        Ok(_) => {}
        Err(problem) => {
            messages.warn(place, format!("extras.arealight: {problem}: the mesh's own polygons shine"));
        }
    }
    light.ok()
}

/// Whether a mesh's vertex is where rays to a shape end: in a disk's plane, to a part of its size, or within
/// [`ROUND_MARGIN`] of the others' radii.
fn is_at(shape: &LightShape, position: DVec3) -> bool {
    match *shape {
        LightShape::Disk { center, axis_u, axis_v } => {
            let normal = axis_u.cross(axis_v).normalize_or_zero();
            (position - center).dot(normal).abs() <= 1e-4 * axis_u.length().min(axis_v.length())
        }
        LightShape::Sphere { center, radius } => position.distance(center) <= ROUND_MARGIN * radius,
        LightShape::Tube { p0, p1, radius, .. } => {
            let part = (position - p0).dot(p1 - p0) / p0.distance_squared(p1);
            position.distance(p0.lerp(p1, part.clamp(0.0, 1.0))) <= ROUND_MARGIN * radius
        }
        LightShape::Polygon(_) | LightShape::Mesh { .. } => true,
    }
}

/// An ellipse whose axes run along the image that its mesh shows, as a light's do, and the texture
/// coordinates of the image's box around it: its corners, the first one first. Or why there is none.
fn upright(
    shape: &LightShape,
    instance: &Instance,
    tolerance: UvTolerance,
) -> Result<(LightShape, [DVec2; 4]), String> {
    let LightShape::Disk { center, axis_u, axis_v } = *shape else { return Err("it is no disk".into()) };
    // One map for the whole mesh: that of its largest triangle
    let corners = |triangle: &[u32; 3]| triangle.map(|index| instance.positions[index as usize]);
    let uv = |index: u32| instance.uvs[index as usize].as_dvec2();
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = corners(triangle);
        (b - a).cross(c - a).length_squared()
    };
    let largest = instance.triangles.iter().max_by(|a, b| area(a).total_cmp(&area(b)));
    let largest = largest.ok_or("it has no triangle")?;
    let map = UvMap::new(corners(largest), largest.map(uv));
    let agrees = |index: &u32| map.agrees(instance.positions[*index as usize], uv(*index), tolerance);
    if !instance.triangles.iter().flatten().all(agrees) {
        return Err("its texture is not laid flat on it".into());
    }
    // How u and v rise along both half axes, and along the outline at most
    let middle = map.at(center);
    let (along_u, along_v) = (map.at(center + axis_u) - middle, map.at(center + axis_v) - middle);
    let rise = DVec2::new(along_u.x, along_v.x);
    let fall = DVec2::new(along_u.y, along_v.y);
    let reach = DVec2::new(rise.length(), fall.length());
    // Turn the axes until the first one is along u alone: the other must be against v
    let Some(turn) = rise.try_normalize() else { return Err("its texture is a line".into()) };
    if fall.dot(turn).abs() > STRAIGHT * reach.y {
        return Err("its texture is sheared".into());
    }
    if fall.perp_dot(turn) < 0.0 {
        return Err("its texture is mirrored".into());
    }
    let turned = LightShape::Disk {
        center,
        axis_u: axis_u * turn.x + axis_v * turn.y,
        axis_v: axis_v * turn.x - axis_u * turn.y,
    };
    let corner = |x: f64, y: f64| middle + reach * DVec2::new(x, y);
    Ok((turned, [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]))
}

/// How much u may rise along the axis of v, over what v does: less than a texel of the largest image.
const STRAIGHT: f64 = 1e-4;

impl Said {
    /// The shape in the world, or why it is none there.
    fn placed(&self, world: &DAffine3) -> Result<LightShape, String> {
        let center = world.translation;
        let [x, y, z] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis];
        match *self {
            Self::Disk { radius } => {
                // A mirror turns the order of the axes around, and not the front
                let (u, v) = if world.matrix3.determinant() < 0.0 { (-z, x) } else { (z, x) };
                Ok(LightShape::Disk { center, axis_u: u * radius, axis_v: v * radius })
            }
            Self::Sphere { radius } if is_rotation_and_scale([x, y, z], 3) => {
                Ok(LightShape::Sphere { center, radius: radius * y.length() })
            }
            Self::Cylinder { radius, height } => tube(world, radius, height, TubeEnds::Flat),
            Self::Pipe { radius, height } => tube(world, radius, height, TubeEnds::Open),
            Self::Capsule { radius, height } if is_rotation_and_scale([x, z, y], 3) => {
                tube(world, radius, height, TubeEnds::Round)
            }
            Self::Sphere { .. } | Self::Capsule { .. } => Err("its node's scale is not uniform".into()),
        }
    }
}

fn tube(world: &DAffine3, radius: f64, height: f64, ends: TubeEnds) -> Result<LightShape, String> {
    let [x, y, z] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis];
    if !is_rotation_and_scale([x, z, y], 2) {
        return Err("its node's scale does not leave it round".into());
    }
    let half = y * (0.5 * height);
    let (p0, p1) = (world.translation - half, world.translation + half);
    Ok(LightShape::Tube { p0, p1, radius: radius * x.length(), ends })
}

/// Whether the axes are perpendicular and the first `equal` of them of one length, to what `f32` transforms
/// are precise to.
fn is_rotation_and_scale(axes: [DVec3; 3], equal: usize) -> bool {
    const TOLERANCE: f64 = 1e-4;
    let lengths = axes.map(DVec3::length);
    let round = lengths[..equal].iter().all(|length| (length - lengths[0]).abs() <= TOLERANCE * lengths[0]);
    let [a, b, c] = axes;
    let right = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(one, other)| one.dot(*other).abs() <= TOLERANCE * one.length() * other.length());
    round && right && lengths.iter().all(|length| *length > 0.0)
}
