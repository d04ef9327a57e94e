//! Tables as source text, for those who embed them.

use std::fmt::Write as _;

use crate::{Precision, TableFile, hash};
use arealight::table::LAYERS;
use half::f16;

/// A table as a C header: one array in the layout of the GPU image.
pub fn c_header(file: &TableFile, precision: Precision) -> String {
    let size = file.table.size();
    let (include, element, note) = match precision {
        Precision::Half => ("#include <stdint.h>\n\n", "uint16_t", "bits of 16-bit floats (RGBA16F)"),
        Precision::Single => ("", "float", "32-bit floats (RGBA32F)"),
    };
    let mut text = format!(
        "#ifndef AREALIGHT_TABLE_H\n#define AREALIGHT_TABLE_H\n\n/*\n\
         {}\
         \n  AREALIGHT_TABLE_LAYERS layers of AREALIGHT_TABLE_SIZE rows of AREALIGHT_TABLE_SIZE texels of 4 \
         channels,\n  \
         {note}, tightly packed: upload it to a 2D array image as it is.\n*/\n\n\
         {include}#define AREALIGHT_TABLE_SIZE {size}\n#define AREALIGHT_TABLE_LAYERS {LAYERS}\n\n\
         static const {element} arealight_table[AREALIGHT_TABLE_LAYERS * AREALIGHT_TABLE_SIZE * \
         AREALIGHT_TABLE_SIZE * 4] = {{\n",
        convention(file),
    );
    for texel in file.table.texels() {
        for (channel, number) in texel.into_iter().enumerate() {
            let separator = if channel == 3 { "\n" } else { " " };
            let _ = match precision {
                Precision::Half => write!(text, "0x{:04x},{separator}", f16::from_f32(number).to_bits()),
                Precision::Single => write!(text, "{number:?}f,{separator}"),
            };
        }
    }
    text.push_str("};\n\n#endif\n");
    text
}

/// What the numbers mean, as lines of a comment.
fn convention(file: &TableFile) -> String {
    let table = &file.table;
    // Text that may be anybody's must not end the comment
    let safe = |text: &str| text.escape_default().to_string().replace("*/", "* /");
    let mut lines = vec![
        "Arealight's table of transformed cosines. Generated: do not edit.".to_owned(),
        String::new(),
        format!("BRDF: {}", safe(&table.description().brdf)),
        format!("Made by: {}", safe(&table.description().made_by)),
        format!("Texels: {}", hash(table)),
        String::new(),
        "Texel (x, y) is for roughness = x / (size - 1), alpha = roughness^2 and for".to_owned(),
        "sqrt(1 - cos theta_view) = y / (size - 1); rows follow each other. Between texels: bilinear."
            .to_owned(),
        "Layer 0, matrix: (q00, q02, q20, q22). A direction goes into cosine space by".to_owned(),
        "    |       q00  0        q02 |   | cos t  0  sin t |".to_owned(),
        "    |         0  1          0 | * |     0  1      0 |      for a view (sin t, 0, cos t)".to_owned(),
        "    | alpha q20  0  alpha q22 |   | -sin t 0  cos t |      in the surface frame".to_owned(),
        "Layer 1, magnitude: (integral of f cos, integral of f cos (1 - cos theta_vh)^5, dip, 0).".to_owned(),
        if table.description().ggx_dip {
            "    The dip is 1: take arealight_ggx_grazing_dip (arealight/lobes/table.glsl) away from what \
            was \
             interpolated."
                .to_owned()
        } else {
            "    The dip is 0.".to_owned()
        },
        if table.schlick_matrix().is_some() {
            "Layer 2: the matrix for the lobe of Schlick's weight, as layer 0.".to_owned()
        } else {
            "Layer 2: layer 0 again; this table has one matrix for all reflectances.".to_owned()
        },
        "Layers 3 and 4: the matrices of two lobes for one; layer 5: the second one's share at reflectances \
        of 1 and 0.02."
            .to_owned(),
    ];
    if let Some(error) = &file.fit_error {
        lines.insert(4, format!("Error: {}", safe(error)));
    }
    lines.iter().map(|line| format!("  {line}").trim_end().to_owned() + "\n").collect()
}
