//! Cases whose light is partly hidden, as pieces of what is visible of it.

use arealight::LightShape;
use arealight_cases::answers::Answer;
use arealight_cases::cases::SupportedCase;
use arealight_oracle::shading::RelativeLight;
use arealight_oracle::visibility::visible_parts;
use arealight_tool_kernels::light_sampling::triangles_of;
use glam::DVec3;

/// Parts smaller than this share of a light are left out: what rounding leaves where blockers touch.
const LEAST_PART: f64 = 1e-13;

/// A case with what is seen of its light.
pub struct Piece<'a> {
    pub case: &'a SupportedCase,
    /// The part of its polygon; all of the light where nothing blocks it.
    pub part: Option<RelativeLight>,
}

impl Piece<'_> {
    /// What is seen, if it is a polygon or one stands for it.
    pub fn polygon(&self) -> Option<RelativeLight> {
        self.part.clone().or_else(|| self.case.polygon())
    }
}

/// A piece for each visible part of a case's light; none where all is hidden.
pub fn pieces(case: &SupportedCase) -> Vec<Piece<'_>> {
    let whole_light = case.polygon().filter(|_| !case.blockers.is_empty());
    let Some(light) = whole_light else { return vec![Piece { case, part: None }] };
    let vertices = &light.vertices;
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
            if light.profile.is_some() {
                // Begin with an edge too short to be seen that says where the profile's azimuth does, where
                // the outline stays convex
                let edge = light.azimuth * (1e-9 * whole.sqrt());
                let normal = LightShape::Polygon(vertices.clone()).area_vector();
                let outside = |vertex: &DVec3| vertex.dot(edge.cross(normal));
                let farthest = (0..vertices.len())
                    .max_by(|a, b| outside(&vertices[*a]).total_cmp(&outside(&vertices[*b])));
                vertices.rotate_left(farthest.unwrap_or(0));
                vertices.insert(1, vertices[0] + edge);
            }
            Piece { case, part: Some(RelativeLight { vertices, ..light.clone() }) }
        })
        .collect()
}

/// The answer to a case from those to its pieces.
pub fn sum(case: &SupportedCase, of_case: &[Answer]) -> Answer {
    match of_case.iter().find(|answer| answer.radiance.is_none()) {
        Some(unanswered) => unanswered.clone(),
        None => Answer::new(
            &case.name,
            of_case.iter().filter_map(|answer| answer.radiance).map(DVec3::from_array).sum(),
        ),
    }
}

/// Of a flat polygon.
fn area(vertices: &[DVec3]) -> f64 {
    let cross = |pair: &[DVec3]| (pair[0] - vertices[0]).cross(pair[1] - vertices[0]);
    0.5 * vertices.windows(2).map(cross).sum::<DVec3>().length()
}
