//! What a host in C shades is what the recorder does, to the last bit: lights with images, with holes, of
//! several faces, and a G-buffer of the host's own, with a table whose first upload was never run.

use arealight::{LightFault, TexturePart, Wrap};
use arealight_engine::host::{DescriptorPool, HostError};
use arealight_tests::c_library::prelude::*;
use arealight_tests::prelude::*;
use ash::vk::{self, Handle as _};

const CAMERA: Vec3 = Vec3::new(0.0, -1.0, 1.0);

/// An image in sRGB, of which no two texels are alike, and the part of it that is shown.
const SIZE: [u32; 2] = [5, 3];

fn texels() -> Vec<[u8; 4]> {
    (0..15_u8).map(|texel| [texel * 17, 255 - texel * 11, texel * texel, 255]).collect()
}

fn part() -> TexturePart {
    TexturePart {
        low: DVec2::new(0.25, 0.0),
        size: DVec2::new(1.5, 0.5),
        wrap: [Wrap::Mirror, Wrap::Clamp],
        divisor: 2.5,
        aspect: 1.5,
        is_ellipse: true,
    }
}

/// Corners of a rectangle over the pixel, from where it shines.
fn corners(low: [f64; 2], size: f64, height: f64) -> Vec<DVec3> {
    let [x, y] = low;
    [(0.0, 0.0), (0.0, size), (size, size), (size, 0.0)]
        .map(|(u, v)| DVec3::new(x + u, y + v, height))
        .to_vec()
}

const SCREEN: [[f64; 2]; 4] = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];

/// The sizes of the holes of the frame and of the screen.
const HOLES: [f64; 2] = [1.0, 0.25];

/// A bent strip of two faces: a square that looks down, and a triangle that hangs from its end.
fn strip() -> [Vec<DVec3>; 2] {
    let mut square = corners([1.0, 1.0], 0.75, 2.0);
    square.reverse();
    let [a, b] = [DVec3::new(1.75, 1.75, 2.0), DVec3::new(1.0, 1.75, 2.0)];
    [square, vec![a, b, DVec3::new(1.375, 2.25, 1.25)]]
}

/// A window, a screen that shows a layer around a hole, a frame around another, and a strip.
fn lights([frame_hole, screen_hole]: [f64; 2]) -> Result<Vec<Light>, LightFault> {
    let window = Light { name: "window".into(), ..lamp() };
    let mut screen = Light {
        name: "screen".into(),
        shape: LightShape::Polygon(corners([0.5, -0.5], 1.0, 1.0)),
        texture: Some(LightTexture { layer: 1, uvs: SCREEN.map(DVec2::from_array).to_vec() }),
        ..lamp()
    };
    screen.cut_holes(&[corners([0.75, -0.25], screen_hole, 1.0)])?;
    let outline = LightShape::Polygon(corners([-2.0, -2.0], 1.5, 1.5));
    let mut frame = Light { name: "frame".into(), shape: outline, ..lamp() };
    frame.cut_holes(&[corners([-1.75, -1.75], frame_hole, 1.5)])?;
    let mut bent = Light { name: "strip".into(), shape: LightShape::default(), ..lamp() };
    for face in strip() {
        bent.shape.add_face(&face);
    }
    Ok(vec![window, screen, frame, bent])
}

/// The same as a host in C has them: what each points to, and the lights.
struct CLights {
    _vertices: [Vec<DVec3>; 4],
    _hole: Box<u32>,
    faces: Box<[u32; 2]>,
    lights: [ArealightLight; 4],
}

impl CLights {
    fn new([frame_hole, screen_hole]: [f64; 2]) -> Self {
        let vertices = [
            lamp().shape.vertices().to_vec(),
            [corners([0.5, -0.5], 1.0, 1.0), corners([0.75, -0.25], screen_hole, 1.0)].concat(),
            [corners([-2.0, -2.0], 1.5, 1.5), corners([-1.75, -1.75], frame_hole, 1.5)].concat(),
            strip().concat(),
        ];
        let (hole, faces) = (Box::new(4), Box::new([4, 3]));
        let mut lights = [0, 1, 2, 3].map(|index: usize| ArealightLight {
            vertices: vertices[index].as_ptr().cast(),
            vertex_count: 4,
            radiance: lamp().radiance.to_array(),
            ..NO_LIGHT
        });
        lights[1].texture_coordinates = SCREEN.as_ptr().cast();
        (lights[1].textured, lights[1].texture_layer) = (1, 1);
        for light in &mut lights[1..3] {
            light.hole_vertex_counts = &raw const *hole;
            light.hole_count = 1;
        }
        (lights[3].vertex_count, lights[3].face_count) = (7, 2);
        lights[3].kind = AREALIGHT_LIGHT_MESH;
        lights[3].face_vertex_counts = faces.as_ptr();
        Self { _vertices: vertices, _hole: hole, faces, lights }
    }
}

/// The lights' images, as a host in C sets them up. Fields go in this order.
struct CTextures<'a> {
    raw: *mut ArealightTextures,
    _pools: Vec<DescriptorPool>,
    _memory: DeviceMemory,
    library: &'a CLibrary<'a>,
    engine: &'a TestEngine,
    needs: ArealightTextureNeeds,
}

impl<'a> CTextures<'a> {
    fn new(engine: &'a TestEngine, library: &'a CLibrary<'a>) -> Self {
        let options = ArealightTextureOptions { side: 128, layers: 2 };
        let mut raw = null_mut();
        let mut needs = ArealightTextureNeeds::default();
        // SAFETY: the pointers are valid; refused calls look behind none, here and below.
        unsafe {
            good(arealight_textures_create(library.arealight, &raw const options, &raw mut raw));
            good(arealight_textures_needs(raw, &raw mut needs));
        }
        let memory = DeviceMemory::new(engine, &needs.memory);
        let (sets, pools): (Vec<_>, Vec<_>) =
            (0..needs.level_set_count).map(|_| library.set(&needs.level_set)).unzip();
        let sets: Vec<u64> = sets.into_iter().map(vk::DescriptorSet::as_raw).collect();
        let setup = |commands: vk::CommandBuffer| ArealightTextureSetup {
            memory: memory.raw.as_raw(),
            memory_offset: 0,
            level_sets: sets.as_ptr(),
            level_set_count: sets.len() as u32,
            reserved: 0,
            command_buffer: commands.as_raw() as *mut c_void,
        };

        // What is left out is named, and nothing can be used before
        let argument = ArealightResult::ErrorArgument;
        let right = setup(vk::CommandBuffer::from_raw(8));
        // SAFETY: memory and sets are as was asked for, or refused.
        let set_up = |setup: &ArealightTextureSetup| unsafe { arealight_textures_setup(raw, setup) };
        let mut image = ArealightImage::default();
        for (wrong, words) in [
            (ArealightTextureSetup { memory: 0, ..right }, "setup.memory: is null"),
            (ArealightTextureSetup { level_sets: null(), ..right }, "setup.level_sets: is null"),
            (ArealightTextureSetup { level_set_count: 1, ..right }, "setup.level_set_count: 1, but"),
            (ArealightTextureSetup { command_buffer: null_mut(), ..right }, "setup.command_buffer: is null"),
        ] {
            refused(set_up(&wrong), argument, words);
        }
        let early = "call arealight_textures_setup first";
        // SAFETY: as above.
        unsafe {
            refused(arealight_textures_image(raw, &raw mut image), argument, early);
            refused(arealight_textures_write_source_set(raw, 8, image), argument, early);
            refused(arealight_textures_update(raw, null_mut(), null(), 0), argument, early);
        }

        // The first commands are never run
        let never = engine.host().try_submit(|commands| {
            good(set_up(&setup(commands)));
            Err(HostError::NoDevice { found: vec![] })
        });
        never.unwrap_err();
        let other = ArealightTextureSetup { memory_offset: 8, ..right };
        refused(set_up(&other), argument, "other memory already");
        engine.host().submit(|commands| good(set_up(&setup(commands)))).unwrap();
        Self { raw, _pools: pools, _memory: memory, library, engine, needs }
    }

    /// Replaces a layer by an image.
    fn update(&self, image: &Image) {
        let (set, _pool) = self.library.set(&self.needs.source_set);
        let source = c_image(image, Usage::COMPUTE_READ);
        // SAFETY: the set is new, and the image lives until the submission was waited for.
        good(unsafe { arealight_textures_write_source_set(self.raw, set.as_raw(), source) });
        let update = ArealightTextureUpdate {
            source_set: set.as_raw(),
            part_low: part().low.to_array(),
            part_size: part().size.to_array(),
            layer: 1,
            source_width: SIZE[0],
            source_height: SIZE[1],
            decode_srgb: 1,
            wrap_u: AREALIGHT_WRAP_MIRROR,
            wrap_v: 0,
            divisor: 2.5,
            aspect: part().aspect,
            is_ellipse: 1,
            reserved: 0,
        };
        let recorded = self.engine.host().submit(|commands| {
            let commands = commands.as_raw() as *mut c_void;
            // SAFETY: the commands are being recorded; nothing is where a call is refused.
            let record = |update: ArealightTextureUpdate| unsafe {
                arealight_textures_update(self.raw, commands, &raw const update, 1)
            };
            for (wrong, words) in [
                (ArealightTextureUpdate { source_set: 0, ..update }, "updates[0].source_set: is null"),
                (ArealightTextureUpdate { layer: 2, ..update }, "layer: 2 is not there"),
                (ArealightTextureUpdate { source_width: 0, ..update }, "source of 0 x 3 texels"),
                (ArealightTextureUpdate { wrap_v: 3, ..update }, "updates[0].wrap_v: 3"),
                (ArealightTextureUpdate { divisor: -1.0, ..update }, "divisor: -1"),
                (ArealightTextureUpdate { aspect: -1.0, ..update }, "aspect: -1"),
                (ArealightTextureUpdate { is_ellipse: 2, ..update }, "updates[0].is_ellipse: 2"),
                (ArealightTextureUpdate { reserved: 1, ..update }, "updates[0].reserved"),
                (ArealightTextureUpdate { decode_srgb: 2, ..update }, "updates[0].decode_srgb: 2"),
                (ArealightTextureUpdate { part_size: [f64::NAN, 1.0], ..update }, "size"),
            ] {
                refused(record(wrong), ArealightResult::ErrorArgument, words);
            }
            good(record(update));
        });
        recorded.unwrap();
    }

    fn image(&self) -> ArealightImage {
        let mut image = ArealightImage::default();
        // SAFETY: the pointers are valid.
        good(unsafe { arealight_textures_image(self.raw, &raw mut image) });
        image
    }
}

impl Drop for CTextures<'_> {
    fn drop(&mut self) {
        // SAFETY: nothing is pending.
        good(unsafe { arealight_textures_destroy(self.raw) });
    }
}

fn source(engine: &TestEngine, texels: &[[u8; 4]]) -> Image {
    image(engine, SIZE, vk::Format::R8G8B8A8_UNORM, vk::ImageUsageFlags::SAMPLED, texels)
}

#[test]
fn c_shades_images_holes_and_meshes_as_rust_does_to_the_last_bit() {
    let Some(mut engine) = TestEngine::new() else { return };
    let shown = SourceImage { size: SIZE, texels: SourceTexels::Srgb(&texels()), part: part() };
    let size = PyramidSize::new(128).unwrap();
    let black = SourceImage {
        size: [1, 1],
        texels: SourceTexels::Srgb(&[[0, 0, 0, 255]]),
        part: TexturePart::default(),
    };
    engine.load_textures(size, &[black, shown]).unwrap();
    let engine = engine;
    let options = ShadeOptions { surfaces: Effects::DIFFUSE, ..ShadeOptions::default() };
    let pixel = OnePixel::new(&engine, Vec4::new(0.1, 0.2, 0.0, 1.0), 0.5);
    let rust = pixel.shade(options, &lights(HOLES).unwrap(), CAMERA, None);

    // In C: the table by commands that are recorded again, because the first were never run
    let library = CLibrary::new(&engine);
    let memory = DeviceMemory::new(&engine, &library.table_memory());
    let staging = library.staging();
    let never = engine.host().try_submit(|commands| {
        good(library.record_upload(memory.raw, &staging, commands));
        Err(HostError::NoDevice { found: vec![] })
    });
    never.unwrap_err();
    let other = DeviceMemory::new(&engine, &library.table_memory());
    let words = "memory: the table has other memory already";
    let refusal = library.record_upload(other.raw, &staging, vk::CommandBuffer::from_raw(8));
    refused(refusal, ArealightResult::ErrorArgument, words);
    library.upload(memory);

    let pass = library.pass(AREALIGHT_EFFECT_DIFFUSE);
    let textures = CTextures::new(&engine, &library);
    let shade_all = |lights: &CLights| library.shade(pass, &pixel, &lights.lights, textures.image(), CAMERA);
    let shade = |holes| shade_all(&CLights::new(holes));
    let dark = shade(HOLES);
    textures.update(&source(&engine, &texels()));
    let c = shade(HOLES);
    assert_eq!(c, rust);
    assert!(c.min_element() > 0.05 && c.is_finite(), "{c}");
    // So does what owns the rest; with other holes it does not
    let diffuse = ArealightPassOptions { surfaces: AREALIGHT_EFFECT_DIFFUSE, ..Default::default() };
    library.with_area_lights(&ArealightAreaLightsInfo { options: diffuse, ..NO_INFO }, |_| {
        assert_eq!([HOLES; 3].map(shade), [c; 3]);
        assert_ne!(shade([0.99, HOLES[1]]), c);
    });

    // With a coat, whose image is one more
    let mut coated = OnePixel::new(&engine, Vec4::new(0.1, 0.2, 0.0, 1.0), 0.5);
    coated.set(Plane::Coat, vk::Format::R32G32B32A32_SFLOAT, [0.75_f32, 0.3, 0.2, -0.1]);
    let options =
        ShadeOptions { surfaces: Effects::DIFFUSE | Effects::COAT | Effects::COAT_NORMAL, ..options };
    let rust = coated.shade(options, &lights(HOLES).unwrap(), CAMERA, None);
    let coats = AREALIGHT_EFFECT_COAT | AREALIGHT_EFFECT_COAT_NORMAL;
    let coating = library.pass(AREALIGHT_EFFECT_DIFFUSE | coats);
    let given = CLights::new(HOLES);
    let c_coated = library.shade(coating, &coated, &given.lights, textures.image(), CAMERA);
    assert_eq!(c_coated, rust);
    assert_ne!(c_coated, c);

    // The twins: before the image was loaded, with another one, with other holes, and with faces shared out
    // otherwise
    assert!((dark - c).truncate().max_element() < 0.0, "{dark} {c}");
    assert!(shade([0.99, HOLES[1]]) != c && shade([HOLES[0], 0.24]) != c);
    let mut shared = CLights::new(HOLES);
    *shared.faces = [3, 4];
    assert!(shade_all(&shared) != c);
    let mut others = texels();
    others[7][1] ^= 0x40;
    textures.update(&source(&engine, &others));
    assert!(shade(HOLES) != c);

    // A layer that is not there
    let mut beyond = CLights::new(HOLES);
    // SAFETY: the lights are as they say.
    good(unsafe { arealight_textures_check_lights(textures.raw, beyond.lights.as_ptr(), 2) });
    beyond.lights[1].texture_layer = 2;
    // SAFETY: as above.
    let result = unsafe { arealight_textures_check_lights(textures.raw, beyond.lights.as_ptr(), 2) };
    refused(result, ArealightResult::ErrorLight, "lights[1]: texture: layer 2");
    for pass in [pass, coating] {
        // SAFETY: nothing is pending.
        good(unsafe { arealight_pass_destroy(pass) });
    }
}

#[test]
fn c_pushes_what_sets_hold() {
    let Some(engine) = TestEngine::with_push_descriptors() else { return };
    let pixel = OnePixel::new(&engine, Vec4::new(0.1, 0.2, 0.0, 1.0), 0.5);
    let library = CLibrary::with_table(&engine);
    let textures = CTextures::new(&engine, &library);
    let given = CLights::new(HOLES);
    let shade =
        |library: &CLibrary<'_>, pass| library.shade(pass, &pixel, &given.lights, textures.image(), CAMERA);
    let plain = library.pass(AREALIGHT_EFFECT_DIFFUSE);
    let by_set = shade(&library, plain);
    let options =
        ArealightPassOptions { surfaces: AREALIGHT_EFFECT_DIFFUSE, ..ArealightPassOptions::default() };
    let [pushing, by_offsets] = [AREALIGHT_DESCRIPTORS_PUSHED, AREALIGHT_DESCRIPTORS_LIGHT_OFFSETS]
        .map(|descriptors| library.pass_with(&ArealightPassOptions { descriptors, ..options }));
    library.is_pushed.set(true);
    assert_eq!(shade(&library, pushing), by_set);
    // The twin: a pass with sets takes no pushed resources, and offsets need dynamic buffers
    let frame = &ArealightFrame { width: 1, height: 1, ..NO_FRAME };
    let (arealight, none) = (library.arealight, &ArealightResources::default());
    let commands = null_mut::<c_void>().wrapping_add(8);
    // SAFETY: the pointers are valid, and nothing is recorded where an error is returned.
    let pushed = unsafe { arealight_pass_record_pushed(by_offsets, arealight, commands, none, frame) };
    refused(pushed, ArealightResult::ErrorArgument, "resources: are given");
    let layout = set_layout(by_offsets);
    assert_eq!(layout.dynamic_storage_buffers, 3);
    assert_eq!(set_layout(plain).dynamic_storage_buffers, 0);
    for pass in [plain, pushing, by_offsets] {
        // SAFETY: nothing is pending.
        good(unsafe { arealight_pass_destroy(pass) });
    }
}
