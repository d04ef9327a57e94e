//! Cases whose light is partly hidden, as cases of what is visible of it.

use arealight::LightShape;
use arealight_cases::answers::Answer;
use arealight_cases::cases::SupportedCase;
use arealight_oracle::visibility::visible_parts;
use arealight_tool_kernels::light_sampling::triangles_of;
use glam::DVec3;

/// Parts smaller than this share of a light are left out: what rounding leaves where blockers touch.
const LEAST_PART: f64 = 1e-13;

/// A case for each visible part of its light; the case itself where nothing blocks it, and none where all is
/// hidden.
pub fn parts(case: &SupportedCase) -> Vec<SupportedCase> {
    if case.blockers.is_empty() {
        return vec![case.clone()];
    }
    let vertices = &case.light.vertices;
    let whole = area(vertices);
    let mut parts = Vec::new();
    for triangle in triangles_of(vertices).chunks_exact(3) {
        let triangle: Vec<DVec3> = triangle.iter().map(|index| vertices[*index as usize]).collect();
        parts.extend(visible_parts(&triangle, &case.blockers));
    }
    parts.retain(|part| area(part) > LEAST_PART * whole);
    parts
        .into_iter()
        .map(|mut vertices| {
            if case.light.profile.is_some() {
                // Begin with an edge too short to be seen that says where the profile's azimuth does, where
                // the outline stays convex
                let edge = case.light.azimuth * (1e-9 * whole.sqrt());
                let normal = LightShape::Polygon(vertices.clone()).area_vector();
                let outside = |vertex: &DVec3| vertex.dot(edge.cross(normal));
                let farthest = (0..vertices.len())
                    .max_by(|a, b| outside(&vertices[*a]).total_cmp(&outside(&vertices[*b])));
                vertices.rotate_left(farthest.unwrap_or(0));
                vertices.insert(1, vertices[0] + edge);
            }
            let mut part = case.clone();
            part.light.vertices = vertices;
            part.blockers.clear();
            part
        })
        .collect()
}

/// The answers to cases from those to their parts, of which each case has `counts` in turn.
pub fn sums(cases: &[SupportedCase], counts: &[usize], of_parts: Vec<Answer>) -> Vec<Answer> {
    let mut of_parts = of_parts.into_iter();
    let sum = |(case, count): (&SupportedCase, &usize)| {
        let of_case: Vec<Answer> = of_parts.by_ref().take(*count).collect();
        match of_case.iter().find(|answer| answer.radiance.is_none()) {
            Some(unanswered) => unanswered.clone(),
            None => Answer::new(
                &case.name,
                of_case.iter().filter_map(|answer| answer.radiance).map(DVec3::from_array).sum(),
            ),
        }
    };
    cases.iter().zip(counts).map(sum).collect()
}

/// Of a flat polygon.
fn area(vertices: &[DVec3]) -> f64 {
    let cross = |pair: &[DVec3]| (pair[0] - vertices[0]).cross(pair[1] - vertices[0]);
    0.5 * vertices.windows(2).map(cross).sum::<DVec3>().length()
}
