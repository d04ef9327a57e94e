//! Error maps side by side, one colour scale for all.

use super::colour::{FAINT, INK, PAPER, viridis};
use super::errors::{CELLS, ErrorMap, REFLECTANCES, ROUGHNESS, VIEW};
use super::panel::{self, Axes, MARGIN};
use crate::canvas::{Align, Canvas, Colour};

const FOOTER: i32 = 60;

/// The powers of ten at the ends of the colour scale.
const DECADES: [i32; 2] = [-5, -1];

/// Draws maps: a column a subject, a row a reflectance.
pub fn draw(maps: &[ErrorMap], quads: u16) -> Canvas {
    let rows = REFLECTANCES.len();
    // The title and the legend need three panels' width
    let columns = maps.len().div_ceil(rows).max(3);
    let (width, maps_height) = panel::size(columns, rows);
    let height = maps_height + FOOTER;
    let mut canvas = Canvas::new(width as u32, height as u32, PAPER);
    let heading = format!(
        "mean absolute error over {quads} quads of unit radiance in each cell, clipped in cosine space"
    );
    canvas.text((MARGIN.0, 12), &heading, Align::Left, INK);

    let share = |[from, to]: [f64; 2], value: f64| (value - from) / (to - from);
    let axes =
        Axes::new(&[0.1, 0.25, 0.5, 0.75, 1.0], &[0.0, 15.0, 30.0, 45.0, 60.0, 75.0], |roughness, view| {
            (share(ROUGHNESS, roughness), share(VIEW, view))
        });
    for (index, map) in maps.iter().enumerate() {
        let title = format!("{}, F0 = {}", short(map), map.f0);
        let note = format!("mean {:.1e}, most {:.1e}", map.mean(), map.worst().1);
        axes.draw(&mut canvas, panel::corner(index / rows, index % rows), [&title, &note], |x, y| {
            let cell = |place: f64| ((place * CELLS as f64) as usize).min(CELLS - 1);
            colour(map.cells[cell(y) * CELLS + cell(x)])
        });
    }
    draw_legend(&mut canvas, height - FOOTER + 8);
    canvas
}

/// The subject, short enough for its panel.
fn short(map: &ErrorMap) -> String {
    const LONGEST: usize = 13;
    let mut name: String = map.name.chars().take(LONGEST).collect();
    if map.name.chars().count() > LONGEST {
        name.pop();
        name.push('…');
    }
    format!("{name}, {}", map.level())
}

/// The logarithm of an error, as a colour.
fn colour(error: f64) -> Colour {
    let [least, most] = DECADES.map(f64::from);
    viridis((error.max(f64::MIN_POSITIVE).log10() - least) / (most - least))
}

fn draw_legend(canvas: &mut Canvas, top: i32) {
    const DECADE: i32 = 90;
    let decades = DECADES[1] - DECADES[0];
    let at = |x: i32| 10.0_f64.powf(f64::from(DECADES[0]) + f64::from(x) / f64::from(DECADE));
    canvas.rectangle((MARGIN.0, top), (DECADE * decades, 12), |x, _| colour(at(x)));
    for decade in 0..=decades {
        let x = MARGIN.0 + DECADE * decade;
        let value = 10.0_f64.powi(DECADES[0] + decade);
        canvas.rectangle((x, top + 12), (1, 4), |_, _| FAINT);
        canvas.text((x, top + 16), &format!("{value:.0e}"), Align::Centre, FAINT);
    }
    let right = MARGIN.0 + DECADE * decades + 40;
    canvas.text(
        (right, top - 2),
        "of the reflected radiance; a third of the lights about the mirror",
        Align::Left,
        FAINT,
    );
    canvas.text(
        (right, top + 15),
        "direction, a third anywhere, a third across the horizon",
        Align::Left,
        FAINT,
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::SpecularLobes;

    #[test]
    fn colours_are_those_of_the_decades() {
        assert_eq!((colour(1e-5), colour(0.1)), (viridis(0.0), viridis(1.0)));
        assert_eq!(colour(1e-3), viridis(0.5));
        assert_eq!((colour(0.0), colour(f64::NAN)), (viridis(0.0), viridis(0.0)));
    }

    #[test]
    fn long_names_are_cut() {
        let map = |name: &str| ErrorMap {
            name: name.into(),
            specular_lobes: SpecularLobes::Two,
            f0: 1.0,
            cells: vec![],
        };
        assert_eq!(short(&map("formula")), "formula, two lobes");
        assert_eq!(short(&map("a-very-long-name.exr")), "a-very-long-…, two lobes");
    }
}
