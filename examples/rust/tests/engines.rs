//! The example engines on a validated device with nothing optional enabled.

use arealight_examples::deferred::Deferred;
use arealight_examples::forward::Forward;
use arealight_examples::host_options;
use arealight_examples::picture::Picture;
use arealight_examples::recorded::Recorded;
use arealight_host::testing::device_of;
use arealight_host::{FRAMES_IN_FLIGHT, Frames, Location, Semaphores};
use ash::vk;
use std::process::Command;

const SIZE: [u32; 2] = [96, 60];

/// The largest difference between two pictures, of a channel.
fn difference(a: &Picture, b: &Picture) -> f32 {
    assert_eq!(a.size, b.size);
    assert_eq!(a.pixels.len() as u32, SIZE[0] * SIZE[1]);
    a.pixels.iter().zip(&b.pixels).map(|(a, b)| (*a - *b).truncate().abs().max_element()).fold(0.0, f32::max)
}

/// How far apart the engines' pictures may be. The deferred one has positions from depth and the inverse of a
/// matrix, the forward one interpolates them: about 1e-6 of the distance each, which the narrowest lobe
/// (alpha 1/16) and the brightest light (6 W/(m² sr)) turn into 6 * 16 * 1e-6 = 1e-4. Normals, colours and
/// roughness are what the G-buffer's formats hold exactly.
const TOLERANCE: f32 = 1e-4;

#[test]
fn both_engines_make_the_same_picture_whatever_they_drew_before() {
    let Some(host) = device_of(&host_options()) else { return };
    let (mut deferred, mut forward) =
        (Deferred::new(&host, SIZE).unwrap(), Forward::new(&host, SIZE).unwrap());
    let mut pictures = |seconds: &[f64]| {
        for &seconds in seconds {
            deferred.frame(seconds, |_| Ok(()), |(), _| Semaphores::default()).unwrap();
            forward.frame(seconds).unwrap();
        }
        (deferred.picture().unwrap(), forward.picture().unwrap())
    };
    let (first, by_forward) = pictures(&[0.5]);
    let apart = difference(&first, &by_forward);
    println!("largest difference: {apart:e}");
    assert!(apart <= TOLERANCE, "{apart:e} apart");
    // The recorder alone makes the same bits, and another picture of another moment
    let mut recorded = Recorded::new(&host, SIZE).unwrap();
    for (seconds, is_same) in [(0.4, false), (0.5, true)] {
        recorded.frame(seconds).unwrap();
        assert_eq!(recorded.picture().unwrap() == first, is_same);
    }

    // There is something to see: panels, what they light, and what they do not
    let brightest = first.pixels.iter().map(|pixel| pixel.max_element()).fold(0.0, f32::max);
    assert!(brightest >= 6.0, "a panel is seen");
    let lit = first.pixels.iter().filter(|pixel| (0.05..5.0).contains(&pixel.y)).count();
    assert!(lit > first.pixels.len() / 3, "{lit} pixels are lit");

    // More frames than are in flight, so that each place is used again, change no bit of the same scene
    let again = pictures(&[0.0, 0.2, 0.4, 0.6, 0.5]);
    assert!(again == (first.clone(), by_forward), "{:e} apart", difference(&again.0, &first));

    // The twin: a light that is a centimetre away from where it was is seen, by either
    let (moved, moved_forward) = pictures(&[0.49]);
    for (a, b) in [(&first, &moved_forward), (&moved, &again.1)] {
        let apart = difference(a, b);
        assert!(apart > 10.0 * TOLERANCE, "{apart:e} apart");
    }

    // Neither do other sizes, larger and smaller, with frames of the size before in flight
    let mut of_size = |size| {
        deferred.resize(size).unwrap();
        deferred.frame(0.5, |_| Ok(()), |(), _| Semaphores::default()).unwrap();
        deferred.picture().unwrap()
    };
    let (large, small) = (of_size([136, 120]), of_size([24, 40]));
    assert_eq!((large.pixels.len(), small.pixels.len()), (136 * 120, 24 * 40));
    assert!(small.pixels != first.pixels[..small.pixels.len()], "it is another picture");
    assert!(of_size(SIZE) == first);
}

#[test]
fn a_frame_that_cannot_be_recorded_keeps_its_place_for_the_next() {
    let Some(host) = device_of(&host_options()) else { return };
    let mut frames = Frames::new(&host).unwrap();
    let buffer = host.buffer("number", 4, vk::BufferUsageFlags::TRANSFER_DST, Location::Readback).unwrap();
    let fill = |commands, number| {
        // SAFETY: the commands are being recorded, and waited for before the buffer goes.
        unsafe { host.device().cmd_fill_buffer(commands, buffer.handle(), 0, 4, number) };
    };
    // More often than frames are in flight, so that each place fails and is used again
    for number in 1..=2 * FRAMES_IN_FLIGHT as u32 {
        let mut places = vec![];
        let failed: arealight_examples::Result<()> = frames.submit(|place, commands| {
            places.push(place);
            fill(commands, 0);
            Err("a light of two vertices".into())
        });
        assert_eq!(failed.unwrap_err().to_string(), "a light of two vertices");
        let recorded: arealight_examples::Result<()> = frames.submit(|place, commands| {
            places.push(place);
            fill(commands, number);
            Ok(())
        });
        recorded.unwrap();
        assert_eq!(places[0], places[1]);
        // Nothing of the frame that failed was run
        frames.wait().unwrap();
        assert_eq!(buffer.download::<u32>().unwrap(), [number]);
    }
}

#[test]
fn the_programs_save_pictures() {
    // For the log, and to be skipped without a device
    let Some(_host) = device_of(&host_options()) else { return };
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
