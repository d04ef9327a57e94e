//! The drawings of the documents, made of the oracle and of what is measured:
//! `cargo run -p arealight-benches --example figures`.

mod error_cost;
mod lobes;
mod space;
mod stability;

pub use error_cost::{ErrorCostError, error_cost};
pub use stability::stability;

use arealight::LightTable;

/// The drawings that need nothing but the table: a file's name, and what it holds.
pub fn drawings(table: &LightTable) -> Vec<(&'static str, String)> {
    vec![
        ("cosine-to-lobe.svg", lobes::cosine_to_lobe(table)),
        ("polygon-to-cosine-space.svg", space::polygon_to_cosine_space(table)),
        ("clip.svg", space::clip()),
        ("edge-integral.svg", space::edge_integral()),
        ("table-axes.svg", lobes::table_axes(table)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_drawing_is_made_again_as_the_documents_have_it() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/images");
        for (name, drawing) in drawings(&LightTable::ggx()) {
            assert!(!drawing.contains("NaN") && !drawing.contains("inf"), "{name}");
            let stored = std::fs::read_to_string(folder.join(name)).unwrap();
            assert!(
                drawing == stored,
                "docs/images/{name} is another: cargo run -p arealight-benches --example figures -- \
                docs/images"
            );
        }
    }
}
