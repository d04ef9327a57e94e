//! Emissive meshes that stand for a disk, a sphere or a tube, by a word in their node's `extras`.

use crate::load::Loader;
use crate::meshes::Instance;
use crate::nodes::PlacedNode;
use arealight::{Shape, ShapeLight, TubeEnds};
use glam::{DAffine3, DVec3};
use serde::Deserialize;
use serde_json::Value;

/// What `extras.arealight` of a node says: in the node's space, about its origin and its Y axis.
#[derive(Deserialize)]
#[serde(tag = "shape", rename_all = "lowercase", deny_unknown_fields)]
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

/// The word in a node's `extras`, if there is one.
pub(crate) fn said(extras: &gltf::json::Extras) -> Option<Value> {
    let extras: Value = serde_json::from_str(extras.as_ref()?.get()).ok()?;
    extras.get("arealight").cloned()
}

/// Adds the shape that a node's word says its emissive mesh is; false where there is no such word, or none that holds, and the
/// mesh is what it is.
pub(crate) fn add(loader: &mut Loader, node: &PlacedNode, instance: &Instance) -> bool {
    let Some(said) = &node.shape else { return false };
    let place = format!("light '{}' (node {})", instance.name, node.index);
    let material = &loader.scene.materials[instance.material as usize];
    let radiance = material.emission;
    // A mesh of several materials is several primitives, and one light
    if let Some((index, shone)) = loader.shaped.filter(|(index, _)| *index == node.index) {
        if shone != radiance {
            loader.warn(place, format!("node {index} shines with the emission of its first primitive"));
        }
        return true;
    }
    let (double_sided, textured) = (material.double_sided, material.emission_texture.is_some());
    let shape = Said::deserialize(said).map_err(|error| error.to_string());
    let shape = shape.and_then(|said| said.placed(&node.world)).and_then(|shape| {
        // Solids shine outwards, whatever their material says
        let two_sided = double_sided && matches!(shape, Shape::Ellipse { .. });
        let light = ShapeLight { name: instance.name.clone(), radiance, two_sided, shape };
        light.validate().map(|()| light).map_err(|error| error.to_string())
    });
    match shape {
        Ok(light) => {
            if textured {
                loader.warn(place, "its texture is not shown in what it lights: a shape has one colour");
            }
            loader.shaped = Some((node.index, radiance));
            loader.scene.shapes.push(light);
            true
        }
        Err(problem) => {
            loader.warn(place, format!("extras.arealight: {problem}: the mesh's own polygons shine"));
            false
        }
    }
}

impl Said {
    /// The shape in the world, or why it is none there.
    fn placed(&self, world: &DAffine3) -> Result<Shape, String> {
        let center = world.translation;
        let [x, y, z] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis];
        match *self {
            Self::Disk { radius } => {
                // A mirror turns the order of the axes around, and not the front
                let (u, v) = if world.matrix3.determinant() < 0.0 { (x, z) } else { (z, x) };
                Ok(Shape::Ellipse { center, axis_u: u * radius, axis_v: v * radius })
            }
            Self::Sphere { radius } if is_rotation_and_scale([x, y, z], 3) => {
                Ok(Shape::Sphere { center, radius: radius * y.length() })
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

fn tube(world: &DAffine3, radius: f64, height: f64, ends: TubeEnds) -> Result<Shape, String> {
    let [x, y, z] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis];
    if !is_rotation_and_scale([x, z, y], 2) {
        return Err("its node's scale does not leave it round".into());
    }
    let half = y * (0.5 * height);
    let (p0, p1) = (world.translation - half, world.translation + half);
    Ok(Shape::Tube { p0, p1, radius: radius * x.length(), ends })
}

/// Whether the axes are perpendicular and the first `equal` of them of one length, to what `f32` transforms are precise to.
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
