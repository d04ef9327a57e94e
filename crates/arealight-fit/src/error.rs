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
    /// The fitted texels make no table: the BRDF yields no lobe there.
    #[error("the BRDF has no lobe at a node: {0}")]
    Table(#[from] TableError),
}
