//! What the albedos do near the horizon faster than any grid follows, in closed form.
//!
//! GGX's albedo dips by a tenth where the cosine of the view is about alpha, and comes back to 1 at the
//! horizon. For a lobe of alpha = 0.001 all of that is in the last 0.5 degrees, and a table of 64 nodes has
//! its last row but one at 88. The dip depends on the ratio of the two alone, so that it can be written down:
//! a table holds its albedos with the dip filled up, which is smooth, and a lookup takes away the dip of its
//! own roughness and view ([`TableDescription::ggx_dip`](super::TableDescription::ggx_dip)).

/// What fills the dips of GGX's two albedos, `(albedo, schlick)`, for a roughness in [0.01, 1] and the cosine
/// of a view in
/// [0, 1]: within [0, 0.21] and [-0.53, 0.02]. The twin of `arealight_ggx_grazing_dip`.
///
/// The albedo's dip is a ratio of polynomials in `x = cos_view / alpha`. Rough lobes have, besides, a steep
/// start at the horizon, 0.03 wide at every alpha. The albedo of Schlick's weight has the same dip; as the
/// view sinks below alpha it stops rising, because the half vectors stop where the lobe's width keeps them;
/// and it follows the fifth power itself, whose chord between nodes counts too. The coefficients minimise the
/// largest error between nodes of 64 x 64, whose last rows are balanced besides: 1e-3 and 1.6e-3 to
/// 89.9 degrees, where plain interpolation errs by 0.11. Tables are stored with them: they must not change.
pub fn ggx_grazing_dip(roughness: f64, cos_view: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    let x = cos_view / alpha;
    let below = 1.0 / (1.0 + x * (0.7153 + x * (0.0637 + x * 0.3232)));
    let dip = 0.2272 * x;
    // How much of its weight a lobe that lies on the surface has lost to its width
    let width = alpha / (alpha + 0.2316 * roughness + 0.01454);
    let halted = width * (0.5502 + x * (0.1084 * x - 0.1966));
    let from_normal = 1.0 - cos_view;
    let schlick_weight = from_normal * (from_normal * from_normal) * (from_normal * from_normal);
    [
        dip * below + 0.0866 * alpha * (cos_view / (cos_view + 0.01997)),
        ((dip + halted) * below - 0.5365) * schlick_weight,
    ]
}
