//! The example engines on a validated device with nothing optional enabled.

use arealight_examples::Result;
use arealight_examples::deferred::Deferred;
use arealight_examples::forward::Forward;
use arealight_examples::gpu::Gpu;
use arealight_examples::picture::Picture;
use arealight_host::testing::instance_or_skip;
use std::process::Command;

const SIZE: [u32; 2] = [96, 60];

/// Frames after these seconds, one behind the other; the last one's picture.
fn deferred(gpu: &Gpu<'_>, seconds: &[f64]) -> Result<Picture> {
    let mut engine = Deferred::new(gpu, SIZE)?;
    for &seconds in seconds {
        engine.frame(seconds)?;
    }
    engine.picture()
}

fn forward(gpu: &Gpu<'_>, seconds: &[f64]) -> Result<Picture> {
    let mut engine = Forward::new(gpu, SIZE)?;
    for &seconds in seconds {
        engine.frame(seconds)?;
    }
    engine.picture()
}

/// The largest difference between two pictures, of a channel.
fn difference(a: &Picture, b: &Picture) -> f32 {
    assert_eq!(a.size, b.size);
    assert_eq!(a.pixels.len() as u32, SIZE[0] * SIZE[1]);
    a.pixels.iter().zip(&b.pixels).map(|(a, b)| (*a - *b).truncate().abs().max_element()).fold(0.0, f32::max)
}

/// How far apart the engines' pictures may be. The deferred one has positions from depth and the inverse of a matrix,
/// the forward one interpolates them: about 1e-6 of the distance each, which the narrowest lobe (alpha 1/16) and the
/// brightest light (6 W/(m² sr)) turn into 6 * 16 * 1e-6 = 1e-4. Normals, colours and roughness are what the G-buffer's
/// formats hold exactly.
const TOLERANCE: f32 = 1e-4;

#[test]
fn both_engines_make_the_same_picture() {
    let Some(instance) = instance_or_skip() else { return };
    let gpu = Gpu::new(&instance).unwrap();
    // More frames than are in flight, so that each place is used again
    let seconds = [0.0, 0.2, 0.4, 0.6, 0.8];
    let (deferred, forward) = (deferred(&gpu, &seconds).unwrap(), forward(&gpu, &seconds).unwrap());
    let apart = difference(&deferred, &forward);
    println!("largest difference: {apart:e}");
    assert!(apart <= TOLERANCE, "{apart:e} apart");

    // There is something to see: panels, what they light, and what they do not
    let brightest = deferred.pixels.iter().map(|pixel| pixel.max_element()).fold(0.0, f32::max);
    assert!(brightest >= 6.0, "a panel is seen");
    let lit = deferred.pixels.iter().filter(|pixel| (0.05..5.0).contains(&pixel.y)).count();
    assert!(lit > deferred.pixels.len() / 3, "{lit} pixels are lit");
}

#[test]
fn a_light_elsewhere_makes_another_picture() {
    let Some(instance) = instance_or_skip() else { return };
    let gpu = Gpu::new(&instance).unwrap();
    // The twin of the comparison above: it sees a light that is 16 mm away from where it should be
    let (deferred, forward) = (deferred(&gpu, &[0.5]).unwrap(), forward(&gpu, &[0.515]).unwrap());
    let apart = difference(&deferred, &forward);
    assert!(apart > 10.0 * TOLERANCE, "{apart:e} apart");
}

#[test]
fn frames_in_flight_do_not_disturb_each_other() {
    let Some(instance) = instance_or_skip() else { return };
    let gpu = Gpu::new(&instance).unwrap();
    let alone = deferred(&gpu, &[0.7]).unwrap();
    let behind_others = deferred(&gpu, &[0.1, 0.3, 0.5, 0.7]).unwrap();
    assert!(alone == behind_others, "{:e} apart", difference(&alone, &behind_others));
    let alone = forward(&gpu, &[0.7]).unwrap();
    let behind_others = forward(&gpu, &[0.1, 0.3, 0.5, 0.7]).unwrap();
    assert!(alone == behind_others, "{:e} apart", difference(&alone, &behind_others));
}

#[test]
fn the_programs_save_pictures() {
    // For the log, and to be skipped without a device
    let Some(_instance) = instance_or_skip() else { return };
    let folder = tempfile::tempdir().unwrap();
    for program in [env!("CARGO_BIN_EXE_deferred"), env!("CARGO_BIN_EXE_forward")] {
        let path = folder.path().join("picture.png");
        let output = Command::new(program).arg(&path).args(["32", "20"]).output().unwrap();
        assert!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(&bytes[..4], b"\x89PNG");
        std::fs::remove_file(path).unwrap();
        assert!(!Command::new(program).arg("--help").output().unwrap().status.success());
    }
}
