//! The cells of a table's horizons, which tiles are classified with, hold every lookup.

use arealight::TableSample;
use arealight::table::{LobeHorizon, mirror_frame};
use arealight_tests::prelude::*;

/// The last row of the transform into a lobe's cosine space: along the normal of the lobe's horizon.
fn lobe_height(inverse: DMat3) -> DVec3 {
    DVec3::new(inverse.x_axis.z, inverse.y_axis.z, inverse.z_axis.z)
}

/// The normal of a lobe's horizon: its part across the mirror direction over that along it, over the view's
/// sine.
fn ratio(inverse: DMat3, cos_view: f64) -> f64 {
    // In the mirror frame
    let normal = lobe_height(inverse);
    let frame = mirror_frame(cos_view);
    normal.dot(frame.x_axis) / normal.dot(frame.z_axis) / (1.0 - cos_view * cos_view).sqrt()
}

/// Every roughness and view of a grid that no cell of the table has.
fn views() -> impl Iterator<Item = (f64, f64)> {
    let places = || (0..40).map(|step| f64::from(step) / 39.0);
    places().flat_map(move |roughness| places().skip(1).map(move |v| (roughness, 1.0 - v * v)))
}

/// A lookup, and the horizons of the cell that it lies in.
struct Lookup {
    roughness: f64,
    cos_view: f64,
    sample: TableSample,
    horizon: LobeHorizon,
}

/// The built-in table at each of [`views`].
fn looked_up(lobes: SpecularLobes) -> Vec<Lookup> {
    let table = LightTable::ggx();
    let horizons = table.lobe_horizons(lobes);
    let cells = table.size() as usize - 1;
    let view = |(roughness, cos_view): (f64, f64)| {
        let axes = [roughness.max(0.01), (1.0 - cos_view).sqrt()];
        let [x, y] = axes.map(|axis| ((axis * cells as f64) as usize).min(cells - 1));
        let sample = table.lookup(roughness, cos_view);
        Lookup { roughness, cos_view, sample, horizon: horizons[y * cells + x] }
    };
    views().map(view).collect()
}

#[test]
fn every_lookup_lies_within_the_horizons_of_its_cell() {
    for lobes in [SpecularLobes::One, SpecularLobes::Two] {
        let (mut inside, mut near_an_end) = (0, 0);
        for Lookup { roughness, cos_view, sample, horizon } in looked_up(lobes) {
            for reflectance in [0.0, 0.04, 0.5, 1.0] {
                let weight = horizon.weight.map(|weight| f64::from(weight) * (1.0 - reflectance));
                // Of two lobes any part, as the kernel has it
                let part = match lobes {
                    SpecularLobes::One => weight.map(|weight| weight / (reflectance + weight + 1e-30)),
                    SpecularLobes::Two | SpecularLobes::HalfVectors => [0.0, 1.0],
                };
                let mixed = |end: usize, part: f64| {
                    f64::from(horizon.lobe[end]) * (1.0 - part) + f64::from(horizon.schlick[end]) * part
                };
                let low = mixed(0, part[0]).min(mixed(0, part[1]));
                let high = mixed(1, part[0]).max(mixed(1, part[1]));
                for (inverse, _) in used(sample.lobes(lobes, DVec3::splat(reflectance), 1.0)) {
                    let found = ratio(inverse, cos_view);
                    // A cell without a horizon is never above or below anything
                    assert!(
                        !(found < low || found > high),
                        "{roughness}, {cos_view}: {found} in {low}..{high}"
                    );
                    inside += 1;
                    // The twin: half the width would not do
                    let quarter = (high - low) * 0.25;
                    near_an_end += usize::from(found < low + quarter || found > high - quarter);
                }
            }
        }
        assert!(near_an_end > inside / 20, "{lobes:?}: {near_an_end} of {inside}");
    }
}

/// The lobes that reflect something.
fn used(lobes: [(DMat3, DVec3); 2]) -> impl Iterator<Item = (DMat3, DVec3)> {
    lobes.into_iter().filter(|(_, albedo)| albedo.x > 0.0)
}

#[test]
fn no_lobe_is_denser_than_the_envelope_of_its_cell() {
    for lobes in [SpecularLobes::One, SpecularLobes::Two] {
        let (mut all, mut near) = (0, 0);
        for Lookup { roughness, cos_view, sample, horizon } in looked_up(lobes) {
            assert!(sample.schlick <= f64::from(horizon.schlick_albedo));
            let [a, b] = horizon.envelope.map(f64::from);
            for reflectance in [0.0, 0.04, 1.0] {
                for (inverse, _) in used(sample.lobes(lobes, DVec3::splat(reflectance), 1.0)) {
                    let mut closest = 0.0_f64;
                    for step in 0..500 {
                        let (fall, turn) =
                            (2.0 * (f64::from(step) / 499.0).powi(5), 2.39996 * f64::from(step));
                        let sine = (fall * (2.0 - fall)).max(0.0).sqrt();
                        let direction = mirror_frame(cos_view)
                            * DVec3::new(sine * turn.cos(), sine * turn.sin(), 1.0 - fall);
                        let transformed = inverse * direction;
                        let density = inverse.determinant() * transformed.z.max(0.0)
                            / (std::f64::consts::PI * transformed.length_squared().powi(2));
                        // The sine of the elevation above the lobe's horizon
                        let sine = transformed.z.max(1e-9) / lobe_height(inverse).length();
                        closest = closest.max(density * (b + fall).powi(2) / (a * sine));
                    }
                    assert!(closest <= 1.0, "{roughness}, {cos_view}, {reflectance}: {closest}");
                    all += usize::from(roughness >= 0.1);
                    near += usize::from(closest > 0.5);
                }
            }
        }
        // The twin: half of the envelope would not do
        assert!(near > 20, "{near} of {all}");
    }
}
