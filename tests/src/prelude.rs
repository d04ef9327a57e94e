//! What several of the GPU tests name.

pub use crate::floor::{Floor, lamps, pixels};
pub use crate::frame::{reflected, reflected_by_tiles, scene, with_renderer, with_view};
pub use crate::materials::{TABLE, lobe_qualities, polygon_twin, under_polygon, under_shapes};
pub use crate::one_pixel::{BEFORE, OnePixel, lamp, material};
pub use crate::pass::{LightBuffers, field, image, planes, radiance, read, reads, store, stored_in};
pub use crate::scenes::{box_of, lambert, quad_light, scene_of, square, without_textures};
pub use crate::{
    Cases, Comparison, Level, Random, TestEngine, glossy_surface, lambert_surface, point, rounding,
};
pub use arealight::plan::{GBufferLayout, Output, ShadeOptions, ShadowFilter, ShadowHistory, TileOptions};
pub use arealight::{
    Effects, Footprint, Horizon, Light, LightShape, LightSummary, LightTable, LightTexture, Lobes,
    PackedLights, Plane, Planes, PyramidSize, Quality, SpecularLobes, TexturePart, TubeEnds,
};
pub use arealight_engine::host::{Image, ImageDescription, Usage};
pub use arealight_engine::{EvalPoint, Reference, SceneRenderer, SourceImage, SourceTexels};
pub use arealight_oracle::material::{Coat, Material, Surface};
pub use arealight_oracle::shading::{RelativeLight, ltc, ltc_on};
pub use arealight_oracle::texture::Texture;
pub use arealight_scene::{Camera, Scene, SceneBuffers};
pub use arealight_vk::{
    Descriptors, Error, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources, TableFormat,
};
pub use ash::vk;
pub use glam::{DMat3, DQuat, DVec2, DVec3, Vec3, Vec4};
pub use std::f64::consts::TAU;
pub use std::sync::Arc;
