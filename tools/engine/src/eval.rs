//! Shading points one by one, by the same GLSL as the shade pass.

use crate::eval_shapes::KINDS;
use crate::{Engine, EngineError};
use arealight::kernels::Kernel;
use arealight::{Effects, Light, PackedLights, Quality};
use arealight_oracle::material::{Coat, Sheen, Surface};
use arealight_oracle::thin_film::ThinFilm;
use arealight_tool_kernels::gpu::{EvalConstants, GpuCase};
use arealight_tool_kernels::plan;
use arealight_vk::Resource;
use bytemuck::Pod;
use glam::{DVec3, Vec3};

/// What polygons and meshes may need beyond a convex quad without a texture or a profile.
pub(crate) const POLYGONAL: Effects = Effects::BEYOND_QUADS;

/// A shading point with its one light.
#[derive(Debug, Clone, PartialEq)]
pub struct EvalPoint {
    /// The surface's lobes.
    pub surface: Surface,
    /// World position.
    pub position: DVec3,
    /// Normal, of any length.
    pub normal: DVec3,
    /// Direction to the viewer, of any length.
    pub view: DVec3,
    /// The light, in world positions.
    pub light: Light,
}

impl Engine {
    /// The radiance that each point sends to its viewer, W/(m² sr), as the shade pass computes it.
    ///
    /// # Errors
    /// [`EngineError`] names a light that cannot be shaded, or says why the device cannot do it.
    pub fn eval(&self, points: &[EvalPoint], quality: Quality) -> Result<Vec<Vec3>, EngineError> {
        // Points get a pipeline that has no more than they need: of shapes, of their kind alone
        let needed = |point: &EvalPoint| {
            let (of_light, layers) = (point.light.effects(), layer_effects(&point.surface));
            let kind = KINDS.into_iter().find(|(_, effect)| of_light.contains(*effect)).map(|(kind, _)| kind);
            (kind, if kind.is_none() { (of_light & POLYGONAL) | layers } else { layers })
        };
        answers_by(&points.iter().collect::<Vec<_>>(), needed, |(kind, needed), subset| {
            if let Some(kind) = kind {
                return self.eval_shapes_with(needed, kind, subset, quality);
            }
            let dispatch = plan::eval((Effects::all() - POLYGONAL - LAYERS) | needed, quality, 0);
            self.eval_by(dispatch.kernel, &dispatch.specialization, subset)
        })
    }

    /// As [`Engine::eval`], by a kernel of one's own that has the bindings and constants of
    /// [`arealight_tool_kernels::kernels::EVAL`].
    pub fn eval_by(
        &self,
        kernel: &'static Kernel,
        specialization: &[(u32, u32)],
        points: &[&EvalPoint],
    ) -> Result<Vec<Vec3>, EngineError> {
        // Pack each light relative to its own point, so that no precision is lost far from the origin
        let mut lights = PackedLights::default();
        let mut cases = Vec::with_capacity(points.len());
        for &point in points {
            let packed = PackedLights::new(std::slice::from_ref(&point.light), point.position)?;
            self.check_layers(std::slice::from_ref(&point.light))?;
            cases.push(gpu_case(point, lights.lights.len() as u32));
            lights.append(packed)?;
        }

        let light_buffer = self.storage("lights", &lights.lights)?;
        let vertex_buffer = self.storage("light vertices", &lights.vertices)?;
        let lights = [Resource::buffer(light_buffer.handle()), Resource::buffer(vertex_buffer.handle())];
        self.dispatch_cases(kernel, specialization, &cases, |cases, results| {
            vec![self.table(), lights[0], lights[1], cases, results, self.light_textures()]
        })
    }

    /// The answers of an eval kernel to `cases`, with the resources that are bound beside the cases and the
    /// results.
    pub(crate) fn dispatch_cases<T: Pod>(
        &self,
        kernel: &'static Kernel,
        specialization: &[(u32, u32)],
        cases: &[T],
        bound: impl Fn(Resource, Resource) -> Vec<Resource>,
    ) -> Result<Vec<Vec3>, EngineError> {
        // Each dispatch takes as many cases as the device has groups for
        let limit = self.host().properties().limits.max_compute_work_group_count[0];
        let chunk = (limit.min(1 << 16) * kernel.local_size()[0]) as usize;
        let pass = self.passes.pass(kernel, specialization)?;
        let mut radiance = Vec::with_capacity(cases.len());
        for cases in cases.chunks(chunk) {
            let case_buffer = self.storage("cases", cases)?;
            let results = self.storage("results", &vec![[0.0_f32; 4]; cases.len()])?;
            let resources = bound(Resource::buffer(case_buffer.handle()), Resource::buffer(results.handle()));
            let case_count = cases.len() as u32;
            // SAFETY: The resources live until the submission was waited for.
            let set = unsafe { self.passes.bind(&pass, &resources) }?;
            self.host().try_submit(|commands| {
                // SAFETY: `commands` is being recorded, outside a render pass.
                unsafe { set.record(&pass, commands, &EvalConstants { case_count }, [case_count, 1, 1]) }
            })?;
            let answers: Vec<[f32; 4]> = results.download()?;
            radiance.extend(answers.iter().map(|a| Vec3::new(a[0], a[1], a[2])));
        }
        Ok(radiance)
    }
}

/// A point as the eval kernel reads it, `light` being the index of its light.
pub fn gpu_case(point: &EvalPoint, light: u32) -> GpuCase {
    surface_case(&point.surface, point.normal, point.view, light)
}

/// The answers of points, in their order, which `answer` gives for all that need the same at once.
pub(crate) fn answers_by<P, N: PartialEq>(
    points: &[&P],
    needed: impl Fn(&P) -> N,
    answer: impl Fn(N, &[&P]) -> Result<Vec<Vec3>, EngineError>,
) -> Result<Vec<Vec3>, EngineError> {
    let mut subsets: Vec<(N, Vec<usize>)> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        let needed = needed(point);
        match subsets.iter_mut().find(|(other, _)| *other == needed) {
            Some((_, subset)) => subset.push(index),
            None => subsets.push((needed, vec![index])),
        }
    }
    let mut answers = vec![Vec3::ZERO; points.len()];
    for (needed, indices) in subsets {
        let subset: Vec<&P> = indices.iter().map(|&index| points[index]).collect();
        for (&index, answer) in indices.iter().zip(answer(needed, &subset)?) {
            answers[index] = answer;
        }
    }
    Ok(answers)
}

/// What surfaces may need beyond two isotropic lobes, added.
pub(crate) const LAYERS: Effects = Effects::COAT
    .union(Effects::COAT_NORMAL)
    .union(Effects::DIFFUSE_ROUGHNESS)
    .union(Effects::MODEL)
    .union(Effects::SHEEN)
    .union(Effects::ANISOTROPY)
    .union(Effects::THIN_FILM);

/// What of it a surface needs.
pub(crate) fn layer_effects(surface: &Surface) -> Effects {
    let mut effects = Effects::empty();
    effects.set(Effects::DIFFUSE_ROUGHNESS, surface.diffuse_roughness > 0.0);
    if let Some(interface) = surface.interface {
        effects |= Effects::COUPLED;
        effects.set(Effects::COUPLED_BY_ALBEDO, interface.by_albedo);
    }
    if let Some(coat) = surface.coat {
        effects |= Effects::COAT;
        effects.set(Effects::COAT_NORMAL, coat.normal.is_some());
        effects.set(Effects::COAT_BY_ALBEDO, coat.by_albedo);
    }
    effects.set(Effects::MULTIPLE_SCATTERING, surface.multiple_scattering);
    effects.set(Effects::SHEEN, surface.sheen.is_some());
    effects.set(Effects::ANISOTROPY, surface.anisotropy.is_some());
    effects.set(Effects::THIN_FILM, surface.film.is_some());
    effects
}

/// A surface as the eval kernels read it.
pub(crate) fn surface_case(surface: &Surface, normal: DVec3, view: DVec3, light: u32) -> GpuCase {
    let coat = surface.coat.unwrap_or(Coat { weight: 0.0, alpha: 1.0, normal: None, by_albedo: false });
    let sheen = surface.sheen.unwrap_or(Sheen { color: DVec3::ZERO, roughness: 1.0 });
    let film = surface.film.unwrap_or(ThinFilm { weight: 0.0, ior: 1.0, thickness: 0.0 });
    let [interface_f0, interface_f90] =
        surface.interface.map_or([0.0; 2], |it| [it.f0 as f32, it.f90 as f32]);
    GpuCase {
        normal: rounded(normal),
        roughness: surface.alpha.sqrt() as f32,
        view: rounded(view),
        f90: surface.f90 as f32,
        diffuse_albedo: surface.diffuse_albedo.as_vec3().to_array(),
        light,
        f0: surface.f0.as_vec3().to_array(),
        coat_weight: coat.weight as f32,
        coat_normal: coat.normal.map_or([0.0; 3], rounded),
        coat_roughness: coat.alpha.sqrt() as f32,
        sheen_color: sheen.color.as_vec3().to_array(),
        sheen_roughness: sheen.roughness as f32,
        interface_f0,
        interface_f90,
        diffuse_roughness: surface.diffuse_roughness as f32,
        reserved: 0.0,
        tangent: surface.anisotropy.map_or([0.0; 3], |anisotropy| rounded(anisotropy.tangent)),
        tangent_roughness: surface.anisotropy.map_or(surface.alpha, |anisotropy| anisotropy.alpha).sqrt()
            as f32,
        film_weight: film.weight as f32,
        film_ior: film.ior as f32,
        film_thickness: film.thickness as f32,
        reserved1: 0.0,
    }
}

/// A direction of any length in float64, as a unit vector in float32, which has not the range for every
/// length.
pub(crate) fn rounded(direction: DVec3) -> [f32; 3] {
    let largest = direction.abs().max_element();
    let scaled = if largest > 0.0 && largest.is_finite() { direction / largest } else { direction };
    scaled.normalize_or_zero().as_vec3().to_array()
}
