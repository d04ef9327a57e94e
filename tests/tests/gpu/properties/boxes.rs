//! The inside of a box.

use super::{COUNT, lambert, view};
use arealight_tests::Property;
use arealight_tests::prelude::*;

/// The faces of a box around the origin, fronts inwards.
fn faces_of_a_box(low: DVec3, high: DVec3) -> Vec<Vec<DVec3>> {
    let corner =
        |x: usize, y: usize, z: usize| DVec3::new([low.x, high.x][x], [low.y, high.y][y], [low.z, high.z][z]);
    vec![
        vec![corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)],
        vec![corner(0, 0, 1), corner(0, 1, 1), corner(1, 1, 1), corner(1, 0, 1)],
        vec![corner(0, 0, 0), corner(0, 0, 1), corner(1, 0, 1), corner(1, 0, 0)],
        vec![corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1)],
        vec![corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1)],
        vec![corner(1, 0, 0), corner(1, 0, 1), corner(1, 1, 1), corner(1, 1, 0)],
    ]
}

/// Any lobe of the table integrates to one in cosine space, times its albedo: whatever the matrix.
pub fn a_box_of_lights_around_the_point_sums_to_one(
    engine: &TestEngine,
    table: Option<&LightTable>,
    levels: &[Level],
) {
    let mut random = Random::new(11);
    let one_box = |_| -> Vec<EvalPoint> {
        let mut corner = |low, high| {
            DVec3::new(random.between(low, high), random.between(low, high), random.between(low, high))
        };
        let faces = faces_of_a_box(corner(-3.0, -0.1), corner(0.1, 3.0));
        let surface = glossy_surface(10.0_f64.powf(random.between(-3.0, 0.0)));
        let view = view(&mut random);
        let face = |face| if table.is_some() { point(surface, view, face, false) } else { lambert(face) };
        faces.into_iter().map(face).collect()
    };
    let boxes: Vec<Vec<EvalPoint>> = (0..COUNT).map(one_box).collect();
    let property = Property::new("box", table, &boxes);
    for &level in levels {
        let mut comparison = Comparison::new(format!("box, {level}"));
        let mut open = Comparison::new("box without a ceiling");
        for ((factors, bound), whole) in property.groups(engine, level).iter().zip(property.wholes(level)) {
            let sum: f64 = factors.iter().sum();
            comparison.add(sum, whole, *bound, || format!("{factors:?}"));
            open.add(sum - factors[1], whole, *bound, String::new);
        }
        comparison.assert_all();
        assert!(open.failures() > COUNT * 3 / 4, "the twin: {} of {COUNT} noticed", open.failures());
    }
}
