//! The GPU against the oracle, through compute dispatches; and what Rust, the GLSL and the SPIR-V must state alike.
//!
//! One binary, since each links the engine and the oracle. A test's name begins with its module: `tiles::…`.

mod arcs;
mod bits;
mod blockers;
mod c_api;
mod c_pictures;
mod coat;
mod coat_tiles;
mod constants;
mod cpp_host;
mod effects;
mod footprints;
mod frame;
mod g_buffer;
mod guard;
mod host_mistakes;
mod light_textures;
mod manifest;
mod meshes;
mod modules;
mod output;
mod paths;
mod polygon_sampling;
mod probe;
mod properties;
mod prune;
mod pyramid;
mod recorder;
mod resize;
mod shading;
mod shadow_rays;
mod shadows;
mod shape_frames;
mod shape_lights;
mod shape_points;
mod shape_properties;
mod shapes;
mod stability;
mod surfaces;
mod sweep;
mod textured;
mod textured_disks;
mod textures;
mod tiles;
mod tubes;
