//! Clear coats: how the layers share light.

use crate::common::{from_everywhere, view_at};
use arealight::{Horizon, LightTable, MIN_ALPHA, Quality};
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::material::{Coat, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, ltc_on};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

fn coated(coat: Coat) -> Surface {
    Surface { diffuse_albedo: DVec3::ONE, coat: Some(coat), ..Surface::default() }
}

/// Coats of any roughness and tilt, also such that the view is below their horizon.
fn hard_coats() -> impl Iterator<Item = (Coat, DVec3)> {
    let tilts = [0.0_f64, 0.3, 1.0, 1.5, 2.5];
    let thetas = [0.0, 0.5, 1.2, FRAC_PI_2 - 1e-4];
    let alphas = [MIN_ALPHA, 0.01, 0.3, 1.0];
    tilts.into_iter().flat_map(move |tilt| {
        thetas.into_iter().flat_map(move |theta| {
            alphas.into_iter().map(move |alpha| {
                let normal = DVec3::new(-tilt.sin() * 0.8, tilt.sin() * 0.6, tilt.cos());
                (Coat { weight: 0.9, alpha, normal: Some(normal), by_albedo: false }, view_at(theta))
            })
        })
    })
}

#[test]
fn a_white_surface_below_a_coat_sends_no_more_than_it_gets() {
    for (coat, view) in hard_coats() {
        let surface = coated(coat);
        let share = coat.share(SurfaceFrame::new(coat.normal.unwrap(), view).cos_view());
        for horizon in [Horizon::Cosine, Horizon::Both] {
            let quality = Quality { horizon, ..Quality::default() };
            let sent = from_everywhere(|light| ltc_on(quality, &TABLE, &surface, DVec3::Z, view, light)).x;
            assert!(sent <= 1.0 + 1e-9, "{horizon:?}, {coat:?}, {view}: {sent}");
            // What the coat keeps from the base it reflects itself, but for what its roughness loses, and
            // what it would send below the surface
            assert!(sent >= 1.0 - share - 1e-9, "{horizon:?}, {coat:?}, {view}: {sent}");
        }
    }
    // The twin: added instead of layered they send more
    let (coat, view) = (Coat { weight: 0.9, alpha: 0.01, normal: None, by_albedo: false }, view_at(1.4));
    let added = from_everywhere(|light| {
        let both = ltc(&TABLE, &coated(coat), DVec3::Z, view, light);
        let share = coat.share(view.z);
        both + share * ltc(&TABLE, &Surface { coat: None, ..coated(coat) }, DVec3::Z, view, light)
    })
    .x;
    assert!(added > 1.1, "{added}");
}

#[test]
fn a_coat_of_no_weight_is_none_to_the_bit() {
    let light = RelativeLight {
        vertices: vec![DVec3::new(-0.5, -1.0, 1.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(1.0, 0.0, 0.5)],
        radiance: DVec3::new(1.0, 2.0, 3.0),
        two_sided: true,
        ..RelativeLight::default()
    };
    for (coat, view) in hard_coats() {
        let surface = coated(Coat { weight: 0.0, ..coat });
        let with = ltc(&TABLE, &surface, DVec3::Z, view, &light);
        assert_eq!(with, ltc(&TABLE, &Surface { coat: None, ..surface }, DVec3::Z, view, &light));
    }
}
