//! Shadows over frames: a still picture loses its noise, a moved camera finds its pixels again, and what changes is not dragged along.

use arealight::Effects;
use arealight::plan::{ShadeOptions, ShadowFilter, ShadowHistory};
use arealight_engine::{SceneRenderer, ShadowedView};
use arealight_scene::{Camera, Scene, SceneBuffers};
use arealight_tests::TestEngine;
use arealight_tests::scenes;
use glam::{DVec3, Vec3};

const SIZE: [u32; 2] = [96, 64];
