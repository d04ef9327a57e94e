//! Modules without what specialisation constants rule out, held against whole ones.

use arealight::TileClass;
use arealight::kernels::{self, Kernel, constant};
use arealight::plan::shade_specialization;
use arealight_tests::frame::bits;
use arealight_tests::kernel::BRANCHES;
use arealight_tests::prelude::*;
use arealight_tests::spirv::{tool, words};
use arealight_vk::prune;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What branches.comp is to write for a number.
fn branches(x: u32, flags: u32, level: i32, switch: bool) -> [u32; 10] {
    let by_flags = |x: u32, flags: u32| {
        x + if flags & 1 != 0 { 10 } else { 0 } + if flags & 2 != 0 && x > 2 { 100 } else { 0 }
    };
    let changed = if x > 3 { flags ^ 1 } else { flags };
    let by_changed = if changed & 1 != 0 { x + 1 } else { x + 1000 };
    let mut by_loop = 0;
    for i in 0..x {
        if level == 1 && i == 2 {
            break;
        }
        if level != 2 {
            by_loop += i + 1;
        }
    }
    loop {
        by_loop += 7;
        if flags & 2 != 0 || !(level == 3 && by_loop < 100) {
            break;
        }
    }
    let replaced = if level == 2 { 1 } else { level };
    let by_choice = |flags: u32| if replaced == 1 { by_flags(x, flags) } else { x + 20_000 };
    let element = if x & 1 == 0 { x } else { flags };
    let by_switch = match (level, x) {
        (0, _) => x + 1,
        (1, 4..) => x + 2,
        (1, _) => x + 14,
        _ => x + 8,
    };
    let is_set = if switch { flags & 1 != 0 } else { level > 1 };
    let nested = match (switch, level) {
        (true, _) => x + 50,
        (false, 3) => x + 60,
        (false, _) => x + 70,
    };
    [
        by_flags(x, flags),
        by_flags(x, flags ^ 1) + by_changed,
        x * if flags & 1 != 0 { 3 } else { 5 },
        by_loop,
        by_choice(flags),
        by_choice(flags | 1),
        by_flags(x, if x.is_multiple_of(2) { 0 } else { flags }),
        by_flags(x, if x > 4 { 2 } else { 1 }) + by_flags(x, element),
        by_switch,
        if is_set { nested } else { x + 7 },
    ]
}

#[test]
fn branches_that_stay_are_those_that_are_taken() {
    let (Some(pruning), Some(whole)) = (TestEngine::new(), TestEngine::with_whole_modules()) else { return };
    let arguments: Vec<u32> = (0..8).collect();
    let run = |engine: &TestEngine, specialization: &[(u32, u32)]| -> Vec<[u32; 10]> {
        let buffer = engine.host().storage_buffer("arguments", &arguments).unwrap();
        let inputs = [Resource::buffer(buffer.handle())];
        engine.dispatch(&BRANCHES, specialization, &inputs, arguments.len())
    };
    let mut different = BTreeSet::new();
    for (flags, level, switch) in
        (0..4).flat_map(|flags| (0..4).flat_map(move |level| [(flags, level, false), (flags, level, true)]))
    {
        let specialization = [(0, flags), (1, level), (2, u32::from(switch))];
        let expected: Vec<_> =
            arguments.iter().map(|x| branches(*x, flags, level.cast_signed(), switch)).collect();
        assert_eq!(run(&pruning, &specialization), expected, "{specialization:?}");
        assert_eq!(run(&whole, &specialization), expected, "whole, {specialization:?}");
        assert!(prune(&BRANCHES.words(), &specialization).len() < BRANCHES.words().len());
        different.insert(expected);
    }
    // The twin: specialisations are told from each other
    assert!(different.len() >= 28, "{}", different.len());
}

/// The shade kernel's, for surfaces and lights that need `effects`, with quads among them.
fn shade(effects: Effects, quality: Quality) -> Vec<(u32, u32)> {
    let options = ShadeOptions { surfaces: effects, quality, ..ShadeOptions::default() };
    shade_specialization(options, LightSummary { quad_count: 1, effects, ..LightSummary::default() })
}

/// The specialisations that are looked at: each effect by itself and all, each level, and each class of
/// tiles.
fn specializations(kernel: &Kernel) -> Vec<Vec<(u32, u32)>> {
    let lobes = Effects::DIFFUSE | Effects::GLOSSY;
    let plain = Quality::default();
    let mut all = vec![shade(Effects::empty(), plain), shade(lobes, plain), shade(Effects::all(), plain)];
    all.extend(Effects::all().iter().map(|effect| shade(lobes | effect, plain)));
    for quality in [
        Quality { horizon: Horizon::Both, ..plain },
        Quality { specular_lobes: SpecularLobes::Two, ..plain },
        Quality { specular_lobes: SpecularLobes::HalfVectors, ..plain },
        Quality { footprint: Footprint::Mips, ..plain },
    ] {
        all.push(shade(Effects::all(), quality));
    }
    for class in TileClass::ALL {
        let mut values = shade(lobes, plain);
        values.retain(|(id, _)| *id != constant::CLASS);
        values.push((constant::CLASS, class as u32));
        all.push(values);
    }
    let has = |(id, _): &(u32, u32)| kernel.constants().contains(id);
    let mut kept: Vec<Vec<_>> =
        all.into_iter().map(|pairs| pairs.into_iter().filter(has).collect()).collect();
    kept.push(Vec::new());
    kept.sort();
    kept.dedup();
    kept
}

/// What `spirv-val` says against a module; none where the tool is missing.
fn validated(module: &[u32]) -> Option<Result<(), String>> {
    let bytes: Vec<u8> = module.iter().flat_map(|word| word.to_le_bytes()).collect();
    let output = tool("spirv-val", &["--target-env", "vulkan1.1", "-"], &bytes)?;
    let faults = || String::from_utf8_lossy(&output.stderr).into_owned();
    Some(if output.status.success() { Ok(()) } else { Err(faults()) })
}

fn check_valid(module: &[u32], what: &str) {
    if let Some(found) = validated(module) {
        assert_eq!(found, Ok(()), "{what}");
    }
}

#[test]
fn every_kernel_stays_valid_however_it_is_specialised() {
    for kernel in kernels::ALL.into_iter().chain(arealight_tool_kernels::kernels::ALL) {
        let whole = kernel.words();
        for specialization in specializations(kernel) {
            let pruned = prune(&whole, &specialization);
            check_valid(&pruned, &format!("{}, {specialization:?}", kernel.name));
            assert!(pruned.len() <= whole.len());
        }
    }
    // The twin: what is not valid is seen
    let mut broken = prune(&kernels::TEXTURE_MIP.words(), &[]);
    broken.pop();
    if let Some(found) = validated(&broken) {
        assert!(found.is_err());
    }
}

#[test]
fn a_fragment_shader_that_includes_the_library_is_pruned_too() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/rust/spirv/forward.frag.spv");
    let whole = words(&std::fs::read(file).expect("the example's shader"));
    let pruned = prune(&whole, &[]);
    check_valid(&pruned, "the example's shader");
    // Its effects and its quality are constants: a third goes
    assert!(pruned.len() * 4 < whole.len() * 3, "{} of {}", pruned.len(), whole.len());
}

#[test]
fn what_is_not_in_use_is_left_out() {
    let words = kernels::SHADE.words();
    let left = |effects: Effects| prune(&words, &shade(effects, Quality::default())).len();
    let lobes = Effects::DIFFUSE | Effects::GLOSSY;
    // A third of the module is left where all lights are quads (names and constants stay), and each effect
    // adds to that
    assert!(left(lobes) * 3 < words.len(), "{} of {}", left(lobes), words.len());
    for effect in [Effects::POLYGON, Effects::TEXTURED, Effects::ELLIPSE, Effects::SPHERE, Effects::TUBE] {
        assert!(left(lobes | effect) > left(lobes) + 300, "{effect:?}");
    }
}

/// The names of a module's functions.
fn function_names(module: &[u32]) -> BTreeSet<String> {
    const NAME: u32 = 5;
    const FUNCTION: u32 = 54;
    let (mut names, mut functions) = (BTreeMap::new(), BTreeSet::new());
    let mut rest = &module[5..];
    while let [first, ..] = rest {
        let (instruction, next) = rest.split_at((first >> 16) as usize);
        match first & 0xffff {
            NAME => {
                let bytes: Vec<u8> = instruction[2..].iter().flat_map(|word| word.to_le_bytes()).collect();
                let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
                names.insert(instruction[1], String::from_utf8_lossy(&bytes[..end]).into_owned());
            }
            FUNCTION => {
                functions.insert(instruction[2]);
            }
            _ => {}
        }
        rest = next;
    }
    functions.iter().filter_map(|id| names.get(id).cloned()).collect()
}

/// Every set of kinds of light has a module of its own, without a function of the kinds that it lacks.
#[test]
fn each_set_of_lights_has_a_module_of_its_own() {
    // Of each kind what the names of its functions alone contain. Textured polygons are shaded by the polygon
    // loop
    let kinds = [
        (Effects::TEXTURED, "arealight_bridge_light_texture("),
        (Effects::POLYGON | Effects::MESH, "struct-ArealightMeshLight"),
        (Effects::SHAPED, "struct-ArealightShapedLight"),
        (Effects::ELLIPSE, "struct-ArealightDiskLight"),
        (Effects::SPHERE, "struct-ArealightSphereLight"),
        (Effects::TUBE, "struct-ArealightTubeLight"),
    ];
    let whole = kernels::SHADE.words();
    let mut modules = BTreeSet::new();
    for set in 0..1_u32 << kinds.len() {
        let chosen = || kinds.iter().enumerate().filter(|(bit, _)| set >> bit & 1 == 1).map(|(_, kind)| kind);
        let effects = chosen().fold(Effects::DIFFUSE | Effects::GLOSSY, |all, (effect, _)| all | *effect);
        let module = prune(&whole, &shade(effects, Quality::default()));
        let functions = function_names(&module);
        for (effect, function) in kinds {
            let is_there = functions.iter().any(|name| name.contains(function));
            assert_eq!(is_there, effects.contains(effect), "{function} with {effects}: {functions:?}");
        }
        assert!(modules.insert(module), "another set has the module of {effects}");
    }
}

/// The bits of a picture of one of our scenes.
fn picture(engine: &TestEngine, name: &str, quality: Quality) -> Vec<[u32; 4]> {
    let scene = scene(name);
    let options = ShadeOptions { surfaces: scene.effects(), quality, ..ShadeOptions::default() };
    with_renderer(engine, &scene, &scene.lights, [61, 37], |renderer| {
        let specialization = shade_specialization(options, renderer.lights());
        renderer.shade_by(&kernels::SHADE, &specialization).unwrap();
        bits(renderer)
    })
}

#[test]
fn pictures_are_the_same_to_the_bit() {
    let (Some(pruning), Some(whole)) = (TestEngine::new(), TestEngine::with_whole_modules()) else { return };
    let split = Quality { horizon: Horizon::Both, specular_lobes: SpecularLobes::Two, ..Quality::default() };
    // A driver takes minutes, and gigabytes, for a module of everything: in the short form one scene
    let is_long = std::env::var("AREALIGHT_LONG").is_ok_and(|value| value == "1");
    let scenes = [("shapes.glb", split), ("demo.glb", Quality::default())];
    for (scene, quality) in scenes.into_iter().skip(usize::from(!is_long)) {
        let pictures = [&pruning, &whole].map(|engine| picture(engine, scene, quality));
        assert!(pictures[0] == pictures[1], "{scene}");
        // The twin: another quality level is another picture
        let other = Quality { lobes: Lobes::Formula, ..quality };
        assert!(pictures[0] != picture(&pruning, scene, other), "{scene}: the twin is the same");
    }
}

#[test]
fn what_is_not_understood_is_left_as_it_is() {
    let words = BRANCHES.words();
    let specialization = [(0, 0), (1, 0), (2, 0)];
    assert!(prune(&words, &specialization) != words, "the twin: this is understood");

    // Debug information that speaks of functions: an import in the place of GLSL.std.450, of as many words
    let name = |text: &[u8; 12]| [0, 4, 8].map(|at| u32::from_le_bytes(text[at..at + 4].try_into().unwrap()));
    let shade = kernels::SHADE.words();
    let at = shade.windows(3).position(|window| window == name(b"GLSL.std.450")).expect("the import");
    let mut foreign = shade.clone();
    foreign[at..at + 3].copy_from_slice(&name(b"NonSemantic."));
    assert!(prune(&foreign, &[]) == foreign);

    // What is no module
    for broken in [&[][..], &[0x0723_0203], &[1, 2, 3, 4, 5, 6, 7], &words[..4]] {
        assert!(prune(broken, &specialization) == broken);
    }
    // And what is nearly one: no panic, whatever comes of it
    for cut in 5..words.len() {
        prune(&words[..cut], &specialization);
    }
    for place in 5..words.len() {
        for change in [1, 0x1_0000, 0xffff] {
            let mut changed = words.clone();
            changed[place] ^= change;
            prune(&changed, &specialization);
        }
    }
}
