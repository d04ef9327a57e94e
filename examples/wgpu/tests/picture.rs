//! The picture that wgpu and the recorder make together, held against that of the engine in examples/rust,
//! which draws by Vulkan itself.

use arealight_examples::deferred::Deferred;
use arealight_examples::host_options;
use arealight_examples::picture::Picture;
use arealight_host::{Host, Semaphores};
use arealight_wgpu_example::{Gpu, draw};

const SIZE: [u32; 2] = [160, 100];

/// Pictures may be so far apart: that of positions that are made of depth, as between the engines of
/// examples/rust.
const TOLERANCE: f32 = 1e-4;

fn of_rust_example(seconds: f64) -> Picture {
    let host = Host::new(host_options()).unwrap();
    let mut engine = Deferred::new(&host, SIZE).unwrap();
    engine.frame(seconds, |_| Ok(()), |(), _| Semaphores::default()).unwrap();
    engine.picture().unwrap()
}

/// The largest difference of a channel.
fn difference(a: &Picture, b: &Picture) -> f32 {
    assert_eq!(a.size, b.size);
    a.pixels.iter().zip(&b.pixels).map(|(a, b)| (*a - *b).truncate().abs().max_element()).fold(0.0, f32::max)
}

#[test]
fn wgpu_and_the_recorder_make_the_picture_of_the_rust_example() {
    let gpu = Gpu::new().expect("a Vulkan device: tools/setup.sh test installs one that computes on the CPU");
    let picture = draw(&gpu, SIZE, 0.5).unwrap();
    let apart = difference(&picture, &of_rust_example(0.5));
    println!("largest difference: {apart:e}");
    assert!(apart <= TOLERANCE, "{apart:e} apart");
    let lit = picture.pixels.iter().filter(|pixel| (0.05..5.0).contains(&pixel.y)).count();
    assert!(lit > picture.pixels.len() / 3, "{lit} pixels are lit");

    // The twin: a light that is a centimetre away from where it was
    let apart = difference(&picture, &of_rust_example(0.49));
    assert!(apart > 10.0 * TOLERANCE, "{apart:e} apart");
}
