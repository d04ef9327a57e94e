//! What most of the GPU tests name.

pub use crate::floor::Floor;
pub use crate::frame::{with_renderer, with_view};
pub use crate::materials::under_polygon;
pub use crate::one_pixel::{BEFORE, OnePixel, lamp};
pub use crate::scenes::{lambert, scene_of, without_textures};
pub use crate::{
    Cases, Comparison, Level, Random, TestEngine, glossy_surface, lambert_surface, point, rounding,
};
pub use arealight::plan::{GBufferLayout, Output, ShadeOptions, ShadowFilter, ShadowHistory, TileOptions};
pub use arealight::{
    Effects, Footprint, FormFactor, Horizon, Light, LightShape, LightSummary, LightTable, LightTexture,
    Lobes, PackedLights, Plane, Planes, PyramidSize, Quality, SpecularLobes, TexturePart, TubeEnds,
};
pub use arealight_engine::host::{Image, ImageDescription, Usage};
pub use arealight_engine::{EvalPoint, Reference, SceneRenderer};
pub use arealight_oracle::material::{Coat, Material, Surface};
pub use arealight_oracle::shading::RelativeLight;
pub use arealight_oracle::texture::Texture;
pub use arealight_scene::{Camera, Scene, SceneBuffers};
pub use arealight_vk::{Descriptors, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources};
pub use ash::vk;
pub use glam::{DMat3, DQuat, DVec2, DVec3, Vec3, Vec4};
