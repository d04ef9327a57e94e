//! Lights behind a grid of cells: one for each.

use crate::light_fault::LightFault;
use crate::opening::{bad, half_axes, no_parallelogram};
use crate::{Light, LightShape, Opening};

impl Light {
    /// The lights of a grid of cells before a parallelogram, an egg crate: a part of it for each cell, seen
    /// through the cell's end, `depth` before it. Exact, at the price of as many lights.
    ///
    /// # Errors
    /// [`LightFault::BadOpening`] for other shapes, textured lights, no cell or another depth.
    pub fn behind_grid(&self, columns: u32, rows: u32, depth: f64) -> Result<Vec<Self>, LightFault> {
        let cells = u64::from(columns) * u64::from(rows);
        let is_deep = depth > 0.0 && depth.is_finite();
        if !(1..=4096).contains(&cells) || !is_deep || self.texture.is_some() {
            let limits = "1 to 4096 cells, a depth above 0, and no texture";
            return Err(bad(format!("a grid of {columns} by {rows} cells, {depth} deep: {limits}")));
        }
        let LightShape::Polygon(_) = self.shape else { return Err(no_parallelogram()) };
        let (u, v) = half_axes(&self.shape)?;
        let before = self.shape.center() + self.shape.area_vector().normalize_or_zero() * depth;
        let (u, v) = (u / f64::from(columns), v / f64::from(rows));
        let place = |index: u32, count: u32| f64::from(2 * index + 1) - f64::from(count);
        let cell = |index: u32| {
            let offset = u * place(index % columns, columns) + v * place(index / columns, rows);
            let center = self.shape.center() + offset;
            let corners = [-u - v, u - v, u + v, v - u].map(|corner| center + corner);
            let opening = Opening { center: before + offset, axis_u: u, axis_v: v, housed: true };
            Self { shape: LightShape::Polygon(corners.to_vec()), opening: Some(opening), ..self.clone() }
        };
        Ok((0..columns * rows).map(cell).collect())
    }
}

#[cfg(test)]
mod tests {
    use crate::Light;
    use crate::opening::tests::lamp;
    use glam::{DVec3, dvec3};

    #[test]
    fn a_grid_has_its_cells_over_the_light() {
        let cells = lamp().behind_grid(4, 2, 0.1).unwrap();
        assert_eq!(cells.len(), 8);
        let area = |light: &Light| light.shape.area_vector();
        let sum: DVec3 = cells.iter().map(area).sum();
        assert!((sum - area(&lamp())).length() < 1e-12, "{sum}");
        for cell in &cells {
            cell.validate().unwrap();
            let opening = cell.opening.unwrap();
            let over = dvec3(0.0, 0.0, 0.1);
            assert!((opening.center - cell.shape.center() - over).length() < 1e-12 && opening.housed);
        }
    }
}
