//! `COLOR_0`: of floats or fractions of integers, with alpha or without.

use crate::{error, load, panel_with, warnings};
use arealight_scene::{Scene, SceneBuffers, Triangle};
use arealight_tool_kernels::gpu::GpuTriangle;
use glam::DVec3;
use serde_json::{Value, json};

/// A panel whose four vertices have colours of an accessor.
fn colored(accessor: impl FnOnce(&mut crate::writer::Writer) -> usize) -> crate::writer::Writer {
    let mut writer = panel_with(json!({}));
    let colors = accessor(&mut writer);
    writer.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    writer
}

/// The colours of the panel's vertices, each once, in linear parts.
fn linear(scene: &Scene) -> Vec<[f64; 4]> {
    let square = |byte: u8| (f64::from(byte) / 255.0).powi(2);
    let corners = scene.triangles.iter().flat_map(|triangle| triangle.colors);
    let colors = corners.map(|[r, g, b, a]| [square(r), square(g), square(b), f64::from(a) / 255.0]);
    colors.collect()
}

#[test]
fn colours_are_the_file_s() {
    let rows = [[0.25_f32, 0.5, 1.0, 1.0], [0.001, 0.0, 2.0, 0.5], [0.0; 4], [1.0; 4]];
    let with_alpha = load(colored(|writer| writer.floats(&rows)));
    let opaque = rows.map(|[r, g, b, _]| [r, g, b]);
    let without = load(colored(|writer| writer.floats(&opaque)));
    assert_eq!((warnings(&with_alpha), warnings(&without)), (vec![], vec![]));
    let corners = crate::shapes::panel(2.0, 1.0).indices;
    for (scene, has_alpha) in [(&with_alpha, true), (&without, false)] {
        for (found, &vertex) in linear(scene).iter().zip(&corners) {
            let [r, g, b, a] = rows[vertex as usize].map(f64::from);
            let expected = [r, g, b.min(1.0), if has_alpha { a } else { 1.0 }];
            for (found, expected) in found.iter().zip(expected) {
                // The root is off by a 510th, and its square is off by that too
                let tolerance = expected.sqrt() / 255.0 + (1.0_f64 / 510.0).powi(2) + 1e-7;
                assert!((found - expected).abs() <= tolerance, "{found}, not {expected}");
            }
        }
    }
    // A dark colour is not black
    assert!(linear(&with_alpha).iter().any(|color| (0.0008..0.0012).contains(&color[0])));
}

#[test]
fn white_costs_the_kernel_nothing() {
    let flags = |scene: &Scene| -> Vec<bool> {
        let buffers = SceneBuffers::new(scene, DVec3::ZERO).unwrap();
        buffers.triangles.iter().map(|triangle| triangle.flags & GpuTriangle::COLORS != 0).collect()
    };
    let plain = load(panel_with(json!({})));
    assert!(plain.triangles.iter().all(|triangle| triangle.colors == [Triangle::WHITE; 3]));
    assert_eq!(flags(&plain), [false; 2]);
    assert_eq!(flags(&load(colored(|writer| writer.floats(&[[1.0_f32; 3]; 4])))), [false; 2]);
    assert_eq!(flags(&load(colored(|writer| writer.floats(&[[0.5_f32; 3]; 4])))), [true; 2]);
}

#[test]
fn wrong_colours_are_refused_by_name() {
    let refused = |rows: Value| {
        error(colored(|writer| {
            let rows: Vec<[f32; 3]> = serde_json::from_value(rows).unwrap();
            writer.floats(&rows)
        }))
    };
    assert!(refused(json!([[1.0, 1.0, 1.0]])).contains("COLOR_0: 1 for 4 positions"));
    let text = error(colored(|writer| writer.floats(&[[f32::NAN; 3]; 4])));
    assert!(text.contains("COLOR_0[0]"), "{text}");
    let text = error(colored(|writer| writer.floats(&[[1.0_f32; 2]; 4])));
    assert!(text.contains("COLOR_0"), "{text}");
}
