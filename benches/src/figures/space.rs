//! The hemisphere about a point, looked at from a little above, with lights on it.

use crate::svg::{Drawing, FILE_STYLE};
use arealight::LightTable;
use arealight_oracle::polygon::{above_horizon, form_factor, transformed_form_factor};
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// How far the viewer stands above the horizon, radians.
const ELEVATION: f64 = 0.38;

/// Where the viewer stands about the normal, radians from y towards x.
const AZIMUTH: f64 = 0.35;

/// An orthographic view.
#[derive(Clone, Copy)]
struct View {
    center: [f64; 2],
    radius: f64,
}

impl View {
    /// Where a point is in the drawing. The light's side (x negative) is to the right.
    fn at(self, point: DVec3) -> [f64; 2] {
        let (sin, cos) = AZIMUTH.sin_cos();
        let right = -point.x * cos + point.y * sin;
        let away = point.x * sin + point.y * cos;
        let up = point.z * ELEVATION.cos() + away * ELEVATION.sin();
        [self.center[0] + self.radius * right, self.center[1] - self.radius * up]
    }

    fn all(self, points: &[DVec3]) -> Vec<[f64; 2]> {
        points.iter().map(|point| self.at(*point)).collect()
    }

    /// The horizon, the dome's outline and the normal.
    fn dome(self, drawing: &mut Drawing) {
        let circle = |direction: &dyn Fn(f64) -> DVec3, part: f64| -> Vec<[f64; 2]> {
            (0..=64).map(|step| self.at(direction(part * f64::from(step) / 64.0))).collect()
        };
        let horizon = circle(&|turn| DVec3::new((TAU * turn).cos(), (TAU * turn).sin(), 0.0), 1.0);
        drawing.area("area-ball", &horizon);
        drawing.path("faint", &horizon);
        // The silhouette: the half circle across the viewer's direction
        let (sin, cos) = AZIMUTH.sin_cos();
        let (right, up) = (
            DVec3::new(-cos, sin, 0.0),
            DVec3::new(sin * ELEVATION.sin(), cos * ELEVATION.sin(), ELEVATION.cos()),
        );
        let outline = circle(&|turn| right * (TAU * turn).cos() + up * (TAU * turn).sin(), 0.5);
        drawing.path("faint", &outline);
        drawing.arrow("ink", self.at(DVec3::ZERO), self.at(DVec3::Z * 1.18));
    }
}

/// A polygon's outline on the unit sphere: each edge an arc.
fn on_sphere(vertices: &[DVec3]) -> Vec<DVec3> {
    let next = vertices.iter().cycle().skip(1);
    let arc = |(from, to): (&DVec3, &DVec3)| {
        let (from, to) = (*from, *to);
        (0..16).map(move |step| from.lerp(to, f64::from(step) / 16.0).normalize_or(DVec3::Z))
    };
    vertices.iter().zip(next).flat_map(arc).collect()
}

/// The quad light of the drawings, in the surface frame, seen in front; the view is on the other side.
fn light() -> [DVec3; 4] {
    let (center, u, v) =
        (DVec3::new(-1.3, 0.1, 0.95), DVec3::new(0.2, 0.5, 0.0), DVec3::new(0.12, -0.03, 0.5));
    [center - u - v, center - u + v, center + u + v, center + u - v]
}

/// A wall that crosses the horizon of cosine space.
fn wall() -> [DVec3; 4] {
    let (center, u, v) = (DVec3::new(-0.85, -0.6, 0.12), DVec3::new(0.36, -0.5, 0.0), DVec3::Z * 0.55);
    [center - u - v, center - u + v, center + u + v, center + u - v]
}

/// M⁻¹ of the drawings.
fn inverse(table: &LightTable) -> DMat3 {
    let inverse = table.lookup(0.5, 50.0_f64.to_radians().cos()).inverse;
    // The scale is of no matter: one in which lights stay in the drawing
    inverse * (0.75 / inverse.determinant().abs().cbrt())
}

/// A light and its outline on the sphere.
fn draw_light(drawing: &mut Drawing, view: View, vertices: &[DVec3], class: &str) {
    let closed = |points: &[DVec3]| -> Vec<DVec3> { points.iter().chain(points.first()).copied().collect() };
    for vertex in vertices {
        drawing.line("hidden", view.at(DVec3::ZERO), view.at(*vertex));
    }
    let outline = on_sphere(vertices);
    drawing.area("area-ours", &view.all(&outline));
    drawing.path("line-ours", &view.all(&closed(&outline)));
    drawing.area("area-theirs", &view.all(vertices));
    drawing.path(class, &view.all(&closed(vertices)));
}

/// Two lights beside each other, each with a title and a line below it.
fn draw_captioned(
    drawing: &mut Drawing,
    views: [View; 2],
    lights: [&[DVec3]; 2],
    captions: [(&str, String); 2],
) {
    for ((view, vertices), (title, text)) in views.into_iter().zip(lights).zip(captions) {
        view.dome(drawing);
        draw_light(drawing, view, vertices, "line-theirs");
        let x = view.center[0] + 40.0;
        drawing.text("title", "middle", [x, 292.0], title);
        drawing.text("axis", "middle", [x, 310.0], &text);
    }
}

/// A light above a glossy surface, and the same light in cosine space.
pub fn polygon_to_cosine_space(table: &LightTable) -> String {
    let (width, height) = (860.0, 330.0);
    let mut drawing = Drawing::new(width, height, "A quad light above a glossy surface, and in cosine space");
    drawing.bar("paper", [0.0, 0.0], [width, height]);
    let views = [150.0, 590.0].map(|x| View { center: [x, 225.0], radius: 125.0 });
    let inverse = inverse(table);
    let moved = light().map(|vertex| inverse * vertex);
    let captions = [
        ("surface frame", "the lobe has no closed form over the outline".to_owned()),
        (
            "cosine space",
            format!("the cosine has: form factor {:.3}", transformed_form_factor(&inverse, &light()).abs()),
        ),
    ];
    draw_captioned(&mut drawing, views, [&light(), &moved], captions);
    drawing.arrow("ink", [395.0, 165.0], [455.0, 165.0]);
    drawing.text("title", "middle", [425.0, 152.0], "M⁻¹");
    drawing.into_file(FILE_STYLE)
}

/// A light that crosses the horizon of cosine space: what is below is cut off, along the horizon.
pub fn clip() -> String {
    let (width, height) = (860.0, 330.0);
    let mut drawing = Drawing::new(width, height, "A quad that crosses the horizon is clipped there");
    drawing.bar("paper", [0.0, 0.0], [width, height]);
    let below = wall();
    let above = above_horizon(&below);
    let views = [150.0, 590.0].map(|x| View { center: [x, 160.0], radius: 125.0 });
    let titles = [
        ("crosses the horizon", "four edges; a part shines from below".to_owned()),
        (
            "clipped",
            format!(
                "{} edges, one of them on the horizon: form factor {:.3}",
                above.len(),
                form_factor(&below).abs()
            ),
        ),
    ];
    draw_captioned(&mut drawing, views, [&below, &above], titles);
    drawing.arrow("ink", [395.0, 165.0], [455.0, 165.0]);
    drawing.into_file(FILE_STYLE)
}

/// An edge's arc on the sphere, its wedge, and the vector that it adds.
pub fn edge_integral() -> String {
    let (width, height) = (860.0, 330.0);
    let mut drawing = Drawing::new(width, height, "An edge: its arc, and the vector that it adds");
    drawing.bar("paper", [0.0, 0.0], [width, height]);
    let view = View { center: [220.0, 240.0], radius: 180.0 };
    view.dome(&mut drawing);
    let ends =
        [DVec3::new(-0.15, -0.75, 0.5), DVec3::new(-0.9, 0.05, 0.45)].map(|end| end.normalize_or(DVec3::Z));
    let arc: Vec<DVec3> =
        (0..=24).map(|step| ends[0].lerp(ends[1], f64::from(step) / 24.0).normalize_or(DVec3::Z)).collect();
    let wedge: Vec<DVec3> = std::iter::once(DVec3::ZERO).chain(arc.iter().copied()).collect();
    drawing.area("area-ours", &view.all(&wedge));
    drawing.path("line-ours", &view.all(&arc));
    for (end, name) in ends.into_iter().zip(["p₁", "p₂"]) {
        drawing.arrow("ink", view.at(DVec3::ZERO), view.at(end));
        let [x, y] = view.at(end * 1.1);
        drawing.text("title", "middle", [x, y + 4.0], name);
    }
    let [x, y] = view.at((ends[0] + ends[1]) * 0.22);
    drawing.text("title", "middle", [x, y], "θ");

    // The vector that the edge adds, and its height
    let angle = ends[0].angle_between(ends[1]);
    let normal = ends[1].cross(ends[0]).normalize_or(DVec3::Z);
    let added = normal * if normal.z < 0.0 { -1.0 } else { 1.0 };
    let tip = added * (angle * 0.62);
    drawing.arrow("ink", view.at(DVec3::ZERO), view.at(tip));
    drawing.line("hidden", view.at(tip), view.at(DVec3::Z * tip.z));
    let [x, y] = view.at(tip * 1.12);
    drawing.text("title", "middle", [x, y], "θ n");
    for (line, text) in [
        "p₁, p₂: the ends of an edge, of unit length",
        "θ: the angle between them: the arc's length",
        "n: the unit vector across both",
        "The sum of θ n over all edges, over 2π, is the vector form factor.",
        "Its z is the form factor: the light that a Lambert surface gets.",
    ]
    .into_iter()
    .enumerate()
    {
        drawing.text("", "start", [450.0, 110.0 + 26.0 * line as f64], text);
    }
    drawing.into_file(FILE_STYLE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drawn_light_is_in_front_in_both_spaces_and_the_clipped_one_crosses() {
        let inverse = inverse(&LightTable::ggx());
        assert!(light().iter().all(|vertex| vertex.z > 0.0 && (inverse * *vertex).z > 0.0));
        let below = wall();
        assert!(below.iter().any(|vertex| vertex.z < 0.0) && below.iter().any(|vertex| vertex.z > 0.0));
        assert!(above_horizon(&below).iter().all(|vertex| vertex.z >= -1e-12));
    }
}
