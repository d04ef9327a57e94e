//! Lobes in the plane of incidence, as polar plots: the distance from the point is the density, over the
//! largest.

use crate::svg::{Drawing, FILE_STYLE};
use arealight::LightTable;
use arealight_oracle::ggx::Ggx;
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of a curve from horizon to horizon.
const STEPS: usize = 96;

/// A direction of the plane of incidence: `angle` from the normal, positive towards the light's side (away
/// from the view).
fn direction(angle: f64) -> DVec3 {
    DVec3::new(-angle.sin(), 0.0, angle.cos())
}

/// Where a direction of the plane is in a drawing about a point; the light's side is to the right.
fn place([x, y]: [f64; 2], direction: DVec3, length: f64) -> [f64; 2] {
    [x - direction.x * length, y - direction.z * length]
}

/// A density from horizon to horizon, its largest value drawn `radius` long.
fn curve(at: [f64; 2], radius: f64, density: impl Fn(DVec3) -> f64) -> Vec<[f64; 2]> {
    let angle = |step: usize| PI * step as f64 / STEPS as f64 - FRAC_PI_2;
    let values: Vec<(DVec3, f64)> = (0..=STEPS)
        .map(|step| direction(angle(step)))
        .map(|direction| (direction, density(direction)))
        .collect();
    let most = values.iter().fold(f64::MIN_POSITIVE, |most, (_, value)| most.max(*value));
    values.into_iter().map(|(direction, value)| place(at, direction, radius * value / most)).collect()
}

/// The lobe of a metal (F0 = 1) in the table; the identity's where there is none.
fn lobe(inverse: DMat3) -> TransformedDistribution {
    TransformedDistribution::from_inverse(Original::ClampedCosine, inverse).unwrap_or_else(|_| identity())
}

fn identity() -> TransformedDistribution {
    TransformedDistribution::new(Original::ClampedCosine, DMat3::IDENTITY)
        .expect("the identity is invertible")
}

/// The clamped cosine, and what matrices of the table make of it beside the true lobes.
pub fn cosine_to_lobe(table: &LightTable) -> String {
    let (width, height, radius) = (860.0, 240.0, 118.0);
    let mut drawing = Drawing::new(width, height, "A clamped cosine, and three lobes made of it by matrices");
    drawing.bar("paper", [0.0, 0.0], [width, height]);
    let panels: [(f64, f64); 4] = [(0.0, 0.0), (0.8, 30.0), (0.5, 50.0), (0.35, 70.0)];
    for (index, (roughness, degrees)) in panels.into_iter().enumerate() {
        let at = [118.0 + 204.0 * index as f64, 185.0];
        let view = direction(-degrees.to_radians());
        let distribution =
            if index == 0 { identity() } else { lobe(table.lookup(roughness, view.z).inverse) };
        drawing.line("faint", [at[0] - 95.0, at[1]], [at[0] + 95.0, at[1]]);
        drawing.line("hidden", at, [at[0], at[1] - radius - 8.0]);

        // Directions of the cosine, evenly apart, and where the matrix takes them
        for step in -5..=5 {
            let to = distribution.transform(direction(f64::from(step) * PI / 12.0));
            drawing.line("grid", at, place(at, to, radius));
        }
        let curve_of_lobe = curve(at, radius, |light| distribution.evaluate(light));
        drawing.area("area-ours", &curve_of_lobe);
        drawing.path("line-ours", &curve_of_lobe);
        let middle = [at[0], 214.0];
        if index == 0 {
            drawing.text("title", "middle", middle, "clamped cosine");
            drawing.text("axis", "middle", [middle[0], 232.0], "one for all materials");
            continue;
        }
        let ggx = Ggx { alpha: roughness * roughness };
        drawing.path("line-theirs", &curve(at, radius, |light| ggx.evaluate(view, light)));
        drawing.arrow("ink", place(at, view, 70.0), place(at, view, 12.0));
        drawing.text("title", "middle", middle, &format!("roughness {roughness}, view {degrees}°"));
    }
    drawing.text("", "end", [width - 12.0, 18.0], "filled: the cosine through M; dashed: GGX");
    drawing.into_file(FILE_STYLE)
}

/// What the table holds: a lobe for each roughness and view.
pub fn table_axes(table: &LightTable) -> String {
    let roughnesses = [0.15, 0.3, 0.45, 0.6, 0.8, 1.0];
    let nodes = [0.0, 0.25, 0.5, 0.75, 0.95];
    let (cell, left, top) = ([128.0, 84.0], 84.0, 30.0);
    let size = [left + cell[0] * roughnesses.len() as f64 + 8.0, top + cell[1] * nodes.len() as f64 + 42.0];
    let mut drawing = Drawing::new(size[0], size[1], "Lobes of the table by roughness and view");
    drawing.bar("paper", [0.0, 0.0], size);
    for (row, node) in nodes.into_iter().enumerate() {
        // The axis is sqrt(1 - cos theta)
        let cos_view: f64 = 1.0 - node * node;
        let angle = (1.0 - cos_view * cos_view).max(0.0).sqrt().atan2(cos_view);
        let view = direction(-angle);
        let y = top + cell[1] * (row as f64 + 1.0) - 8.0;
        drawing.text("axis", "end", [left - 16.0, y - 18.0], &format!("{node}"));
        let degrees = format!("{:.0}°", angle.to_degrees());
        drawing.text("axis", "end", [left - 16.0, y - 4.0], &degrees);
        for (column, roughness) in roughnesses.into_iter().enumerate() {
            let at = [left + cell[0] * (column as f64 + 0.5), y];
            let distribution = lobe(table.lookup(roughness, cos_view).inverse);
            let curve_of_lobe = curve(at, 62.0, |light| distribution.evaluate(light));
            drawing.line("faint", [at[0] - 58.0, y], [at[0] + 58.0, y]);
            drawing.area("area-ours", &curve_of_lobe);
            drawing.path("line-ours", &curve_of_lobe);
            drawing.line("leader", place(at, view, 54.0), at);
            if row == 0 {
                drawing.text("axis", "middle", [at[0], size[1] - 26.0], &format!("{roughness}"));
            }
        }
    }
    drawing.text("title", "middle", [f64::midpoint(left, size[0]), size[1] - 6.0], "roughness");
    drawing.text("title", "start", [8.0, 18.0], "√(1 − cos θ) of the view, and θ");
    drawing.into_file(FILE_STYLE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cosine_is_a_circle() {
        // cos θ from the point is the circle of that diameter above it
        for [x, y] in curve([0.0, 0.0], 2.0, |direction| direction.z.max(0.0)) {
            assert!((x.hypot(y + 1.0) - 1.0).abs() < 1e-12, "{x} {y}");
        }
    }

    #[test]
    fn lobes_lean_away_from_the_view() {
        let table = LightTable::ggx();
        let distribution = lobe(table.lookup(0.5, 50.0_f64.to_radians().cos()).inverse);
        let [x, _] = place([0.0, 0.0], distribution.transform(DVec3::Z), 1.0);
        assert!(x > 0.3, "{x}");
    }
}
