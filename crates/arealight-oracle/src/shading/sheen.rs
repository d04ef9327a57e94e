//! Sheen above other lobes, in float64: its true BRDF, and its fitted lobe.

use super::Truth;
use crate::cubature::{Region, Settings, angles};
use crate::formula::MIN_COS_VIEW;
use crate::frame::SurfaceFrame;
use crate::material::Sheen;
use crate::sheen::{Charlie, MIN_ROUGHNESS, SheenLobe};
use arealight::SpecularLobes;
use arealight::table::share_above_surface;
use glam::{DMat3, DVec3};
use std::slice;

/// What a surface with sheen reflects, `base` being what the lobes below do: Charlie, and the base times what
/// its albedo at the view leaves.
pub(super) fn sheen_truth(
    sheen: &Sheen,
    view: DVec3,
    region: &Region,
    settings: &Settings,
    shown: impl Fn(DVec3) -> DVec3,
    base: Truth,
) -> Truth {
    let charlie = Charlie { roughness: sheen.roughness.max(MIN_ROUGHNESS) };
    let view = view.with_z(view.z.max(MIN_COS_VIEW)).normalize_or(DVec3::Z);
    let lobe =
        region.integrate(settings, angles, |light| (shown(light) * charlie.evaluate(view, light)).to_array());
    let left = sheen.left_below(charlie.albedo(view.z));
    Truth {
        radiance: base.radiance * left + sheen.color * DVec3::from_array(lobe.value),
        error: base.error * left + sheen.color * DVec3::from_array(lobe.error),
        evaluations: base.evaluations + lobe.evaluations,
    }
}

/// What sheen reflects of a light of unit radiance.
pub(super) struct SheenLight {
    /// Below 0 where the second of two lobes takes more away than the first has.
    pub radiance: DVec3,
    /// The part of the light that the lobes below get.
    pub left_below: f64,
}

/// The twin of `arealight_sheen_layer`. `lobe` is a light's form factor, per channel, in a lobe's cosine
/// space; a part of the lobe lies above the surface.
pub(super) fn with_sheen(
    sheen: &Sheen,
    lobes: SpecularLobes,
    frame: &SurfaceFrame,
    lobe: impl Fn(&DMat3, f64) -> DVec3,
) -> SheenLight {
    let cos_view = frame.cos_view();
    let one = SheenLobe::one(sheen.roughness, cos_view);
    let two = SheenLobe::two(sheen.roughness, cos_view);
    let lobes = if lobes == SpecularLobes::One { slice::from_ref(&one) } else { two.as_slice() };
    let sent = lobes
        .iter()
        .map(|fitted| fitted.albedo * lobe(&fitted.inverse, share_above_surface(&fitted.inverse)));
    SheenLight { radiance: sheen.color * sent.sum::<DVec3>(), left_below: sheen.left_below(one.albedo) }
}
