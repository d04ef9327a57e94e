//! Lights on their way to the render world.

use crate::AreaLight;
use crate::images::MOST_IMAGES;
use arealight::Light;
use bevy::camera::visibility::RenderLayers;
use bevy::ecs::entity::EntityHashSet;
use bevy::prelude::*;
use bevy::render::Extract;

/// The visible lights of a frame.
#[derive(Resource, Default)]
pub(crate) struct ExtractedLights {
    /// In world space, each with the layers of cameras that see what it lights.
    pub lights: Vec<(Light, RenderLayers)>,
    /// The images on them, in the order of the layers of their textures.
    pub images: Vec<AssetId<Image>>,
}

impl ExtractedLights {
    /// The number of an image. A warning says that there are too many, once.
    fn image(&mut self, image: &Handle<Image>) -> Option<u32> {
        let found = self.images.iter().position(|id| *id == image.id());
        if found.is_none() && self.images.len() == MOST_IMAGES {
            warn_once!("area lights of more than {MOST_IMAGES} images: those of the others are left out");
            return None;
        }
        Some(found.unwrap_or_else(|| {
            self.images.push(image.id());
            self.images.len() - 1
        }) as u32)
    }
}

type Lit<'a> = (
    Entity,
    &'a AreaLight,
    &'a GlobalTransform,
    &'a InheritedVisibility,
    Option<&'a RenderLayers>,
    Option<&'a Name>,
);

/// Takes the lights that can be shaded; a warning names each of the others, once until it is
/// mended.
pub(crate) fn extract(
    lights: Extract<Query<Lit>>,
    mut extracted: ResMut<ExtractedLights>,
    mut warned: Local<EntityHashSet>,
) {
    extracted.lights.clear();
    extracted.images.clear();
    for (entity, light, transform, visibility, layers, name) in &lights {
        if !visibility.get() {
            continue;
        }
        let name = name.map_or_else(|| entity.to_string(), ToString::to_string);
        let image = light.image.as_ref().map(|image| extracted.image(image));
        if image == Some(None) {
            continue;
        }
        let Some(light) = light.in_world(name, transform, image.flatten()) else { continue };
        match light.validate() {
            Ok(()) => {
                warned.remove(&entity);
                extracted.lights.push((light, layers.cloned().unwrap_or_default()));
            }
            Err(fault) if warned.insert(entity) => {
                warn!("the area light '{}' is left out: {fault}", light.name);
            }
            Err(_) => {}
        }
    }
}
