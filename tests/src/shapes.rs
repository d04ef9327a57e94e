//! The kernel that evaluates shapes, on the tests' engine.

use crate::TestEngine;
pub use arealight_benches::shapes::{
    SHAPES, ShapeArguments, ShapeFunction, ellipse_arguments, lobe_arguments, sphere_arguments,
    tube_arguments,
};
use arealight_oracle::ellipse::Ellipse;
use arealight_oracle::tube::Ends;
use arealight_vk::Resource;

impl TestEngine {
    /// What a white lobe reflects of ellipses and of spheres, clipped at a horizon (`AREALIGHT_HORIZON_*`).
    pub fn lobes(&self, horizon: u32, arguments: &[ShapeArguments]) -> Vec<[f32; 2]> {
        let constants = [(0, ShapeFunction::Lobe as u32), (1, horizon)];
        let found = self.call(&constants, arguments, &vec![0; arguments.len()]);
        found.iter().map(|r| [r[0], r[1]]).collect()
    }

    /// Form factors of tubes with their ends; cut by a surface whose normal is z where asked for.
    pub fn tubes(&self, cut: bool, arguments: &[ShapeArguments], ends: &[Ends]) -> Vec<f32> {
        let constants = [(0, ShapeFunction::Tube as u32), (1, u32::from(cut))];
        let ends: Vec<u32> = ends.iter().map(|ends| *ends as u32).collect();
        self.call(&constants, arguments, &ends).iter().map(|r| r[0]).collect()
    }

    fn call(&self, constants: &[(u32, u32)], arguments: &[ShapeArguments], ends: &[u32]) -> Vec<[f32; 4]> {
        let given = self.host().storage_buffer("arguments", arguments).expect("memory");
        let ends = self.host().storage_buffer("ends", ends).expect("memory");
        let inputs = [Resource::buffer(given.handle()), Resource::buffer(ends.handle())];
        self.dispatch(&SHAPES, constants, &inputs, arguments.len())
    }

    /// Calls a function on shapes, by form factor bits.
    pub fn shapes(&self, function: ShapeFunction, arguments: &[ShapeArguments]) -> Vec<[f32; 4]> {
        self.call(&[(0, function as u32), (1, 0)], arguments, &vec![0; arguments.len()])
    }

    /// Form factors of ellipses, of both sides.
    pub fn ellipses(&self, function: ShapeFunction, ellipses: &[Ellipse]) -> Vec<f64> {
        let arguments: Vec<_> = ellipses.iter().map(ellipse_arguments).collect();
        let found = self.shapes(function, &arguments);
        let factor = |(found, ellipse): (&[f32; 4], &Ellipse)| {
            assert!(found[0].to_bits() <= 1.0_f32.to_bits(), "{}: {ellipse:?}", found[0]);
            f64::from(found[0])
        };
        found.iter().zip(ellipses).map(factor).collect()
    }
}
