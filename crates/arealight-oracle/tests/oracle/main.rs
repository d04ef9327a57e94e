//! Properties of the oracle, and its parts against each other and against the reference.

mod article;
mod coat;
mod common;
mod coupled;
mod ellipse;
mod ggx;
mod half_vectors;
mod ltsd;
mod microsurface;
mod polygon;
mod shading;
mod sheen;
mod sphere;
mod textured;
mod thin_film;
mod tube;
