//! The scan that says which effects a scene needs.

use crate::scene::{Scene, SceneMaterial};
use arealight::Effects;
use arealight_oracle::material::Material;
use glam::Vec3;

/// An effect, and who in the scene needs it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RequiredEffect {
    /// One effect.
    pub effect: Effects,
    /// The first light or material that needs it, and how many more do, such as "light 'sign' and 2 more".
    pub reason: String,
}

impl std::fmt::Display for RequiredEffect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.effect, self.reason)
    }
}

/// Whether a material needs an effect.
type Needs = fn(&SceneMaterial) -> bool;

/// What materials may need, and how it is known.
const OF_MATERIALS: [(Effects, Needs); 11] = [
    (Effects::DIFFUSE, has_diffuse_lobe),
    (Effects::GLOSSY, has_glossy_lobe),
    (Effects::SPECULAR_INPUT, has_specular_input),
    (Effects::COAT, has_coat),
    (Effects::COAT_NORMAL, has_coat_normal),
    (Effects::COUPLED, is_coupled),
    (Effects::SHEEN, has_sheen),
    (Effects::ANISOTROPY, has_anisotropy),
    (Effects::TRANSMISSION, has_transmission),
    (Effects::THIN_FILM, has_film),
    (Effects::GLASS, has_pane),
];

/// What a scene needs and nothing else, each effect once, with its reason, in the order of their bits.
/// [`Scene::effects`] is their union.
pub fn required_effects(scene: &Scene) -> Vec<RequiredEffect> {
    // What is not lit reflects nothing, which has to be said where other surfaces reflect
    let is_glossy = scene.materials.iter().any(|m| !m.unlit && has_glossy_lobe(m));
    let reason = |effect| {
        let is_asked = |m: &SceneMaterial| !m.unlit || (is_glossy && effect == Effects::SPECULAR_INPUT);
        // Only materials that something has been made of are in a scene
        if let Some((_, needs)) = OF_MATERIALS.into_iter().find(|(of_materials, _)| *of_materials == effect) {
            let needing = scene.materials.iter().filter(|m| needs(m) && is_asked(m));
            return names("material", needing.map(|m| &*m.name));
        }
        names("light", scene.lights.iter().filter(|l| l.effects().contains(effect)).map(|l| &*l.name))
    };
    let effects = Effects::all().iter();
    effects.filter_map(|effect| Some(RequiredEffect { effect, reason: reason(effect)? })).collect()
}

/// The first of those that need an effect, and how many more do; `None` without any.
fn names<'a>(kind: &str, mut needing: impl Iterator<Item = &'a str>) -> Option<String> {
    let first = needing.next()?;
    Some(match needing.count() {
        0 => format!("{kind} '{first}'"),
        more => format!("{kind} '{first}' and {more} more"),
    })
}

impl SceneMaterial {
    /// What shading it needs.
    pub fn effects(&self) -> Effects {
        OF_MATERIALS.into_iter().filter(|(_, needs)| needs(self)).map(|(effect, _)| effect).collect()
    }
}

impl Scene {
    /// The union of [`required_effects`].
    pub fn effects(&self) -> Effects {
        required_effects(self).iter().map(|one| one.effect).collect()
    }

    /// Of those what a pass has to handle of surfaces: it has a lobe also for a scene without one.
    pub fn surfaces(&self) -> Effects {
        let required = self.effects() & Effects::SURFACES;
        if required.is_empty() { Effects::DIFFUSE } else { required }
    }
}

/// Textures multiply: a metalness texture can make any metal a dielectric somewhere.
fn is_dielectric_somewhere(material: &SceneMaterial) -> bool {
    material.material.metalness < 1.0 || material.metallic_roughness_texture.is_some()
}

fn has_diffuse_lobe(material: &SceneMaterial) -> bool {
    is_dielectric_somewhere(material) && material.material.base_color != Vec3::ZERO
}

fn has_glossy_lobe(material: &SceneMaterial) -> bool {
    let reflects = material.material.dielectric_f0 != Vec3::ZERO || material.material.dielectric_f90 > 0.0;
    // A metal's reflectance at grazing incidence is one, whatever its colour
    material.material.metalness > 0.0 || reflects || has_film(material)
}

fn has_specular_input(material: &SceneMaterial) -> bool {
    // 1e-6: an index of 1.5, computed in f32, must count as 0.04
    let usual = (material.material.dielectric_f0 - Vec3::splat(0.04)).abs().max_element() < 1e-6
        && material.material.dielectric_f90 == 1.0;
    let textured = material.specular_texture.is_some() || material.specular_color_texture.is_some();
    is_dielectric_somewhere(material) && (!usual || textured)
}

fn has_coat(material: &SceneMaterial) -> bool {
    material.material.coat > 0.0
}

fn has_sheen(material: &SceneMaterial) -> bool {
    material.material.sheen_color != Vec3::ZERO
}

fn has_anisotropy(material: &SceneMaterial) -> bool {
    material.anisotropy_strength > 0.0 && has_glossy_lobe(material)
}

fn has_film(material: &SceneMaterial) -> bool {
    material.material.film.is_some()
}

fn has_transmission(material: &SceneMaterial) -> bool {
    let Material { transmission, transmission_color, .. } = material.material;
    is_dielectric_somewhere(material) && transmission > 0.0 && transmission_color != Vec3::ZERO
}

fn has_pane(material: &SceneMaterial) -> bool {
    material.material.glass > 0.0 && has_diffuse_lobe(material)
}

/// glTF couples the diffuse lobe of a dielectric with its Fresnel term, where it has one.
fn is_coupled(material: &SceneMaterial) -> bool {
    let Material { dielectric_f0, dielectric_f90, film, .. } = material.material;
    let is_diffuse = has_diffuse_lobe(material) || has_transmission(material);
    is_diffuse && (dielectric_f0 != Vec3::ZERO || dielectric_f90 > 0.0 || film.is_some())
}

/// A coat has the geometry's normal, unless it has a texture, and the base may be bent by one.
fn has_coat_normal(material: &SceneMaterial) -> bool {
    let coat = material.coat_normal_texture.map(|texture| (texture, material.coat_normal_scale));
    let base = material.normal_texture.map(|texture| (texture, material.normal_scale));
    has_coat(material) && coat != base
}
