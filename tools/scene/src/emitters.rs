//! Emissive geometry to polygon lights.

use crate::closed::closed;
use crate::light_textures::{self, TexturedLight};
use crate::load::Loader;
use crate::meshes::Instance;
use crate::nodes::PlacedNode;
use crate::outlines::{Coordinates, outlines};
use crate::scene::SceneLamp;
use crate::{Scene, shape_lights};
use arealight::{Light, LightShape};
use glam::Vec3;
use std::ops::Range;

/// Adds the lights that a node's mesh is, instance by instance, and says which of the scene's triangles look
/// like each.
pub(crate) fn add(loader: &mut Loader, node: &PlacedNode, mesh: &[Instance]) {
    let closed = closed_parts(&loader.scene, mesh);
    for (instance, closed) in mesh.iter().zip(&closed) {
        let lights = add_instance(loader, node, instance, closed);
        loader.scene.lamps.push(SceneLamp { triangles: instance.drawn.clone(), lights });
    }
}

/// Adds the lights that an instance is, if its material emits: which of the scene's.
fn add_instance(
    loader: &mut Loader,
    node: &PlacedNode,
    instance: &Instance,
    closed: &[bool],
) -> Range<usize> {
    let first = loader.scene.lights.len();
    let material = &loader.scene.materials[instance.material as usize];
    if material.emission == Vec3::ZERO || instance.triangles.is_empty() {
        return first..first;
    }
    if shape_lights::add(loader, node, instance) {
        // The node's shape may have been added for another of its primitives
        return loader.scene.lights.len() - 1..loader.scene.lights.len();
    }
    add_sides(loader, node, instance, closed);
    first..loader.scene.lights.len()
}

/// Which triangles of a mesh's instances are of closed parts, each by itself or together with the others,
/// whatever those are made of. Where alpha makes holes there is no inside, and without an emitter of two
/// sides nobody asks: none.
fn closed_parts(scene: &Scene, mesh: &[Instance]) -> Vec<Vec<bool>> {
    let material = |instance: &Instance| &scene.materials[instance.material as usize];
    let is_whole = |instance: &Instance| material(instance).alpha_cutoff.is_none();
    let mut is_closed: Vec<Vec<bool>> =
        mesh.iter().map(|instance| vec![false; instance.triangles.len()]).collect();
    let emits = |instance: &Instance| material(instance).emission != Vec3::ZERO;
    if !mesh.iter().any(|instance| emits(instance) && material(instance).double_sided) {
        return is_closed;
    }
    let whole = || mesh.iter().enumerate().filter(|(_, instance)| is_whole(instance));
    for (number, instance) in whole() {
        is_closed[number] = closed(&instance.positions, &instance.triangles, instance.rounding);
    }
    // Join what is open by itself
    let mut positions = Vec::new();
    let mut open = Vec::new();
    for (number, instance) in whole().filter(|_| mesh.len() > 1) {
        for (at, triangle) in instance.triangles.iter().enumerate().filter(|(at, _)| !is_closed[number][*at])
        {
            positions.extend(triangle.map(|index| instance.positions[index as usize]));
            open.push((number, at));
        }
    }
    let triangles: Vec<[u32; 3]> = (0..open.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let rounding = mesh.iter().map(|instance| instance.rounding).fold(0.0, f64::max);
    for ((number, at), closed) in open.into_iter().zip(closed(&positions, &triangles, rounding)) {
        is_closed[number][at] = closed;
    }
    is_closed
}

/// Drops the lights that are black, and says which triangles look like the others.
pub(crate) fn finish(loader: &mut Loader) {
    let scene = &mut loader.scene;
    let shines = |light: &Light| light.radiance != Vec3::ZERO;
    // How many lights before each stay
    let mut kept = vec![0];
    kept.extend(scene.lights.iter().scan(0, |count, light| {
        *count += usize::from(shines(light));
        Some(*count)
    }));
    for SceneLamp { triangles, lights } in std::mem::take(&mut scene.lamps) {
        let lights = kept[lights.start]..kept[lights.end];
        if lights.is_empty() {
            continue;
        }
        scene.triangles[triangles.clone()].iter_mut().for_each(|triangle| triangle.lamp = true);
        // A shape of several primitives is one lamp
        match scene.lamps.last_mut() {
            Some(last) if last.lights == lights && last.triangles.end == triangles.start => {
                last.triangles.end = triangles.end;
            }
            _ => scene.lamps.push(SceneLamp { triangles, lights }),
        }
    }
    // A black light lights nothing. None is that shows no texture: its material would not emit
    scene.lights.retain(shines);
}

/// Adds lamps without a triangle for the lights from `first` on, which nothing looks like.
pub(crate) fn add_bare(scene: &mut Scene, first: usize) {
    let bare =
        (first..scene.lights.len()).map(|light| SceneLamp { triangles: 0..0, lights: light..light + 1 });
    scene.lamps.extend(bare);
}

/// Adds an instance's flat parts as lights: those of its closed parts as one-sided ones whatever the material
/// says, for nobody sees their inside.
fn add_sides(loader: &mut Loader, node: &PlacedNode, instance: &Instance, is_closed: &[bool]) {
    let material = &loader.scene.materials[instance.material as usize];
    let (two_sided, masked) = (material.double_sided, material.alpha_cutoff.is_some());
    let place = format!("light '{}' (node {})", instance.name, node.index);
    if masked {
        loader.warn(place.as_str(), "alphaMode MASK: the light shines where the mask is transparent, too");
    }
    if !two_sided {
        add_polygons(loader, &place, instance, &instance.triangles, false);
        return;
    }
    let part = |wanted: bool| -> Vec<[u32; 3]> {
        let of_part = instance.triangles.iter().zip(is_closed).filter(|(_, closed)| **closed == wanted);
        of_part.map(|(triangle, _)| *triangle).collect()
    };
    for (triangles, two_sided) in [(part(true), false), (part(false), true)] {
        if triangles.is_empty() {
            continue;
        }
        if !two_sided {
            loader.note(place.as_str(), "doubleSided, but a closed surface: it shines outwards only");
        }
        add_polygons(loader, &place, instance, &triangles, two_sided);
    }
}

/// Adds the flat parts of some of an instance's triangles as lights.
fn add_polygons(
    loader: &mut Loader,
    place: &str,
    instance: &Instance,
    triangles: &[[u32; 3]],
    two_sided: bool,
) {
    let material = &loader.scene.materials[instance.material as usize];
    let (radiance, texture) = (material.emission, material.emission_texture);
    // Merge what is flat, and mapped alike
    let coordinates = texture.map(|texture| Coordinates {
        uvs: instance.uvs,
        tolerance: light_textures::tolerance(&loader.scene, texture),
    });
    let outlines = outlines(&instance.positions, triangles, instance.rounding, coordinates);
    let Some(texture) = texture else {
        // One light of one colour, of as many faces as there are flat parts
        let mut shape = LightShape::default();
        match &outlines.polygons[..] {
            [outline] => shape = LightShape::Polygon(outline.clone()),
            polygons => polygons.iter().for_each(|outline| shape.add_face(outline)),
        }
        let name = instance.name.clone();
        push(loader, place, Light { name, radiance, two_sided, shape, ..Light::default() });
        return;
    };
    // An image lies on one plane: each straight part is a light of its own
    let count = outlines.polygons.len();
    if outlines.bent {
        let text =
            format!("its texture is on a surface that is not flat: {count} polygon lights, one a flat part");
        loader.warn(place, text);
    }
    if outlines.seams && !outlines.bent {
        let text = format!("its texture has seams or bends: {count} polygon lights, one a straight part");
        loader.warn(place, text);
    }
    if outlines.split > 0 {
        let text = format!("touches itself: {} more polygon lights make it up", outlines.split);
        loader.warn(place, text);
    }
    let surface = loader.scene.lights.len();
    let mut uvs = outlines.uvs.into_iter();
    for (number, vertices) in outlines.polygons.into_iter().enumerate() {
        let uvs = uvs.next().unwrap_or_default();
        let name =
            if count == 1 { instance.name.clone() } else { format!("{}#{}", instance.name, number + 1) };
        let shape = LightShape::Polygon(vertices);
        let light = Light { name, radiance, two_sided, shape, ..Light::default() };
        if push(loader, place, light) {
            let owner = loader.scene.lights.len() - 1;
            loader.textured.push(TexturedLight { owner, surface, texture, uvs });
        }
    }
}

/// Adds a light; false where it cannot be shaded.
fn push(loader: &mut Loader, place: &str, light: Light) -> bool {
    match light.validate() {
        Ok(()) => loader.scene.lights.push(light),
        Err(problem) => {
            loader.warn(place, format!("{problem}: left out"));
            return false;
        }
    }
    true
}
