//! What kernels say of themselves is what another reader finds in their modules; every offset of every
//! structure that the CPU writes; what pruned modules bind.

use arealight::TileClass;
use arealight::kernels::{self, Access, Binding, BindingKind, Kernel, constant};
use arealight::plan::{shade_specialization, shade_tiles_specialization};
use arealight_tests::prelude::*;
use arealight_tool_kernels as tool;
use reflection::{bound_variables, module, parsed, reflected};
use rspirv::dr::Module;

mod reflection;
mod structures;

/// What a kernel binds, without what it has for other kernels of its pass.
fn used(kernel: &Kernel) -> impl Iterator<Item = &Binding> {
    kernel.bindings().iter().filter(|binding| binding.access != Access::None)
}

/// The bindings of a kernel as another reader of its module finds them.
fn found(module: &Module) -> Vec<(u32, String, BindingKind, Access)> {
    let bound = bound_variables(module).into_iter();
    bound
        .map(|(number, variable)| {
            let (name, kind, access) = reflected(module, variable);
            (number, name, kind, access)
        })
        .collect()
}

#[test]
fn kernels_say_what_another_reader_finds() {
    let of = |kernel: &'static Kernel| -> Vec<_> {
        used(kernel).map(|one| (one.number, one.name.to_owned(), one.kind, one.access)).collect()
    };
    for kernel in kernels::ALL.into_iter().chain(tool::kernels::ALL) {
        assert_eq!(of(kernel), found(&module(kernel)), "{}", kernel.name);
    }
    // The twin: another kernel of the pass
    assert_ne!(of(&kernels::SHADE), found(&module(&kernels::CLASSIFY)));
}

#[test]
fn kernels_of_a_pass_have_one_descriptor_set() {
    for pass in [&kernels::SHADE_PASS[..], &kernels::SHADOW_PASS, &kernels::MEDIUM_PASS] {
        let set = |kernel: &Kernel| -> Vec<_> {
            kernel.bindings().iter().map(|one| (one.number, one.kind)).collect()
        };
        for kernel in pass {
            assert_eq!(set(kernel), set(pass[0]), "{}", kernel.name);
            assert!(used(kernel).count() < kernel.bindings().len(), "{}", kernel.name);
        }
    }
}

#[test]
fn sizes_and_constants_are_those_of_the_shaders() {
    let shade = &kernels::SHADE;
    assert_eq!((shade.local_size(), kernels::TEXTURE_LOAD.local_size()), ([8, 8, 1], [32, 2, 1]));
    let size = |kernel: &Kernel| kernel.push_constant_size() as usize;
    assert_eq!(size(shade), size_of::<arealight::gpu::ShadeConstants>());
    assert_eq!(size(&kernels::SHADOW_FILTER), size_of::<arealight::gpu::ShadowConstants>());
    assert_eq!(size(&kernels::MEDIUM_SCATTER), size_of::<arealight::gpu::MediumConstants>());
    assert_eq!(size(&kernels::TEXTURE_LOAD), size_of::<arealight::gpu::TextureLoadConstants>());
    assert_eq!(size(&kernels::TEXTURE_MIP), size_of::<u32>());
    assert_eq!(size(&kernels::TEXTURE_KERNEL), size_of::<[u32; 4]>());
    assert_eq!(size(&tool::kernels::EVAL), size_of::<tool::gpu::EvalConstants>());
    assert_eq!(size(&tool::kernels::REFERENCE), size_of::<tool::gpu::ReferenceConstants>());
    assert_eq!(size(&tool::kernels::VISIBILITY), size_of::<tool::gpu::VisibilityConstants>());
    assert_eq!(kernels::TEXTURE_LOAD.constants(), [constant::LOAD_STEPS]);
    let of_reference = [tool::kernels::SHADOWS, tool::kernels::COUPLED, tool::kernels::HAS_ALPHA];
    assert_eq!(tool::kernels::REFERENCE.constants(), of_reference);
    assert!(shade.constants().contains(&constant::SAMPLES) && !shade.constants().contains(&constant::CULL));
}

#[test]
fn a_pruned_module_binds_what_its_frames_use() {
    let options = ShadeOptions {
        surfaces: Effects::all(),
        separate_lobes: true,
        shadow_rays: 1,
        stencil: true,
        ..ShadeOptions::default()
    };
    let lights = LightSummary { quad_count: 1, effects: Effects::all(), ..LightSummary::default() };
    let bound = |specialization: Vec<(u32, u32)>| {
        let pruned = arealight_vk::prune(&kernels::SHADE.words(), &specialization);
        bound_variables(&parsed(&pruned)).into_keys().collect::<Vec<u32>>()
    };
    let number = |name| kernels::SHADE.bindings().iter().find(|one| one.name == name).unwrap().number;
    let of_frames: Vec<u32> = used(&kernels::SHADE)
        .filter(|one| !kernels::TILE_BINDINGS.contains(&one.name) && one.name != "light_counts")
        .map(|one| one.number)
        .collect();
    let with = |name| [of_frames.as_slice(), &[number(name)]].concat();
    assert_eq!(bound(shade_specialization(options, lights)), of_frames);
    let counted = ShadeOptions { light_counts: true, ..options };
    assert_eq!(bound(shade_specialization(counted, lights)), with("light_counts"));
    // Tiles have their lists, too; a frame of quads without shadows has no more than quads need
    assert_eq!(bound(shade_tiles_specialization(options, lights, TileClass::Any)), with("tile_lists"));
    let quads = LightSummary { effects: Effects::empty(), ..lights };
    let needed = ["table_image", "lights", "light_vertices", "g_position", "g_normal", "g_base_color"];
    let needed: Vec<u32> = needed.into_iter().chain(["radiance_image"]).map(number).collect();
    assert_eq!(bound(shade_specialization(ShadeOptions::default(), quads)), needed);
}
