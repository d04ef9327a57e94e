//! What the albedos do near the horizon faster than any grid follows, in closed form.
//!
//! GGX's albedo dips by a tenth where the cosine of the view is about alpha, and comes back to 1 at the horizon. For a
//! lobe of alpha = 0.001 all of that is in the last 0.5 degrees, and a table of 64 nodes has its last row but one at 88. The dip
//! depends on the ratio of the two alone, so that it can be written down: a table holds its albedos with the dip filled
//! up, which is smooth, and a lookup takes away the dip of its own roughness and view
//! ([`TableDescription::ggx_dip`](super::TableDescription::ggx_dip)).

/// What fills the dips of GGX's two albedos, `(albedo, schlick)`, for a roughness in [0.01, 1] and the cosine of a view in
/// [0, 1]: within [0, 0.23] and [-0.71, 0]. The twin of `arealight_ggx_grazing_dip`.
///
/// The albedo's dip is a ratio of polynomials in `x = cos_view / alpha`. Rough lobes have, besides, a steep start at the
/// horizon, 0.03 wide at every alpha. The albedo of Schlick's weight has the same dip; as the view sinks below
/// alpha it stops rising, because the half vectors stop where the lobe's width keeps them; and it follows the fifth power
/// itself, whose chord between nodes counts too. The coefficients are those of the least largest error between nodes:
/// 1.4e-3 and 1.9e-3 of 64 x 64, 2.6e-3 and 3e-3 of 32 x 32, where plain interpolation errs by 0.11. Tables are stored
/// with them: they must not change.
pub fn ggx_grazing_dip(roughness: f64, cos_view: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    let x = cos_view / alpha;
    let below = 1.0 / (1.0 + x * (0.5545 + x * (0.1566 + x * 0.2887)));
    let dip = 0.2173 * x;
    // How much of its weight a lobe that lies on the surface has lost to its width
    let width = alpha / (alpha + 0.2298 * roughness + 0.01559);
    let halted = width * (0.6346 + x * (0.1751 * x - 0.2419));
    let from_normal = 1.0 - cos_view;
    let schlick_weight = from_normal * (from_normal * from_normal) * (from_normal * from_normal);
    [
        dip * below + 0.1222 * alpha * (cos_view / (cos_view + 0.02746)),
        ((dip + halted) * below - 0.7329) * schlick_weight,
    ]
}
