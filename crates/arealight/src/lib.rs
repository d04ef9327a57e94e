//! The vocabulary of Arealight: analytic area lights by linearly transformed cosines (LTC).
//!
//! A polygon, a material and a view go in; radiance comes out, with a known error, a known cost, and no
//! noise. This crate says what a light, a table and a kernel *are*; it knows nothing of Vulkan
//! and of files. Every other crate speaks it.
//!
//! # Start here
//! A light, packed as the GPU reads it, with what it needs of a pipeline:
//!
//! ```
//! use arealight::glam::{DVec3, Vec3};
//! use arealight::{Effects, Light, LightShape, PackedLights};
//!
//! // Counter-clockwise from the front, which is below: a lamp over the floor
//! let corners = [[-1.0, 2.0, -0.5], [1.0, 2.0, -0.5], [1.0, 2.0, 0.5], [-1.0, 2.0, 0.5]];
//! let lamp = Light {
//!     name: "lamp".into(),
//!     radiance: Vec3::new(8.0, 7.0, 5.0),
//!     shape: LightShape::Polygon(corners.map(DVec3::from).to_vec()),
//!     ..Light::default()
//! };
//! let globe = Light { shape: LightShape::Sphere { center: DVec3::Y, radius: 0.2 }, ..lamp.clone() };
//!
//! let packed = PackedLights::new(&[lamp, globe], DVec3::new(0.0, 1.5, 4.0))?; // relative to a camera there
//! let summary = packed.summary();
//! assert_eq!((summary.light_count, summary.quad_count, summary.shape_count), (1, 1, 1));
//! assert_eq!(summary.effects, Effects::SPHERE);
//! assert_eq!(packed.lights[0].center, [0.0, 0.5, -4.0]);
//! # Ok::<(), arealight::LightError>(())
//! ```
//!
//! Then: record a frame with `arealight-vk`, or from C with `arealight-capi`; the table is
//! [`LightTable::ggx`]. The repository's `docs/embed-rust.md` goes through it from a device to the first
//! light.
//!
//! # Conventions
//! - SI radiometry, linear Rec. 709 colour. A light's radiance is W/(m² sr), constant over a one-sided
//!   emitter whose front is where its vertices run counter-clockwise; a two-sided light lights both.
//! - Right-handed. Matrices are column-major and act on column vectors. Angles are in radians.
//! - `roughness` is perceptual, `alpha = roughness²`. GGX with height-correlated Smith masking-shadowing and
//!   Schlick's Fresnel term.
//! - Shading happens relative to an origin that the host chooses near the camera: world positions are
//!   `f64` here and `f32` relative to that origin on the GPU.
//! - Table axes: roughness, and `sqrt(1 - cos theta_view)`; see [`LightTable`].
//!
//! # Modules
//! | module | holds |
//! |---|---|
//! | [`light`] | lights, of which a host has one list |
//! | [`light_fault`] | what is wrong with a light |
//! | [`light_shape`] | what shines: polygons, meshes, disks, spheres, tubes |
//! | [`holes`] | polygons with holes |
//! | [`mesh`] | several flat faces that are one light |
//! | [`packed_lights`] | the list as the GPU reads it, and what it needs |
//! | [`light_texture`] | textured lights |
//! | [`texture_part`] | which part of an image becomes one |
//! | [`pyramid`] | how large and how blurred the levels of a light's texture are |
//! | [`effects`] | what lights and surfaces need, and nothing else |
//! | [`quality`] | the quality levels |
//! | [`profile`] | how a light's radiance changes with the angle from its front |
//! | [`opening`] | windows, doors and grids that lights are seen through |
//! | [`ies`] | luminaires of LM-63 files, as profiles |
//! | [`reach`] | how far from a light it is of any matter |
//! | [`blockers`] | what blocks light, for shadow rays: triangles in a hierarchy |
//! | [`table`] | the fitted table, with a float64 twin of the shader's lookup |
//! | [`gpu`] | data laid out as the GPU reads it |
//! | [`kernels`] | the embedded SPIR-V with bindings, constants and group sizes |
//! | [`planes`] | what a pass reads of each pixel |
//! | [`tiles`] | tiles of a picture, sorted by the lights that matter to them |
//! | [`plan`] | which kernel runs, specialised how, over how many groups |

#![forbid(unsafe_code)]

mod azimuth;
pub mod blockers;
pub mod effects;
mod face_clusters;
pub mod gpu;
mod grid;
pub mod holes;
pub mod ies;
pub mod kernels;
pub mod light;
pub mod light_fault;
pub mod light_shape;
pub mod light_texture;
pub mod mesh;
pub mod opening;
mod output;
pub mod packed_lights;
pub mod plan;
pub mod planes;
pub mod profile;
pub mod pyramid;
pub mod quality;
pub mod reach;
pub mod table;
mod texture_error;
pub mod texture_part;
pub mod tiles;

#[doc(inline)]
pub use blockers::{BlockerError, Blockers};
#[doc(inline)]
pub use effects::Effects;
#[doc(inline)]
pub use face_clusters::FaceClusters;
/// The vectors and matrices that lights and frames are made of, so that a host needs no version of its own to
/// agree.
pub use glam;
#[doc(inline)]
pub use ies::{IesError, IesProfile};
#[doc(inline)]
pub use light::Light;
#[doc(inline)]
pub use light_fault::{LightError, LightFault};
#[doc(inline)]
pub use light_shape::{LightShape, TubeEnds};
#[doc(inline)]
pub use light_texture::{LightTexture, TextureMap};
#[doc(inline)]
pub use opening::Opening;
#[doc(inline)]
pub use packed_lights::{LightSummary, PackedLights};
#[doc(inline)]
pub use planes::{Plane, Planes};
#[doc(inline)]
pub use profile::Profile;
#[doc(inline)]
pub use pyramid::PyramidSize;
#[doc(inline)]
pub use quality::{Footprint, Horizon, Level, Lobes, Quality, SpecularLobes};
#[doc(inline)]
pub use table::{LightTable, TableDescription, TableError, TableSample};
#[doc(inline)]
pub use texture_error::TextureError;
#[doc(inline)]
pub use texture_part::{TexturePart, Wrap};
#[doc(inline)]
pub use tiles::TileClass;

/// The smallest GGX alpha that is shaded; smaller ones are raised to it.
///
/// At 1e-4 a lobe is 0.01 degrees wide, narrower than a pixel of any camera, and float32 directions resolve
/// it into a thousand steps; nothing narrower is tested.
pub const MIN_ALPHA: f64 = 1e-4;
