//! Emissive geometry to polygon lights.

use crate::images;
use crate::load::Loader;
use crate::meshes::Instance;
use crate::nodes::PlacedNode;
use crate::outlines::outlines;
use arealight::PolygonLight;
use glam::Vec3;

/// Adds the lights that an instance is, if its material emits.
pub(crate) fn add(loader: &mut Loader, node: &PlacedNode, instance: &Instance) {
    let material = &loader.scene.materials[instance.material as usize];
    if material.emission == Vec3::ZERO || instance.triangles.is_empty() {
        return;
    }
    let (two_sided, masked) = (material.double_sided, material.alpha_cutoff.is_some());
    let place = format!("light '{}' (node {})", instance.name, node.index);
    // A texture lights by its mean
    let mut radiance = material.emission;
    if let Some(texture) = material.emission_texture {
        let image = &loader.scene.images[loader.scene.textures[texture as usize].image as usize];
        radiance *= images::linear_mean(image);
        loader.warn(place.as_str(), "emissiveTexture: the light has the texture's mean colour everywhere");
        if radiance == Vec3::ZERO {
            return;
        }
    }
    if masked {
        loader.warn(place.as_str(), "alphaMode MASK: the light shines where the mask is transparent, too");
    }
    // Merge what is flat
    let outlines = outlines(&instance.positions, &instance.triangles, instance.rounding);
    let count = outlines.polygons.len();
    if outlines.bent {
        loader.warn(place.as_str(), format!("is not flat: {count} polygon lights, one a flat part"));
    }
    if outlines.split > 0 {
        let text = format!("has holes or touches itself: {} more polygon lights make it up", outlines.split);
        loader.warn(place.as_str(), text);
    }
    for (number, vertices) in outlines.polygons.into_iter().enumerate() {
        let name =
            if count == 1 { instance.name.clone() } else { format!("{}#{}", instance.name, number + 1) };
        let light = PolygonLight { name, vertices, radiance, two_sided, texture: None };
        match light.validate() {
            Ok(()) => loader.scene.lights.push(light),
            Err(problem) => loader.warn(place.as_str(), format!("{problem}: left out")),
        }
    }
}
