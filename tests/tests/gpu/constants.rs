//! The constants of the GLSL sources, which Rust and the shaders must number alike: effects, flags, choices.

use arealight::gpu;
use arealight::plan::{GBufferLayout, Output, RadianceFormat, ShadeOptions};
use arealight::{Effects, Footprint, Horizon, Lobes, SpecularLobes, TileClass, TubeEnds, tiles};
use std::collections::BTreeMap;

/// The constants whose names begin with `prefix` in a GLSL source, without it, by name. Specialisation
/// constants are none of them.
fn glsl_constants(source: &str, prefix: &str) -> BTreeMap<String, f64> {
    let mut found = BTreeMap::new();
    for line in source.lines() {
        let Some(declaration) = line.strip_prefix("const ") else { continue };
        let (_kind, rest) = declaration.split_once(' ').expect("const TYPE NAME = VALUE;");
        let (name, value) = rest.split_once(" = ").expect("NAME = VALUE;");
        // A line that goes on has no literal
        let Some((value, _)) = value.split_once(';') else { continue };
        let value = value.trim_end_matches('u');
        if let Some(name) = name.strip_prefix(prefix) {
            let number = match value.strip_prefix("0x") {
                Some(digits) => f64::from(u32::from_str_radix(digits, 16).expect("hexadecimal digits")),
                None => value.parse().expect("a literal"),
            };
            found.insert(name.to_owned(), number);
        }
    }
    found
}

/// The constants of a type, by their names.
macro_rules! of {
    ($type:ty: $($name:ident)+) => { [$((stringify!($name), f64::from(<$type>::$name))),+] };
}

fn assert_constants(source: &str, prefix: &str, expected: &[(&str, f64)]) {
    let expected: BTreeMap<_, _> = expected.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
    assert_eq!(glsl_constants(source, prefix), expected, "{prefix}*");
}

const EFFECTS_GLSL: &str = include_str!("../../../shaders/kernels/effects.glsl");
const OPTIONS_GLSL: &str = include_str!("../../../shaders/include/arealight/options.glsl");
const COMMON_GLSL: &str = include_str!("../../../shaders/include/arealight/common.glsl");
const FOOTPRINT_GLSL: &str = include_str!("../../../shaders/include/arealight/textures/footprint.glsl");
const LIGHT_RECORDS_GLSL: &str = include_str!("../../../shaders/kernels/light_records.glsl");
const TUBE_OUTLINE_GLSL: &str =
    include_str!("../../../shaders/include/arealight/form_factor/tube_outline.glsl");
const SCENE_GLSL: &str = include_str!("../../../tools/kernels/shaders/scene.glsl");
const TEXTURE_LOAD_COMP: &str = include_str!("../../../shaders/kernels/texture_load.comp");
const IMAGE_LAYERS_GLSL: &str = include_str!("../../../shaders/kernels/image_layers.glsl");
const TEXTURE_KERNEL_COMP: &str = include_str!("../../../shaders/kernels/texture_kernel.comp");
const G_BUFFER_GLSL: &str = include_str!("../../../shaders/kernels/g_buffer.glsl");
const OUTPUT_TEXEL_GLSL: &str = include_str!("../../../shaders/kernels/output_texel.glsl");
const SHADOW_HISTORY_GLSL: &str = include_str!("../../../shaders/kernels/shadow_history.glsl");
const SHADOW_PICKS_GLSL: &str = include_str!("../../../shaders/kernels/shadow_picks.glsl");
const CAMERA_GLSL: &str = include_str!("../../../shaders/kernels/camera.glsl");
const VIEW_GLSL: &str = include_str!("../../../shaders/kernels/view.glsl");
const POSITION_GLSL: &str = include_str!("../../../shaders/kernels/position.glsl");
const RAY_ORIGIN_GLSL: &str = include_str!("../../../shaders/include/arealight/shadows/ray_origin.glsl");
const TILES_GLSL: &str = include_str!("../../../shaders/kernels/tiles.glsl");

#[test]
fn effects_have_the_same_bits_in_glsl() {
    let effects: Vec<_> =
        Effects::all().iter().map(|e| (e.names()[0].to_uppercase(), f64::from(e.bits()))).collect();
    let effects: Vec<_> = effects.iter().map(|(name, bits)| (name.as_str(), *bits)).collect();
    assert_constants(EFFECTS_GLSL, "EFFECT_", &effects);
}
/// The names that follow `prefix` in a text, each as often as it is there.
fn names_after<'a>(text: &'a str, prefix: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(prefix).skip(1).map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
        &rest[..end]
    })
}

#[test]
fn every_effect_is_asked_for_and_no_other() {
    let shaders = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shaders");
    let mut uses: BTreeMap<String, usize> =
        Effects::all().iter().map(|effect| (effect.names()[0].to_uppercase(), 0)).collect();
    for folder in ["kernels"] {
        for entry in std::fs::read_dir(shaders.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let source = std::fs::read_to_string(&path).unwrap();
            // Comments ask for nothing
            let code: Vec<_> = source.lines().filter_map(|line| line.split("//").next()).collect();
            for name in names_after(&code.join("\n"), "EFFECT_") {
                let count = uses.get_mut(name).unwrap_or_else(|| panic!("{}: {name}", path.display()));
                *count += 1;
            }
        }
    }
    // Once where it is defined, and where it matters; glass to Effects::passes alone
    assert!(uses.iter().all(|(name, count)| *count >= 2 || name == "GLASS"), "{uses:?}");
    let twin: Vec<_> = names_after("a & A_ONE) | A_TWO_2;", "A_").collect();
    assert_eq!(twin, ["ONE", "TWO_2"]);
}

#[test]
fn flags_have_the_same_bits_in_glsl() {
    use arealight_tool_kernels::gpu::{GpuMaterial, GpuTexture, GpuTriangle};
    use gpu::{GpuLight, TextureLoadConstants as Load};
    let flags = of!(GpuLight: TWO_SIDED FLAT MESH QUAD PROFILE OPENING LINKS_SHIFT SHAPED);
    assert_constants(LIGHT_RECORDS_GLSL, "LIGHT_", &flags);
    assert_constants(LIGHT_RECORDS_GLSL, "NO_LIGHT_", &[("TEXTURE", GpuLight::NO_TEXTURE.into())]);
    assert_constants(FOOTPRINT_GLSL, "AREALIGHT_NO_", &[("IMAGE", GpuLight::NO_TEXTURE.into())]);
    assert_constants(LIGHT_RECORDS_GLSL, "SHAPE_", &of!(gpu::GpuShape: DISK SPHERE TUBE TWO_SIDED));
    assert_constants(RAY_ORIGIN_GLSL, "AREALIGHT_ROUND_", &[("MARGIN", arealight::blockers::ROUND_MARGIN)]);
    assert_constants(SCENE_GLSL, "TRIANGLE_", &of!(GpuTriangle: TANGENTS MIRRORED COLORS GROUPS_SHIFT));
    assert_constants(SCENE_GLSL, "MATERIAL_", &of!(GpuMaterial: DOUBLE_SIDED ALPHA_MASK ALPHA_BLEND UNLIT));
    assert_constants(SCENE_GLSL, "NO_TEXTURE", &[("", GpuMaterial::NO_TEXTURE.into())]);
    let texture = of!(GpuTexture: SRGB CLAMP_U CLAMP_V MIRROR_U MIRROR_V);
    assert_constants(SCENE_GLSL, "TEXTURE_", &texture);
    let load = of!(Load: SRGB CLAMP_U CLAMP_V MIRROR_U MIRROR_V);
    assert_constants(TEXTURE_LOAD_COMP, "LOAD_", &load);
}

#[test]
fn choices_have_the_same_numbers_in_glsl() {
    let number = |value: u32| f64::from(value);
    for (prefix, name, value) in
        [("HORIZON_", "BOTH", Horizon::Both as u32), ("LOBES_", "FORMULA", Lobes::Formula as u32)]
    {
        assert_constants(EFFECTS_GLSL, prefix, &[(name, number(value))]);
    }
    let specular_lobes = [
        ("TWO", number(SpecularLobes::Two as u32)),
        ("HALF_VECTORS", number(SpecularLobes::HalfVectors as u32)),
    ];
    assert_constants(EFFECTS_GLSL, "SPECULAR_LOBES_", &specular_lobes);
    let footprints = [("KERNEL", number(Footprint::Kernel as u32)), ("MIPS", number(Footprint::Mips as u32))];
    assert_constants(OPTIONS_GLSL, "AREALIGHT_FOOTPRINT_", &footprints);
    let depth = [("DEPTH", number(u32::from(true)))];
    assert_constants(POSITION_GLSL, "POSITION_FROM_", &depth);
    let classes = TileClass::ALL.map(|class| {
        let name = match class {
            TileClass::Empty => "EMPTY",
            TileClass::Quads => "QUADS",
            TileClass::Any => "ANY",
        };
        (name, number(class as u32))
    });
    let classes = [classes.as_slice(), &[("FRAME", number(tiles::NO_CLASS))]].concat();
    assert_constants(TILES_GLSL, "CLASS_", &classes);
    let tiles = [
        ("SIDE", number(tiles::SIDE)),
        ("CLASS_WORDS", tiles::CLASS_WORDS as f64),
        ("FIRST_LIST", number(tiles::FIRST_LIST)),
        ("RECORD_HEADER", number(tiles::RECORD_HEADER)),
        ("ALL_LIGHTS", f64::from(u32::MAX)),
        ("ROW", number(tiles::ROW)),
    ];
    assert_constants(TILES_GLSL, "TILE_", &tiles);
    let layouts = [
        ("AREALIGHT", number(GBufferLayout::Arealight as u32)),
        ("UNREAL", number(GBufferLayout::Unreal as u32)),
        ("UNITY", number(GBufferLayout::Unity as u32)),
        ("OCTAHEDRAL", number(GBufferLayout::Octahedral as u32)),
    ];
    assert_constants(G_BUFFER_GLSL, "G_BUFFER_", &layouts);
    let output = [
        ("ADD", number(Output::Add as u32)),
        ("APART", number(ShadeOptions { separate_lobes: true, ..ShadeOptions::default() }.output_bits())),
        ("HALF", number(RadianceFormat::Rgba16Float as u32)),
    ];
    assert_constants(OUTPUT_TEXEL_GLSL, "OUTPUT_", &output);
    let plain = ShadeOptions::default();
    let camera = [("ORTHOGRAPHIC", number(ShadeOptions { orthographic: true, ..plain }.view_bits()))];
    assert_constants(CAMERA_GLSL, "VIEW_", &camera);
    let view = [
        ("RECTANGLE", number(ShadeOptions { rectangle: true, ..plain }.view_bits())),
        ("STENCIL", number(ShadeOptions { stencil: true, ..plain }.view_bits())),
        ("TEXELS_SHIFT", f64::from(ShadeOptions { texels_per_pixel: 2, ..plain }.view_bits().ilog2())),
    ];
    assert_constants(VIEW_GLSL, "VIEW_", &view);
    let most = number(ShadeOptions::MOST_SHADOW_RAYS);
    assert_constants(SHADOW_PICKS_GLSL, "MOST_SHADOW_RAYS", &[("", most)]);
    let history = [
        ("HEAD", number(arealight::plan::SHADOW_HISTORY_HEAD as u32)),
        ("PIXEL", number(arealight::plan::SHADOW_HISTORY_PIXEL as u32)),
    ];
    assert_constants(SHADOW_HISTORY_GLSL, "HISTORY_", &history);
    let finest = [("HEIGHT", arealight::pyramid::FINEST_HEIGHT)];
    assert_constants(FOOTPRINT_GLSL, "AREALIGHT_FINEST_", &finest);
    assert_constants(TEXTURE_KERNEL_COMP, "FINEST_", &finest);
    assert_constants(IMAGE_LAYERS_GLSL, "IMAGE_", &[("LAYERS", arealight::pyramid::LAYERS.into())]);
    let ends = [
        ("OPEN", number(TubeEnds::Open as u32)),
        ("FLAT", number(TubeEnds::Flat as u32)),
        ("ROUND", number(TubeEnds::Round as u32)),
    ];
    assert_constants(TUBE_OUTLINE_GLSL, "AREALIGHT_TUBE_", &ends);
    let steps = [
        ("RESAMPLING", number(gpu::TextureLoadConstants::RESAMPLE)),
        ("DECODING", number(gpu::TextureLoadConstants::DECODE)),
    ];
    assert_constants(TEXTURE_LOAD_COMP, "STEP_", &steps);
    assert_constants(COMMON_GLSL, "AREALIGHT_MIN_ALPHA", &[("", arealight::MIN_ALPHA)]);
}
