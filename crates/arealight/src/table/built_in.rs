//! The table that is built in.

use super::{LightTable, LobePairs, TableDescription};

/// The layers of a table of 64 nodes a side, one after the other: little-endian `f32`.
static TEXELS: &[u8] = include_bytes!("../../tables/ggx.f32");
const SIZE: u32 = 64;

impl LightTable {
    /// The table for GGX that is built in: 64 nodes a side, two matrices and pairs of lobes. It is made by
    /// `arealight fit -o fitted.exr` and `arealight table convert fitted.exr tables/ggx.f32 --measure`.
    ///
    /// # Panics
    /// Never: a test reads the embedded texels.
    pub fn ggx() -> Self {
        let mut numbers =
            TEXELS.chunks_exact(4).map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
        let description = TableDescription {
            brdf: "ggx-correlated-smith".into(),
            made_by: "arealight-fit 0.1.0, by F0".into(),
            ggx_dip: true,
        };
        let (matrix, magnitude) = (layer(&mut numbers), layer(&mut numbers));
        let schlick_matrix = layer(&mut numbers);
        let matrices = [layer(&mut numbers), layer(&mut numbers)];
        let pairs = LobePairs { matrices, second_shares: layer(&mut numbers) };
        Self::new(description, SIZE, matrix, magnitude)
            .and_then(|table| table.with_schlick_matrix(schlick_matrix)?.with_pairs(pairs))
            .expect("the embedded table is valid, as a test shows")
    }

    /// The numbers of all layers as they are stored, which [`LightTable::ggx`] is embedded as: the matrix,
    /// the magnitude, and what there is of Schlick's matrix and of [`LobePairs`].
    pub fn numbers(&self) -> Vec<f32> {
        let schlick = self.schlick_matrix.iter().flatten();
        let matrices = self.pairs.iter().flat_map(|pairs| pairs.matrices.iter().flatten());
        let shares = self.pairs.iter().flat_map(|pairs| &pairs.second_shares);
        let pairs = matrices.flatten().chain(shares.flatten());
        let layers = self.matrix.iter().flatten().chain(self.magnitude.iter().flatten());
        layers.chain(schlick.flatten()).chain(pairs).copied().collect()
    }
}

/// The next layer, of `N` numbers a texel.
fn layer<const N: usize>(numbers: &mut impl Iterator<Item = f32>) -> Vec<[f32; N]> {
    let nodes = (SIZE * SIZE) as usize;
    (0..nodes).map(|_| std::array::from_fn(|_| numbers.next().unwrap_or(f32::NAN))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_what_is_embedded_and_no_more() {
        let table = LightTable::ggx();
        let bytes: Vec<u8> = table.numbers().iter().flat_map(|number| number.to_le_bytes()).collect();
        assert_eq!(bytes, TEXELS);
        assert_eq!((table.size(), table.description().brdf.as_str()), (SIZE, "ggx-correlated-smith"));
        // The twin: a table without pairs has fewer layers, and does not pass for it
        let without = LightTable { pairs: None, ..table };
        assert_eq!(without.numbers().len(), TEXELS.len() / 4 / 2);
    }
}
