//! Cost of the shade pass's levels and of the reference, in GPU time of one frame of the room.
//!
//! Read the numbers as ratios within one run: `cargo bench -p arealight-benches --bench shade`. The yardstick
//! is `exact`; `reference` is one Monte Carlo sample a pixel of the true BRDF.

use arealight::{Effects, FormFactor, Horizon, Lobes, Quality, SpecularLobes};
use arealight_engine::{Engine, Host, HostOptions, Reference, SceneRenderer};
use arealight_scene::{Scene, SceneBuffers};
use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use std::path::Path;
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [320, 180];

/// The sum of `count` runs' GPU times; wall time where the queue has no timestamps.
fn repeat(count: u64, mut run: impl FnMut() -> Option<Duration>) -> Duration {
    (0..count)
        .map(|_| {
            let start = Instant::now();
            run().unwrap_or_else(|| start.elapsed())
        })
        .sum()
}

fn shade(criterion: &mut Criterion) {
    let host = match Host::new(HostOptions::default()) {
        Ok(host) => host,
        Err(error) => {
            eprintln!("skipped: {error}");
            return;
        }
    };
    let table = arealight::LightTable::ggx();
    let engine = Engine::new(host, &table, arealight_vk::TableFormat::default()).expect("the table uploads");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/room.glb");
    let scene = Scene::load(path).expect("our own scene loads");
    let camera = scene.camera(None, f64::from(SIZE[0]) / f64::from(SIZE[1])).expect("it has a camera");
    let buffers = SceneBuffers::new(&scene, camera.position).expect("it fits");
    let constants = buffers.constants(&camera, SIZE, Vec3::ZERO);
    let mut renderer =
        SceneRenderer::new(&engine, &buffers, &scene.lights, constants, SIZE).expect("it fits");
    renderer.visibility().expect("the device works");

    let exact = Quality::default();
    let effects = scene.effects();
    let mut group = criterion.benchmark_group("shade");
    group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
    for (name, effects, quality) in [
        ("exact", effects, exact),
        ("difference", effects, Quality { form_factor: FormFactor::Difference, ..exact }),
        ("exact, both horizons", effects, Quality { horizon: Horizon::Both, ..exact }),
        ("exact, two lobes", effects, Quality { specular_lobes: SpecularLobes::Two, ..exact }),
        // The difference is what the table's lookup costs
        ("exact, lobes by formula", effects, Quality { lobes: Lobes::Formula, ..exact }),
        ("exact, diffuse only", effects - Effects::GLOSSY, exact),
        ("exact, every effect", Effects::all(), exact),
    ] {
        group.bench_function(name, |bencher| {
            bencher.iter_custom(|count| {
                repeat(count, || renderer.shade(effects, quality).expect("the device works"))
            });
        });
    }
    group.bench_function("reference", |bencher| {
        bencher.iter_custom(|count| {
            repeat(count, || {
                renderer
                    .reference(Reference { samples: 1, ..Reference::default() }, |_| {})
                    .expect("the device works")
            })
        });
    });
    group.finish();
}

criterion_group!(benches, shade);
criterion_main!(benches);
