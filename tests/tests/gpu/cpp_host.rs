//! The host in C++ (examples/cpp) is compiled, runs under validation, and draws what the recorder draws from
//! Rust, to the last bit.

use arealight_capi::AREALIGHT_ABI_VERSION;
use arealight_tests::pass::{run as shade_by, texels};
use arealight_tests::prelude::*;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SIZE: [u32; 2] = [256, 160];

/// The lights' origin, where the camera is.
const CAMERA: DVec3 = DVec3::new(1000.0, 1.5, -2000.0);

/// The shared library that this test was built with.
fn library() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().join("libarealight_capi.so")
}

/// Compiles the host against it, and puts the library into the folder as a loader looks for it.
fn compile(folder: &Path) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let name = format!("libarealight_capi.so.{AREALIGHT_ABI_VERSION}");
    std::os::unix::fs::symlink(library(), folder.join(name)).unwrap();
    let program = folder.join("host");
    let output = Command::new("c++")
        // Numbers as they are written, as in Rust: no product and sum is fused
        .args(
            "-std=c++14 -O1 -ffp-contract=off -Wall -Wextra -Wno-missing-field-initializers -Werror"
                .split(' '),
        )
        .arg("-I")
        .arg(root.join("crates/arealight-capi/include"))
        .arg(root.join("examples/cpp/host.cpp"))
        .arg(library())
        .arg("-lvulkan")
        .arg("-o")
        .arg(&program)
        .output()
        .expect("a C++ compiler");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "needs libvulkan-dev (tools/setup.sh test):\n{said}");
    program
}

/// What the host draws with more arguments, under either kind of validation.
fn drawn(more: &[&str]) -> Vec<[f32; 3]> {
    let folder = tempfile::tempdir().unwrap();
    let program = compile(folder.path());
    let picture = folder.path().join("picture.pfm");
    for validation in ["synchronization", "gpu-assisted"] {
        let output = run(&program, &picture, validation, more);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    read_picture(&picture)
}

fn run(program: &Path, picture: &Path, validation: &str, more: &[&str]) -> Output {
    let mut command = Command::new(program);
    // Cargo has its own, where an earlier build may be
    command.env("LD_LIBRARY_PATH", program.parent().unwrap());
    command.arg(picture).args(["--validate", validation]).args(more).output().expect("the program starts")
}

/// The radiance that a Portable Float Map holds: three channels, rows from the top.
fn read_picture(path: &Path) -> Vec<[f32; 3]> {
    let bytes = std::fs::read(path).unwrap();
    let header = format!("PF\n{} {}\n-1.0\n", SIZE[0], SIZE[1]);
    let texels = bytes.strip_prefix(header.as_bytes()).expect("the header");
    let texel = |bytes: &[u8]| [0, 4, 8].map(|i| f32::from_le_bytes(bytes[i..i + 4].try_into().unwrap()));
    let rows: Vec<&[u8]> = texels.chunks_exact(SIZE[0] as usize * 12).collect();
    assert_eq!(rows.len(), SIZE[1] as usize);
    rows.into_iter().rev().flat_map(|row| row.chunks_exact(12).map(texel)).collect()
}

/// The lights of the host.
fn lights() -> [Light; 4] {
    let light = |name: &str, vertices: &[[f64; 3]], radiance, two_sided| Light {
        name: name.into(),
        radiance: Vec3::from_array(radiance),
        two_sided,
        shape: LightShape::Polygon(vertices.iter().map(|vertex| DVec3::from_array(*vertex)).collect()),
        ..Light::default()
    };
    let window = [[994.0, 0.2, -2011.0], [998.0, 0.2, -2012.0], [998.0, 3.2, -2012.0], [994.0, 3.2, -2011.0]];
    let sign = [[1003.0, 0.1, -2010.0], [1006.0, 0.1, -2008.0], [1004.5, 2.1, -2009.0]];
    let arrow = [
        [999.0, 0.5, -2009.0],
        [1002.0, 0.5, -2009.0],
        [1002.0, 2.0, -2009.0],
        [1000.5, 1.0, -2009.0],
        [999.0, 2.0, -2009.0],
    ];
    [
        light("window", &window, [3.0, 3.5, 4.0], false),
        light("sign", &sign, [6.0, 1.0, 0.5], true),
        light("arrow", &arrow, [0.5, 5.0, 1.0], false),
        Light {
            name: "lamp".into(),
            radiance: Vec3::new(8.0, 6.0, 2.0),
            shape: LightShape::Sphere { center: DVec3::new(996.0, 0.5, -2007.0), radius: 0.3 },
            ..Light::default()
        },
    ]
}

/// A texel of the host's G-buffer.
fn texel(plane: Plane, [x, y]: [u32; 2]) -> Option<Vec4> {
    let [width, height] = SIZE.map(|side| side as f32);
    let right = (x as f32 + 0.5) / width * 2.0 - 1.0;
    let up = 0.4 - (y as f32 + 0.5) / height;
    let hit = up < 0.0;
    let distance = if hit { 1.5 / -up } else { 0.0 };
    match plane {
        Plane::Position => {
            Some(Vec4::new(right * distance, up * distance, -1.5 * distance, f32::from(u8::from(hit))))
        }
        Plane::Normal => Some(Vec3::Y.extend(0.05 + 0.9 * (x as f32 / width))),
        _ => None,
    }
}

/// The same picture by the recorder's Rust interface.
fn draw(engine: &TestEngine, lights: &[Light]) -> Vec<[f32; 3]> {
    let colors: Vec<_> =
        texels(SIZE).map(|[_, y]| [200_u8, 180, 150, if y / 16 % 2 == 1 { 255 } else { 0 }]).collect();
    let (bytes, sampled) = (vk::Format::R8G8B8A8_UNORM, vk::ImageUsageFlags::SAMPLED);
    let base_color = image(engine, SIZE, bytes, sampled, &colors);
    let (planes, radiance) = (planes(engine, SIZE, &texel), radiance(engine, SIZE, Vec4::NAN));
    let lights = LightBuffers::new(engine, lights, CAMERA);
    let resources = ShadeResources {
        planes: reads(&planes).with(Plane::BaseColor, Some(read(&base_color))),
        radiance: store(&radiance),
        ..lights.resources(engine)
    };
    let pass = engine.pass(ShadeOptions::default()).unwrap();
    shade_by(engine, &pass, &resources, SIZE, &[lights.frame(SIZE, Vec3::ZERO)], Descriptors::Sets);
    stored_in(&radiance).into_iter().map(|texel| texel.truncate().to_array()).collect()
}

/// How many texels differ in any bit.
fn differing(a: &[[f32; 3]], b: &[[f32; 3]]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.map(f32::to_bits) != b.map(f32::to_bits)).count()
}

#[test]
fn cpp_draws_what_rust_draws_to_the_last_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let (cpp, rust) = (drawn(&[]), draw(&engine, &lights()));
    assert_eq!([differing(&cpp, &rust), differing(&drawn(&["--recorder"]), &rust)], [0; 2]);

    // The picture shows something, and a light that is a little brighter shows in it
    let lit = rust.iter().filter(|texel| texel.iter().any(|channel| *channel > 0.1)).count();
    assert!(lit > 5000, "{lit} texels are lit");
    let mut others = lights();
    others[2].radiance.y = others[2].radiance.y.next_up();
    let changed = differing(&cpp, &draw(&engine, &others));
    assert!(changed > 1000, "{changed} texels differ");
}

#[test]
fn cpp_draws_the_same_with_tiles() {
    let Some(engine) = TestEngine::new() else { return };
    let tiled = drawn(&["--tiles"]);
    assert_eq!(differing(&tiled, &drawn(&["--tiles", "--recorder"])), 0);
    // Lights that are left out contribute nothing, which the quality level may round to 1e-6 of their
    // radiance: of all 16
    let is_same = |other: &[[f32; 3]]| {
        tiled.iter().flatten().zip(other.iter().flatten()).all(|(a, b)| (a - b).abs() <= 16e-6)
    };
    assert!(is_same(&draw(&engine, &lights())));
    // The twin: a light that is a hundredth brighter shows
    let mut others = lights();
    others[2].radiance.y *= 1.01;
    assert!(!is_same(&draw(&engine, &others)));
}

#[test]
fn a_mistake_of_the_cpp_host_fails_it() {
    // Skipped where the other is
    let Some(_engine) = TestEngine::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let program = compile(folder.path());
    let output = run(&program, &folder.path().join("picture.pfm"), "core", &["--mistake"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("VUID-") && said.contains("error: the validation layer has"), "{said}");
}
