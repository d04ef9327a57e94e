//! Emissive geometry to polygon lights.

use crate::closed::closed;
use crate::materials::Materials;
use crate::meshes::Instance;
use crate::messages::Messages;
use crate::nodes::PlacedNode;
use crate::outlines::{Coordinates, outlines};
use crate::scene::{SceneLamp, SceneMaterial};
use crate::shape_lights;
use crate::shaping::Said;
use crate::shown::{self, TexturedLight};
use arealight::{Light, LightShape};
use glam::Vec3;
use std::ops::Range;

/// The error of clusters of a mesh's faces: pictures err by a tenth of that.
const CLUSTERS: f64 = 0.05;

/// The lights that meshes are.
#[derive(Default)]
pub(crate) struct Emitters {
    pub lights: Vec<Light>,
    /// Which of the scene's triangles look like which lights.
    pub lamps: Vec<SceneLamp>,
    /// The lights that a texture shines through.
    pub textured: Vec<TexturedLight>,
    /// The [`PlacedNode::number`] whose mesh was last found to stand for a shape, and what it shines with.
    shaped: Option<(usize, Vec3)>,
}

/// What an instance's lights are made of.
struct Source<'a> {
    node: &'a PlacedNode,
    instance: &'a Instance<'a>,
    material: &'a SceneMaterial,
    materials: &'a Materials,
    /// What messages call it.
    place: String,
}

impl Emitters {
    /// Adds the lights that a node's mesh is, instance by instance, and says which of the scene's triangles
    /// look like each.
    pub fn add(
        &mut self,
        node: &PlacedNode,
        mesh: &[Instance],
        materials: &Materials,
        messages: &mut Messages,
    ) {
        let closed = closed_parts(&materials.list, mesh);
        for (instance, closed) in mesh.iter().zip(&closed) {
            let material = &materials.list[instance.material as usize];
            let place = format!("light '{}' (node {})", instance.name, node.index);
            let source = Source { node, instance, material, materials, place };
            let lights = self.add_instance(&source, closed, messages);
            self.lamps.push(SceneLamp { triangles: instance.drawn.clone(), lights });
        }
    }

    /// Adds the lights that an instance is, if its material emits: which of the lights.
    fn add_instance(&mut self, source: &Source, is_closed: &[bool], messages: &mut Messages) -> Range<usize> {
        let first = self.lights.len();
        let &Source { node, instance, material, materials, .. } = source;
        let radiance = material.emission;
        if radiance == Vec3::ZERO || instance.triangles.is_empty() {
            return first..first;
        }
        // A mesh of several materials is several primitives, and one light
        if let Some((_, shone)) = self.shaped.filter(|(number, _)| *number == node.number) {
            if shone != radiance {
                let text = format!("node {} shines with the emission of its first primitive", node.index);
                messages.warn(source.place.as_str(), text);
            }
            return first - 1..first;
        }
        match shape_lights::light(node, instance, material, &materials.textures, messages) {
            Some((light, image)) => {
                let textured = |(texture, uvs): (u32, [_; 4])| TexturedLight {
                    owner: first,
                    surface: first,
                    texture,
                    uvs: uvs.into(),
                };
                self.textured.extend(image.map(textured));
                self.shaped = Some((node.number, radiance));
                self.lights.push(light);
            }
            None => self.add_sides(source, is_closed, messages),
        }
        first..self.lights.len()
    }

    /// Adds an instance's flat parts as lights: those of its closed parts as one-sided ones whatever the
    /// material says, for nobody sees their inside.
    fn add_sides(&mut self, source: &Source, is_closed: &[bool], messages: &mut Messages) {
        let &Source { instance, material, .. } = source;
        let place = source.place.as_str();
        if material.alpha_cutoff.is_some() {
            messages.warn(place, "alphaMode MASK: the light shines where the mask is transparent, too");
        }
        if !material.double_sided {
            self.add_polygons(source, &instance.triangles, false, messages);
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
                messages.note(place, "doubleSided, but closed up to small holes: it shines outwards only");
            }
            self.add_polygons(source, &triangles, two_sided, messages);
        }
    }

    /// Adds the flat parts of some of an instance's triangles as lights.
    fn add_polygons(
        &mut self,
        source: &Source,
        triangles: &[[u32; 3]],
        two_sided: bool,
        messages: &mut Messages,
    ) {
        let &Source { instance, material, materials, .. } = source;
        let place = source.place.as_str();
        let (radiance, texture) = (material.emission, material.emission_texture);
        // Merge what is flat, and mapped alike
        let coordinates = texture.map(|texture| Coordinates {
            uvs: instance.uvs,
            tolerance: shown::tolerance(&materials.textures, texture),
        });
        let outlines = outlines(&instance.positions, triangles, instance.rounding, coordinates);
        let Some(texture) = texture else {
            // One light of one colour, of as many faces as there are flat parts
            let mut shape = LightShape::default();
            match &outlines.polygons[..] {
                [outline] => shape = LightShape::Polygon(outline.clone()),
                polygons => polygons.iter().for_each(|outline| shape.add_face(outline)),
            }
            let shape = shape.clustered(CLUSTERS);
            let name = instance.name.clone();
            self.push(source, Light { name, radiance, two_sided, shape, ..Light::default() }, messages);
            return;
        };
        // An image lies on one plane: each straight part is a light of its own
        let count = outlines.polygons.len();
        if outlines.bent {
            let text = format!(
                "its texture is on a surface that is not flat: {count} polygon lights, one a flat part"
            );
            messages.warn(place, text);
        }
        if outlines.seams && !outlines.bent {
            let text = format!("its texture has seams or bends: {count} polygon lights, one a straight part");
            messages.warn(place, text);
        }
        if outlines.split > 0 {
            let text = format!("touches itself: {} more polygon lights make it up", outlines.split);
            messages.warn(place, text);
        }
        let surface = self.lights.len();
        let mut uvs = outlines.uvs.into_iter();
        for (number, vertices) in outlines.polygons.into_iter().enumerate() {
            let uvs = uvs.next().unwrap_or_default();
            let name =
                if count == 1 { instance.name.clone() } else { format!("{}#{}", instance.name, number + 1) };
            let shape = LightShape::Polygon(vertices);
            let light = Light { name, radiance, two_sided, shape, ..Light::default() };
            if self.push(source, light, messages) {
                let owner = self.lights.len() - 1;
                self.textured.push(TexturedLight { owner, surface, texture, uvs });
            }
        }
    }

    /// Adds a light as it is seen; false where it cannot be shaded.
    fn push(&mut self, source: &Source, light: Light, messages: &mut Messages) -> bool {
        let said = source.node.shape.as_ref().filter(|said| Said::is_said(said));
        let said = said.map_or(Ok(Said::default()), Said::new);
        match said.and_then(|said| said.shape(light, source.node)) {
            Ok(lights) if lights.len() > 1 && source.material.emission_texture.is_some() => {
                messages.warn(source.place.as_str(), "a grid is before an image: left out");
                return false;
            }
            Ok(lights) => self.lights.extend(lights),
            Err(problem) => {
                messages.warn(source.place.as_str(), format!("{problem}: left out"));
                return false;
            }
        }
        true
    }

    /// Drops the lights that are black.
    pub fn finish(&mut self) {
        let shines = |light: &Light| light.radiance != Vec3::ZERO;
        // How many lights before each stay
        let mut kept = vec![0];
        kept.extend(self.lights.iter().scan(0, |count, light| {
            *count += usize::from(shines(light));
            Some(*count)
        }));
        for SceneLamp { triangles: drawn, lights } in std::mem::take(&mut self.lamps) {
            let lights = kept[lights.start]..kept[lights.end];
            if lights.is_empty() {
                continue;
            }
            // A shape of several primitives is one lamp
            match self.lamps.last_mut() {
                Some(last) if last.lights == lights && last.triangles.end == drawn.start => {
                    last.triangles.end = drawn.end;
                }
                _ => self.lamps.push(SceneLamp { triangles: drawn, lights }),
            }
        }
        // A black light lights nothing. None is that shows no texture: its material would not emit
        self.lights.retain(shines);
    }
}

/// Which triangles of a mesh's instances are of closed parts, each by itself or together with the others,
/// whatever those are made of. Where alpha makes holes there is no inside, and without an emitter of two
/// sides nobody asks: none.
fn closed_parts(materials: &[SceneMaterial], mesh: &[Instance]) -> Vec<Vec<bool>> {
    let material = |instance: &Instance| &materials[instance.material as usize];
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
