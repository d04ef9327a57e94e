//! Shadows of a host in C are the recorder's, to the last bit; its media are what is known of them.

use arealight::Blockers;
use arealight_tests::c_library::prelude::*;
use arealight_tests::prelude::*;
use arealight_tests::shadow_patch::{PatchPasses, SIDE, ShadowPatch, shadow_image};
use arealight_vk::MediumPass;
use ash::vk::{self, Handle as _};

/// A wall before one half of the lamp.
fn patch() -> ShadowPatch {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.5);
    ShadowPatch {
        material: Material { roughness: 0.5, ..Material::default() },
        view: Vec3::new(0.0, -1.0, 1.0),
        lights: vec![lamp()],
        blockers: vec![
            [corner(0.0, -4.0), corner(4.0, -4.0), corner(4.0, 4.0)],
            [corner(0.0, -4.0), corner(4.0, 4.0), corner(0.0, 4.0)],
        ],
    }
}

/// The hierarchy's nodes and triangles, as a host in C gets them, which does something with it, too.
fn blocker_arrays(
    triangles: &[[Vec3; 3]],
    alphas: Option<&[u32]>,
    act: impl FnOnce(*mut ArealightBlockers),
) -> [Vec<u32>; 2] {
    let mut blockers = null_mut();
    let mut arrays = ArealightBlockerArrays::default();
    // SAFETY: the pointers are valid, and the arrays as large as they say.
    unsafe {
        let (vertices, count) = (triangles.as_ptr().cast(), triangles.len() as u32);
        let alphas = alphas.map_or(null(), <[u32]>::as_ptr);
        good(arealight_blockers_create(vertices, alphas, count, &raw mut blockers));
        good(arealight_blockers_read(blockers, &raw mut arrays));
        let mut made = [arrays.nodes_size, arrays.triangles_size].map(|size| vec![0_u32; size as usize / 4]);
        [arrays.nodes, arrays.triangles] = made.each_mut().map(|array| array.as_mut_ptr().cast());
        good(arealight_blockers_read(blockers, &raw mut arrays));
        act(blockers);
        good(arealight_blockers_destroy(blockers));
        made
    }
}

/// Both passes of a host in C.
struct CPasses<'a> {
    engine: &'a TestEngine,
    library: &'a CLibrary<'a>,
    shade: *mut ArealightPass,
    shadow: *mut ArealightShadowPass,
}

/// From clip space to places that the camera sees.
const FROM_CLIP: [f32; 16] = glam::Mat4::IDENTITY.to_cols_array();

impl<'a> CPasses<'a> {
    fn new(engine: &'a TestEngine, library: &'a CLibrary<'a>, shadow_rays: u32) -> Self {
        let options = ArealightPassOptions { shadow_rays, ..ArealightPassOptions::default() };
        let shadows = ArealightShadowOptions { filter: AREALIGHT_SHADOW_FILTER_GATHER, ..Default::default() };
        let (mut shade, mut shadow) = (null_mut(), null_mut());
        // SAFETY: the pointers are valid.
        unsafe {
            let arealight = library.arealight;
            good(arealight_pass_create(arealight, &raw const options, &raw mut shade));
            let mut create = |shadows: *const _| {
                arealight_shadow_pass_create(arealight, &raw const options, shadows, &raw mut shadow)
            };
            let module = ArealightModule { size: 16, ..ArealightModule::default() };
            let refusal = create(&ArealightShadowOptions { module, ..shadows });
            refused(refusal, ArealightResult::ErrorArgument, "module.words: is null");
            good(create(&raw const shadows));
        }
        Self { engine, library, shade, shadow }
    }

    fn shadow_layout(&self) -> ArealightSetLayout {
        let mut layout = set_layout(self.shade);
        // SAFETY: the pointers are valid.
        good(unsafe { arealight_shadow_pass_set_layout(self.shadow, &raw mut layout) });
        layout
    }

    /// What the patch shows, with shadows; or without, through a medium.
    fn run(&self, patch: &ShadowPatch, seed: u32, medium: Option<(u32, &ArealightMediumFrame)>) -> Vec<Vec4> {
        let (engine, host) = (self.engine, self.engine.host());
        let lights: Vec<_> = patch.lights.iter().map(c_lamp).collect();
        let packed = CLightBuffers::new(engine, &lights);
        let upload = |array: &Vec<u32>| host.storage_buffer("of C", array).unwrap();
        let [nodes, triangles] = blocker_arrays(&patch.blockers, None, |_| ()).each_ref().map(upload);
        let mut picks_size = 0;
        // SAFETY: the pointers are valid.
        good(unsafe { arealight_pass_shadow_picks_size(self.shade, SIDE, SIDE, &raw mut picks_size) });
        let picks = upload(&vec![0; picks_size as usize / 4]);

        let material = &patch.material;
        let inputs = planes(engine, [SIDE; 2], &|plane, _| match plane {
            Plane::Position => Some(Vec4::W),
            Plane::Normal => Some(Vec3::Z.extend(material.roughness)),
            Plane::BaseColor => Some(material.base_color.extend(material.metalness)),
            _ => None,
        });
        let [unshadowed, shadowed, owned] = [(); 3].map(|()| radiance(engine, [SIDE; 2], Vec4::NAN));
        let shadow = shadow_image(engine);
        let resources = ArealightResources {
            planes: Plane::ALL.map(|plane| {
                let image_of = |input| c_image(input, Usage::COMPUTE_READ);
                inputs[plane].as_ref().map_or_else(ArealightImage::default, image_of)
            }),
            radiance: c_image(&unshadowed, Usage::COMPUTE_WRITE),
            shadow_picks: whole(&picks),
            ..packed.resources()
        };
        let of_shadows = ArealightShadowResources {
            shadow: c_image(&shadow, Usage::COMPUTE_WRITE),
            radiance: c_image(&shadowed, Usage::COMPUTE_WRITE),
            blocker_nodes: whole(&nodes),
            blocker_triangles: whole(&triangles),
            ..ArealightShadowResources::default()
        };
        let frame = ArealightFrame {
            width: SIDE,
            height: SIDE,
            camera: patch.view.to_array(),
            lights: packed.summary,
            seed,
            position_from_clip: FROM_CLIP.as_ptr(),
            ..NO_FRAME
        };
        let shadow_frame = ArealightShadowFrame { frame: &raw const frame, ..Default::default() };
        let (shade_set, _shade_pool) = self.library.set(&set_layout(self.shade));
        let (shadow_set, _shadow_pool) = self.library.set(&self.shadow_layout());
        let (shade_set, shadow_set) = (shade_set.as_raw(), shadow_set.as_raw());
        // SAFETY: the sets are new, and what they point to lives until submissions were waited for.
        unsafe {
            let arealight = self.library.arealight;
            let resources = &raw const resources;
            good(arealight_pass_write_set(self.shade, arealight, shade_set, resources));
            let without =
                ArealightShadowResources { blocker_nodes: ArealightBuffer::default(), ..of_shadows };
            let write = |of_shadows: &ArealightShadowResources| {
                arealight_shadow_pass_write_set(self.shadow, arealight, shadow_set, resources, of_shadows)
            };
            refused(write(&without), ArealightResult::ErrorArgument, "blockers");
            good(write(&of_shadows));
            good(arealight_shadow_pass_prepare(self.shadow, &raw const frame));
            // In parts the picture is the same
            for rows in [[0, 24], [24, SIDE]] {
                let part = ArealightFrame { rows, ..frame };
                host.submit(|commands| {
                    let commands = commands.as_raw() as *mut c_void;
                    good(arealight_pass_record(self.shade, commands, shade_set, &raw const part));
                })
                .unwrap();
            }
            host.submit(|commands| {
                let record = |commands, frame| {
                    let resources = &raw const of_shadows;
                    arealight_shadow_pass_record(self.shadow, commands, shadow_set, resources, frame)
                };
                let commands = commands.as_raw() as *mut c_void;
                let no_frame = ArealightShadowFrame { frame: null(), ..shadow_frame };
                let refusal = record(commands, &raw const no_frame);
                refused(refusal, ArealightResult::ErrorArgument, "frame.frame: is null");
                good(record(commands, &raw const shadow_frame));
            })
            .unwrap();
        }
        if let Some(medium) = medium {
            self.put_before(&resources, &of_shadows, &frame, medium);
        }
        let drawn = stored_in(if medium.is_some() { &unshadowed } else { &shadowed });
        // What owns all this draws the same; its random numbers begin at 0
        if seed == 0 && medium.is_none_or(|(rays, _)| rays == 0) {
            let images = ArealightResources { radiance: c_image(&owned, Usage::COMPUTE_WRITE), ..resources };
            self.draw_by_owner(patch, medium.map(|(_, medium)| medium), &images, &frame);
            assert_eq!(stored_in(&owned), drawn);
        }
        drawn
    }
}

impl CPasses<'_> {
    /// Draws by what owns all: with shadows, or without, through a medium.
    fn draw_by_owner(
        &self,
        patch: &ShadowPatch,
        medium: Option<&ArealightMediumFrame>,
        images: &ArealightResources,
        frame: &ArealightFrame,
    ) {
        let lights: Vec<_> = patch.lights.iter().map(c_lamp).collect();
        let shadow_rays = if medium.is_none() { 2 } else { 0 };
        let options = ArealightPassOptions { shadow_rays, ..ArealightPassOptions::default() };
        let of_medium = ArealightMediumOptions::default();
        let info = ArealightAreaLightsInfo {
            options,
            shadow_filter: AREALIGHT_SHADOW_FILTER_GATHER,
            medium: medium.map_or(null(), |_| &raw const of_medium),
            ..NO_INFO
        };
        // SAFETY: the pointers are valid, here and below.
        self.library.with_area_lights(&info, |owner| unsafe {
            if let Some(medium) = medium {
                good(arealight_area_lights_set_medium(owner, medium));
            } else {
                blocker_arrays(&patch.blockers, None, |blockers| {
                    good(arealight_area_lights_set_blockers(owner, blockers, [0.0; 3].as_ptr()));
                });
            }
            self.library.submit(null_mut(), &lights, images, frame);
        });
    }

    /// Puts a medium before what was shaded.
    fn put_before(
        &self,
        shade: &ArealightResources,
        blockers: &ArealightShadowResources,
        of_shade: &ArealightFrame,
        (shadow_rays, medium): (u32, &ArealightMediumFrame),
    ) {
        let frame = &ArealightMediumFrame { frame: of_shade, ..*medium };
        let (host, arealight) = (self.engine.host(), self.library.arealight);
        let options = ArealightPassOptions::default();
        let medium = ArealightMediumOptions { shadow_rays, ..ArealightMediumOptions::default() };
        let (mut pass, mut layout) = (null_mut(), ArealightSetLayout::default());
        let [width, height, depth] = frame.froxels;
        let (format, usage) = (MediumPass::FORMAT, vk::ImageUsageFlags::STORAGE);
        let description =
            ImageDescription { name: "froxels", extent: [width, height], layers: 1, format, usage };
        let volume = host.volume(&description, depth).unwrap();
        let resources = ArealightMediumResources {
            froxels: c_image(&volume, Usage::COMPUTE_WRITE),
            medium: ArealightImage::default(),
            blocker_nodes: blockers.blocker_nodes,
            blocker_triangles: blockers.blocker_triangles,
        };
        // SAFETY: the pointers are valid, and what the set points to lives until submissions were waited for.
        unsafe {
            let create = |options: &_, medium: &_, pass: &mut _| {
                arealight_medium_pass_create(arealight, options, medium, pass)
            };
            let wrong = ArealightMediumOptions { shadow_rays: 3, ..medium };
            let refusal = create(&options, &wrong, &mut pass);
            refused(refusal, ArealightResult::ErrorArgument, "medium.shadow_rays");
            good(create(&options, &medium, &mut pass));
            good(arealight_medium_pass_set_layout(pass, &raw mut layout));
            let (set, _pool) = self.library.set(&layout);
            let set = set.as_raw();
            good(arealight_medium_pass_write_set(pass, arealight, set, shade, &raw const resources));
            good(arealight_medium_pass_prepare(pass, frame.frame));
            host.submit(|commands| {
                volume.transition(commands, Usage::UNDEFINED, Usage::COMPUTE_WRITE);
                let commands = commands.as_raw() as *mut c_void;
                let no_matrix = ArealightFrame { position_from_clip: null(), ..*frame.frame };
                let wrong = ArealightMediumFrame { frame: &raw const no_matrix, ..*frame };
                let refusal = arealight_medium_pass_record(pass, commands, set, &raw const wrong);
                refused(refusal, ArealightResult::ErrorArgument, "position_from_clip");
                good(arealight_medium_pass_record(pass, commands, set, frame));
            })
            .unwrap();
            good(arealight_medium_pass_destroy(pass));
        }
    }
}

impl Drop for CPasses<'_> {
    fn drop(&mut self) {
        // SAFETY: nothing is pending.
        unsafe {
            good(arealight_shadow_pass_destroy(self.shadow));
            good(arealight_pass_destroy(self.shade));
        }
    }
}

#[test]
fn c_draws_the_shadows_that_rust_does_to_the_last_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let (engine, patch) = (&engine, patch());
    let options = ShadeOptions { shadow_rays: 2, ..ShadeOptions::default() };
    let rust = patch.run(&PatchPasses::new(engine, options, ShadowFilter::Gather));

    let library = CLibrary::with_table(engine);
    let passes = CPasses::new(engine, &library, 2);
    let c = passes.run(&patch, 0, None);
    let colors: Vec<Vec3> = c.iter().map(|texel| texel.truncate()).collect();
    assert_eq!(colors, rust.radiance);

    // Some rays are hidden, and not all
    let part = colors[0].y / rust.unshadowed[0].y;
    assert!(part > 0.1 && part < 0.9, "{part}");

    // The twins: other random numbers, and nothing that blocks
    assert_ne!(passes.run(&patch, 1, None), c);
    let free = passes.run(&ShadowPatch { blockers: vec![[Vec3::ZERO; 3]], ..patch.clone() }, 0, None);
    let lit: Vec<Vec3> = free.iter().map(|texel| texel.truncate()).collect();
    assert_eq!(lit, rust.unshadowed);
}

#[test]
fn media_of_c_dim_and_scatter_what_is_known() {
    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::with_table(&engine);
    let passes = CPasses::new(&engine, &library, 2);
    // A lamp is the upper half of what is seen from anywhere, before a wall or behind it
    let level = |side: f64, z: f64| {
        [[-side, -side], [-side, side], [side, side], [side, -side]].map(|[x, y]| DVec3::new(x, y, z))
    };
    let lights = vec![Light { shape: LightShape::Polygon(level(1e4, 3.0).to_vec()), ..lamp() }];
    let behind = |z: f64| {
        let [a, b, c, d] = level(1e5, z).map(DVec3::as_vec3);
        ShadowPatch { blockers: vec![[a, b, c], [a, c, d]], lights: lights.clone(), ..patch() }
    };
    let zeros = ArealightMediumFrame::default();
    let clear = ArealightMediumFrame { froxels: [4, 3, 64], nearest: 1.0, farthest: 8.0, ..zeros };
    let seen = |frame: &_, rays, wall| passes.run(&behind(wall), 0, Some((rays, frame)))[0].truncate();
    let (before, away) = (seen(&clear, 0, 2.0), patch().view.length());
    let scattering = [0.1, 0.2, 0.3];
    let scattered = Vec3::from_array(scattering) * lights[0].radiance * 0.5 * away;
    let dim = ArealightMediumFrame { extinction: 0.4, ..clear };
    let bright = ArealightMediumFrame { scattering, ..clear };
    for (frame, rays, wall, expected) in [
        (&dim, 0, 2.0, before * (-0.4 * away).exp()),
        (&bright, 0, 2.0, before + scattered),
        (&bright, 1, 4.0, before + scattered),
        (&bright, 1, 2.0, before),
        (&bright, 2, 2.0, before),
    ] {
        let found = seen(frame, rays, wall);
        // Sums of froxels have 11 bits; the twins: each other frame's
        assert!((found - expected).abs().cmple(1e-3 * expected).all(), "{rays}: {found}, not {expected}");
    }
    assert!(scattered.cmpgt(0.01 * before).all(), "{scattered}, {before}");
}

#[test]
fn triangles_that_are_cut_out_have_the_numbers_of_a_host_in_c() {
    let triangles = patch().blockers;
    let plain = Blockers::new(&triangles).unwrap();
    let cut = plain.clone().with_alpha(|index| [0, 7][index as usize]);
    for (alphas, expected) in [(None, plain), (Some(&[0, 7][..]), cut.clone())] {
        let [_, found] = blocker_arrays(&triangles, alphas, |_| ());
        assert_eq!(found, bytemuck::cast_slice::<_, u32>(&expected.triangles));
        // The twin: only one of them has a number
        assert_eq!(found == bytemuck::cast_slice::<_, u32>(&cut.triangles), alphas.is_some());
    }
}
