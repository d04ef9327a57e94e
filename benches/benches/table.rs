//! Cost of the table lookup that the processor makes, beside a lookup of one texel:
//! `cargo bench -p arealight-benches --bench table`. (What it costs on the device is in the bench `shade`:
//! exact, less exact with lobes by formula.)

use arealight_oracle::stream::Stream;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// Lookups an iteration.
const COUNT: usize = 1024;

fn table(criterion: &mut Criterion) {
    let table = arealight::LightTable::ggx();
    let mut random = Stream::new("lookups", 0, 0);
    let places: Vec<[f64; 2]> = (0..COUNT).map(|_| [random.unit(), random.unit()]).collect();
    let mut group = criterion.benchmark_group("table lookup");
    // The yardstick: the same texels' nearest, unfiltered
    group.bench_function("nearest texel", |bencher| {
        let (size, matrix) = (table.size() as usize, table.matrix());
        let last = (size - 1) as f64;
        bencher.iter(|| {
            for [roughness, cos_view] in &places {
                let [x, y] = [roughness * last, (1.0 - cos_view).sqrt() * last].map(|at| at.round() as usize);
                black_box(matrix[y * size + x]);
            }
        });
    });
    group.bench_function("lookup", |bencher| {
        bencher.iter(|| {
            for [roughness, cos_view] in &places {
                black_box(table.lookup(*roughness, *cos_view));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, table);
criterion_main!(benches);
