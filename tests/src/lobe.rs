//! What a lobe sees of a light, in float64, from the numbers that the kernel is given to the bit; and how far
//! float32 may be from it.
//!
//! # The bound
//! A backward one: the kernel's result is what some inputs near the given ones have, but for what is promised
//! of the form factor itself (6e-7, and a short series' share). The inputs move by
//! - 4 units in the last place of each vertex' distance in cosine space, as `form_factor/quad.glsl` says of
//!   it;
//! - `PRODUCT` units of each row's length times a vertex' distance, for the products that take it there;
//! - `ROW` units of each row's length, for the row itself: the frame, the texel, the mirror frame;
//! - `AXIS` units of the table's two axes.
//!
//! How far the result moves with them is measured: each coordinate is moved both ways by its share, in
//! float64, and the larger change counts. So the bound is as sharp for a mirror as for a Lambert lobe, and
//! wide only where the light's edge really hangs on the last bits.

use crate::Cases;
use arealight::gpu::GpuLight;
use arealight::table::{mirror_frame, share_above_surface};
use arealight::{Horizon, LightTable};
use arealight_cases::hard::edges::sum_edges;
use arealight_cases::hard::promise::Promises;
use arealight_oracle::frame::SurfaceFrame;
use arealight_tool_kernels::gpu::GpuCase;
use glam::{DMat3, DVec3, DVec4};

/// float32's unit in the last place.
const UNIT: f64 = 1.0 / (1 << 24) as f64;
/// Units in the products of a row with center and offset, and in their sum: five roundings in two scalar
/// products each, of which half or less coincide.
const PRODUCT: f64 = 4.0;
/// Units in a row. The frame's axes are good to 3e-7, five units; the bilinear weights and the two vectors of
/// the mirror frame take three more.
const ROW: f64 = 8.0;

/// Units in an axis of the table: sine and cosine of the view, their product, and its place among the nodes.
const AXIS: f64 = 3.0;

/// A lobe in world directions.
#[derive(Debug, Clone)]
pub struct Lobe {
    /// M⁻¹, directions of the world into cosine space.
    pub inverse: DMat3,
    /// The same, where the table's axes are rounded, up and down.
    pub moved: Vec<[DMat3; 2]>,
    /// The surface's normal, unit.
    pub normal: DVec3,
    /// What the form factor is multiplied with.
    pub albedo: f64,
    /// How far it moves with the table's axes.
    pub albedo_reach: f64,
    /// The part of the lobe above the surface, in (0, 1].
    pub above_surface: f64,
}

fn wide(vector: [f32; 3]) -> DVec3 {
    DVec3::from_array(vector.map(f64::from))
}

fn frame(case: &GpuCase) -> SurfaceFrame {
    SurfaceFrame::new(wide(case.normal), wide(case.view))
}

fn to_surface(frame: &SurfaceFrame) -> DMat3 {
    DMat3::from_cols(frame.to_surface(DVec3::X), frame.to_surface(DVec3::Y), frame.to_surface(DVec3::Z))
}

impl Lobe {
    /// The Lambert lobe of a case, its albedo being that of the first channel.
    pub fn lambert(case: &GpuCase) -> Self {
        let frame = frame(case);
        let normal = frame.from_surface(DVec3::Z);
        Self {
            inverse: to_surface(&frame),
            moved: Vec::new(),
            normal,
            albedo: case.diffuse_albedo[0].into(),
            albedo_reach: 0.0,
            above_surface: 1.0,
        }
    }

    /// The table's lobe of a case, its specular albedo being that of the first channel.
    pub fn glossy(table: &LightTable, case: &GpuCase) -> Self {
        let frame = frame(case);
        let sample = table.lookup(case.roughness.into(), frame.cos_view());
        let (f0, f90) = (f64::from(case.f0[0]), f64::from(case.f90));
        let inverse = sample.inverse_by_f0(f0, f90);
        let albedo = sample.specular_albedo(f0, f90);
        // In the mirror frame of the view itself, whatever the axis
        let cos_view = frame.cos_view().clamp(0.0, 1.0);
        let at = |roughness: f64, axis: f64| {
            let moved = table.lookup(roughness, 1.0 - axis);
            let to_mirror = mirror_frame(1.0 - axis) * mirror_frame(cos_view).transpose();
            let inverse = moved.inverse_by_f0(f0, f90) * to_mirror * to_surface(&frame);
            (inverse, (moved.specular_albedo(f0, f90) - albedo).abs())
        };
        let (roughness, axis, unit) = (f64::from(case.roughness), 1.0 - cos_view, AXIS * UNIT);
        let moved = [
            [-unit, unit].map(|unit| at(roughness * (1.0 + unit), axis)),
            // The axis is the square root
            [-unit, unit].map(|unit| at(roughness, axis * (1.0 + 2.0 * unit))),
        ];
        let albedo_reach = moved.iter().map(|[a, b]| a.1.max(b.1)).sum();
        let moved = moved.map(|both| both.map(|(inverse, _)| inverse)).into();
        Self {
            inverse: inverse * to_surface(&frame),
            moved,
            normal: frame.from_surface(DVec3::Z),
            albedo,
            albedo_reach,
            above_surface: share_above_surface(&inverse),
        }
    }
}

/// A light in the cosine space of a lobe: each vertex in xyz, and its height above the surface in w.
#[derive(Debug, Clone)]
pub struct Seen {
    lobe: Lobe,
    polygon: Vec<DVec3>,
    distances: Vec<f64>,
    two_sided: bool,
    horizon: Horizon,
}

impl Seen {
    /// What the lobe sees of a case's light.
    pub fn new(given: &Cases, case: usize, lobe: Lobe, horizon: Horizon) -> Self {
        Self::with_vertices(given, case, given.relative_vertices(case), lobe, horizon)
    }

    /// The same, with the vertices that were packed, as seen from the point: packing rounds each by a unit.
    pub fn with_vertices(
        given: &Cases,
        case: usize,
        polygon: Vec<DVec3>,
        lobe: Lobe,
        horizon: Horizon,
    ) -> Self {
        let light = &given.lights[given.cases[case].light as usize];
        // The center and the offset are rounded apart
        let center = wide(light.center);
        let distances = polygon.iter().map(|v| center.length() + v.distance(center)).collect();
        let two_sided = light.flags & GpuLight::TWO_SIDED != 0;
        Self { lobe, polygon, distances, two_sided, horizon }
    }

    fn transformed(&self, inverse: &DMat3) -> Vec<DVec4> {
        self.polygon.iter().map(|v| (*inverse * *v).extend(self.lobe.normal.dot(*v))).collect()
    }

    /// The vertices in cosine space that are integrated.
    pub fn outline(&self) -> Vec<DVec3> {
        clipped(&self.transformed(&self.lobe.inverse), self.horizon)
    }

    fn factor_of(&self, vertices: &[DVec4]) -> f64 {
        let outline: Vec<[f64; 3]> = clipped(vertices, self.horizon).iter().map(DVec3::to_array).collect();
        let signed = sum_edges::<f64>([0.0; 3], &outline).signed_form_factor();
        (if self.two_sided { signed.abs() } else { signed }).clamp(0.0, 1.0)
    }

    /// The form factor.
    pub fn form_factor(&self) -> f64 {
        self.factor_of(&self.transformed(&self.lobe.inverse))
    }

    /// How far the form factor moves with the roundings that the module's text lists.
    fn reach(&self) -> f64 {
        let given = self.transformed(&self.lobe.inverse);
        let middle = self.factor_of(&given);
        let change = |moved: [f64; 2]| (moved[0] - middle).abs().max((moved[1] - middle).abs());
        let rows =
            [self.lobe.inverse.row(0), self.lobe.inverse.row(1), self.lobe.inverse.row(2), self.lobe.normal];
        let mut reach = 0.0;

        // Move each vertex, and its height
        let mut vertices = given.clone();
        for (i, place) in given.iter().enumerate() {
            let mut square = 0.0;
            for (axis, row) in rows.iter().enumerate() {
                let own = if axis < 3 { 4.0 * place.truncate().length() } else { 0.0 };
                let step = UNIT * (own + PRODUCT * row.length() * self.distances[i]);
                let mut at = |step: f64| {
                    vertices[i] = *place;
                    vertices[i][axis] += step;
                    self.factor_of(&vertices)
                };
                square += change([at(step), at(-step)]).powi(2);
            }
            vertices[i] = *place;
            reach += square.sqrt();
        }

        // Move the table's axes
        for moved in &self.lobe.moved {
            reach += change(moved.each_ref().map(|inverse| self.factor_of(&self.transformed(inverse))));
        }

        // Move each row, and the normal
        for (axis, row) in rows.iter().enumerate() {
            let mut square = 0.0;
            for component in 0..3 {
                let step = ROW * UNIT * row.length();
                let at = |step: f64| {
                    let mut vertices = given.clone();
                    for (vertex, position) in vertices.iter_mut().zip(&self.polygon) {
                        vertex[axis] += step * position[component];
                    }
                    self.factor_of(&vertices)
                };
                square += change([at(step), at(-step)]).powi(2);
            }
            reach += square.sqrt();
        }
        reach
    }

    /// What is known of the light before any level.
    pub fn judge(&self) -> Judge {
        let form_factor = self.form_factor();
        let Lobe { albedo, albedo_reach, above_surface, .. } = self.lobe;
        let share = if self.horizon == Horizon::Both { above_surface } else { 1.0 };
        Judge { albedo, albedo_reach, share, gain: share.recip(), form_factor, reach: self.reach() }
    }
}

/// A case's truth, and what bounds are made of.
#[derive(Debug, Clone)]
pub struct Judge {
    /// What the form factor is multiplied with.
    pub albedo: f64,
    /// How far that moves with roundings.
    pub albedo_reach: f64,
    /// The part of the lobe that is left by clipping.
    pub share: f64,
    /// What the form factor is multiplied with, to keep the albedo.
    pub gain: f64,
    /// The form factor.
    pub form_factor: f64,
    /// How far roundings move it.
    pub reach: f64,
}

impl Judge {
    /// Albedo times form factor.
    pub fn expected(&self) -> f64 {
        self.albedo * (self.gain * self.form_factor).min(1.0)
    }

    /// What is expected of a light that is everywhere.
    pub fn whole(&self) -> f64 {
        self.albedo * self.gain * self.share
    }

    /// How far an answer may be from it.
    pub fn bound(&self) -> f64 {
        let edges = Promises::OURS.backward;
        // The albedo is looked up to 4e-7; it and the gain, which is of a unit vector's component, are
        // multiplied
        let factors = self.albedo_reach + 4e-7 + 8.0 * UNIT;
        self.albedo * self.gain * (edges + self.reach) + factors * self.gain * self.form_factor
    }
}

/// The part of an outline above the surface's horizon, where that clips.
fn clipped(vertices: &[DVec4], horizon: Horizon) -> Vec<DVec3> {
    if horizon != Horizon::Both {
        return vertices.iter().map(|v| v.truncate()).collect();
    }
    let mut clipped = Vec::with_capacity(vertices.len() + 2);
    for (i, a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        if a.w > 0.0 {
            clipped.push(a.truncate());
        }
        if (a.w > 0.0) != (b.w > 0.0) {
            clipped.push((b.truncate() * a.w - a.truncate() * b.w) / (a.w - b.w));
        }
    }
    clipped
}
