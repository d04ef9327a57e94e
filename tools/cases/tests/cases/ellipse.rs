//! The truth of hard ellipses, in two ways.

use arealight_cases::hard::ellipse::FAMILIES;
use arealight_oracle::ellipse::{contour_form_factor, form_factor};

/// The hard families' truth is the closed form in float64: it holds there too.
#[test]
fn the_closed_form_holds_where_float32_is_hard_put() {
    for family in FAMILIES {
        let (mut largest, mut light) = (0.0_f64, 0);
        for index in 0..60 {
            let ellipse = family.case(index, 0);
            let (closed, contour) = (form_factor(&ellipse), contour_form_factor(&ellipse));
            largest = largest.max((closed - contour).abs());
            light += usize::from(contour.abs() > 1e-8);
        }
        // Of contact at a millionth: 2^-53 over that, and the quadrature's tolerance times its pieces
        assert!(largest < 1e-9, "{}: {largest:e}", family.name);
        assert!(light > 5 || family.name.starts_with("far"), "{}: {light}", family.name);
    }
}
