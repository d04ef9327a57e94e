//! Why a fit fails.

use arealight::TableError;

/// Why a table cannot be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// A setting is out of its range.
    #[error("{setting}: {value} is out of range; it must be {range}")]
    Setting {
        /// The setting's name.
        setting: &'static str,
        /// The value given.
        value: f64,
        /// The values allowed.
        range: &'static str,
    },
    /// The BRDF reflects nothing, or its albedo is NaN.
    #[error(
        "the BRDF's albedo at alpha {alpha}, cos_view {cos_view} is {albedo}, of it by Schlick's weight \
             {schlick}; both must be above 0"
    )]
    NoLobe {
        /// The alpha of the node.
        alpha: f64,
        /// The cosine of its view angle.
        cos_view: f64,
        /// The albedo found.
        albedo: f64,
        /// The Schlick part found.
        schlick: f64,
    },
    /// The BRDF reflects more than arrives.
    #[error(
        "the BRDF's albedo at alpha {alpha}, cos_view {cos_view} is {albedo}; it must be at most 1, give or \
        take 1e-5"
    )]
    MoreThanArrives {
        /// The alpha of the node.
        alpha: f64,
        /// The cosine of its view angle.
        cos_view: f64,
        /// The albedo found.
        albedo: f64,
    },
    /// No direction has a usable value: densities or values are negative or not finite.
    #[error(
        "the BRDF at alpha {alpha}, cos_view {cos_view} has no usable value: each is negative or not finite"
    )]
    NoNodes {
        /// The alpha of the node.
        alpha: f64,
        /// The cosine of its view angle.
        cos_view: f64,
    },
    /// The fitted texels make no table.
    #[error("the fitted table is not valid: {0}")]
    Table(#[from] TableError),
}
