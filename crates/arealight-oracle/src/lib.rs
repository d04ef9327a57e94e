//! Float64 truth for area lights: BRDFs, closed-form integrals and cubature. For tests, fitting and
//! benchmarks; nothing here is fast enough for a frame.
//!
//! # Start here
//! The light of a lamp on a glossy floor, by cubature of the true BRDF and by the fitted table:
//!
//! ```
//! use arealight::glam::{DVec3, Vec3};
//! use arealight::{Light, LightShape};
//! use arealight_oracle::cubature::Settings;
//! use arealight_oracle::material::Material;
//! use arealight_oracle::shading::{RelativeLight, ltc, truth};
//!
//! let corners = [[-1.0, -1.0, 2.0], [-1.0, 1.0, 2.0], [1.0, 1.0, 2.0], [1.0, -1.0, 2.0]];
//! let shape = LightShape::Polygon(corners.map(DVec3::from).to_vec());
//! let lamp = Light { radiance: Vec3::ONE, shape, ..Light::default() };
//! let light = RelativeLight::new(&lamp, DVec3::ZERO);
//! let floor = Material { roughness: 0.4, ..Material::default() }.surface();
//! let view = DVec3::new(0.6, 0.0, 0.8);
//!
//! let truth = truth(&floor, DVec3::Z, view, &light, &Settings::default());
//! let fitted = ltc(&arealight::LightTable::ggx(), &floor, DVec3::Z, view, &light);
//! assert!((fitted - truth.radiance).abs().max_element() < 0.01);
//! ```
//!
//! # Conventions
//! Everything happens in the *surface frame* unless a name says otherwise: the shading point is the origin,
//! z is the normal, and the view direction lies in the xz plane with x not negative.
//!
//! | module | holds |
//! |---|---|
//! | [`frame`] | the surface frame of a normal and a view |
//! | [`formula`] | the lobes by formulas, in the place of the table |
//! | [`microsurface`] | random walks on a GGX microsurface: light that facets reflect more than once |
//! | [`material`] | metallic-roughness materials, and the surface that they make |
//! | [`ggx`] | the GGX lobe: evaluation, sampling, density |
//! | [`thin_film`] | iridescent films, and the Schlick term that stands for them |
//! | [`sheen`] | the Charlie lobe of sheen, and the transformed cosine that stands for it |
//! | [`phase`] | Henyey and Greenstein's phase function, and the lobes that stand for it |
//! | [`ltsd`] | linearly transformed spherical distributions in general |
//! | [`polygon`] | the clamped cosine, and its linear transforms, integrated over a polygon in closed form |
//! | [`ellipse`] | the clamped cosine over an ellipse, which is a disk light, in closed form and by quadrature |
//! | [`sphere`] | the clamped cosine over a sphere |
//! | [`tube`] | the clamped cosine over a tube or capsule, by its silhouette |
//! | [`cubature`] | any integrand over a polygon, adaptively: the independent method |
//! | [`shading`] | a polygon light on a surface: the truth by cubature, and the LTC answer |
//! | [`texture`] | what a textured light shows, its blur, and the prefilter's pyramid |
//! | [`visibility`] | what is visible of a flat light behind triangles |
//! | [`stream`] | random numbers, the same on every machine |

#![forbid(unsafe_code)]

pub mod cubature;
pub mod ellipse;
pub mod formula;
pub mod frame;
pub mod ggx;
pub mod ltsd;
pub mod material;
pub mod microsurface;
pub mod phase;
pub mod polygon;
pub mod shading;
pub mod sheen;
pub mod sphere;
pub mod stream;
pub mod texture;
pub mod thin_film;
pub mod tube;
pub mod visibility;
