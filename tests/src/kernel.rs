//! Kernels of the tests' own, compiled from `tests/kernels`.

use crate::TestEngine;
use arealight::kernels::Kernel;
use arealight_vk::Resource;
use bytemuck::Pod;
use std::path::Path;
use std::process::Command;

/// Single functions of the library over a list of arguments.
pub static PROBE: Kernel = Kernel::new("probe", include_bytes!("../spirv/probe.spv"));

/// The arcs of quads, summed without a guard: the sum, and the sum clamped.
pub static UNGUARDED: Kernel = Kernel::new("unguarded", include_bytes!("../spirv/unguarded.spv"));

/// What can happen to a branch by a specialisation constant; ten numbers a number.
pub static BRANCHES: Kernel = Kernel::new("branches", include_bytes!("../spirv/branches.spv"));

/// How far lights of records are of any matter; seven numbers a light.
pub static LIGHT_REACH: Kernel = Kernel::new("light_reach", include_bytes!("../spirv/light_reach.spv"));

/// The example of a host's shader that says whether its table is right.
pub static SELF_TEST: Kernel =
    Kernel::new("self_test", include_bytes!("../../benches/spirv/examples/self_test.spv"));

/// The same of two lobes, with options that it does not depend on.
pub static SELF_TEST_OF_TWO: Kernel =
    Kernel::new("self_test_of_two", include_bytes!("../spirv/self_test_of_two.spv"));

/// Directions drawn over polygons.
pub static POLYGON_SAMPLING: Kernel =
    Kernel::new("polygon_sampling", include_bytes!("../spirv/polygon_sampling.spv"));

/// Shadow rays for shading points under lights of triangles.
pub static SHADOW_RAYS: Kernel = Kernel::new("shadow_rays", include_bytes!("../spirv/shadow_rays.spv"));

/// Blockers along rays, from buffers of [`arealight::Blockers`].
pub static BLOCKERS: Kernel = Kernel::new("blockers", include_bytes!("../spirv/blockers.spv"));

/// Blockers along rays, from the buffers of a scene.
pub static SCENE_BLOCKERS: Kernel =
    Kernel::new("scene_blockers", include_bytes!("../spirv/scene_blockers.spv"));

/// The functions that the probe kernel calls: its specialisation constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Function {
    /// `arealight_surface_frame` of a normal a and a view b: tangent and cosine, bitangent and sine, normal.
    Frame = 0,
    /// `arealight_normalize_or` of a and b, and in w `arealight_power_of_two_scale` of a.w.
    Common = 1,
    /// `arealight_table_space` at a normal a, a view b and a roughness a.w: its columns, with albedo, Schlick
    /// part and alpha; and the texel of the second matrix.
    Table = 2,
    /// `arealight_ggx_*` of a view a, a light b, an alpha a.w and two random numbers c: f cos with density;
    /// half vector with distribution; sample with visibility.
    Ggx = 3,
    /// `arealight_arc` of vertices a and b by a form a.w: their directions, with the arc, and where it
    /// crosses the horizon.
    Arc = 4,
    /// `arealight_ray_origin` of a position a, a normal b and a step b.w.
    RayOrigin = 5,
    /// `arealight_ray_point` of a center a, a radius a.w, a direction b and an end b.w: the four places'
    /// distances, and their weights.
    RayPoint = 6,
}

impl TestEngine {
    /// Runs a kernel of the tests over `count` invocations, with `inputs` bound in turn and the results, `R`
    /// per invocation, at the last binding.
    pub fn dispatch<R: Pod>(
        &self,
        kernel: &'static Kernel,
        specialization: &[(u32, u32)],
        inputs: &[Resource],
        count: usize,
    ) -> Vec<R> {
        // A kernel that knows its list's length has no push constants
        match kernel.push_constant_size() {
            0 => self.run_list((kernel, specialization), inputs, (), count),
            _ => self.run_list((kernel, specialization), inputs, count as u32, count),
        }
    }

    fn run_list<R: Pod, C: Pod>(
        &self,
        kernel: (&'static Kernel, &[(u32, u32)]),
        inputs: &[Resource],
        constants: C,
        count: usize,
    ) -> Vec<R> {
        // SAFETY: The run waits, and the resources live until then.
        let list = unsafe { self.passes().over_list(kernel, inputs, constants, count) };
        let list = list.expect("the resources fit");
        list.run().expect("it runs");
        list.results().expect("the results come back")
    }

    /// Calls a function of the library.
    pub fn probe(&self, function: Function, arguments: &[[[f32; 4]; 3]]) -> Vec<[[f32; 4]; 4]> {
        let given = self.host().storage_buffer("arguments", arguments).expect("memory");
        let inputs = [self.table(), Resource::buffer(given.handle())];
        self.dispatch(&PROBE, &[(0, function as u32)], &inputs, arguments.len())
    }
}
/// The shade kernel with the example's G-buffer, by the compiler that a host may have.
pub fn shade_with_bridge() -> Vec<u32> {
    with_bridge("shade", "AREALIGHT_HOST_G_BUFFER")
}

/// The shade kernel with the example's shadows, likewise.
pub fn shade_with_visibility() -> Vec<u32> {
    with_bridge("shade", "AREALIGHT_HOST_VISIBILITY")
}

/// The kernel of shadow rays with the example's blocker, or with our walk, which asks what masks cut out.
pub fn shadow_rays_with_bridge(macro_name: &str) -> Vec<u32> {
    with_bridge("shadow_rays", macro_name)
}

/// A kernel with what a macro asks for of the examples.
fn with_bridge(kernel: &str, macro_name: &str) -> Vec<u32> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = tempfile::tempdir().expect("a folder");
    let module = folder.path().join("kernel.spv");
    let output = Command::new("glslc")
        .args(["--target-env=vulkan1.1", &format!("-D{macro_name}=1"), "-I"])
        .arg(root.join("shaders/include"))
        .arg("-I")
        .arg(root.join("shaders/examples"))
        .arg(root.join(format!("shaders/kernels/{kernel}.comp")))
        .arg("-o")
        .arg(&module)
        .output()
        .expect("glslc: tools/setup.sh test installs it");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    crate::spirv::words(&std::fs::read(module).expect("the module"))
}
