//! What a device's own driver says of the rows, in its own words: registers, stack and code of NVIDIA's, say.

use super::Row;
use crate::table::Table;
use arealight_engine::host::HostError;
use arealight_engine::host::null_hardware::{Compiler, Said};
use serde::Serialize;

/// Statistics of a device's driver.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OwnWords {
    /// The device's name.
    pub device: String,
    /// The driver's name and version.
    pub driver: String,
    /// Rows by [`Row::name`], each with names and values as the driver has them.
    pub rows: Vec<(String, Vec<(String, u64)>)>,
}

/// Compiles rows by a device's driver. `progress` is told of each.
///
/// # Errors
/// Where there is no such device, or it gives no statistics.
pub fn of_device(device: Option<&str>, rows: &[Row], progress: &dyn Fn()) -> Result<OwnWords, HostError> {
    let compiler = Compiler::of_device(device)?;
    let said = |row: &Row| {
        let Said { numbers, .. } = compiler.said(&row.shader())?;
        progress();
        Ok((row.name(), numbers))
    };
    Ok(OwnWords {
        device: compiler.device_name().to_owned(),
        driver: compiler.driver().to_owned(),
        rows: rows.iter().map(said).collect::<Result<_, HostError>>()?,
    })
}

impl OwnWords {
    /// The table for a terminal.
    pub fn to_text(&self) -> String {
        format!("{}, {}\n\n{}", self.device, self.driver, self.table().to_text())
    }

    /// The table as Markdown.
    pub fn to_markdown(&self) -> String {
        format!("{}, {}.\n\n{}", self.device, self.driver, self.table().to_markdown())
    }

    /// One row per shader, one column per statistic that differs between shaders.
    fn table(&self) -> Table {
        let of =
            |row: &[(String, u64)], name: &str| row.iter().find(|(said, _)| said == name).map(|one| one.1);
        let (_, first) = self.rows.first().map_or(("", &[][..]), |(name, row)| (name, row));
        let names: Vec<&str> = first
            .iter()
            .filter(|(name, value)| self.rows.iter().any(|(_, row)| of(row, name) != Some(*value)))
            .map(|(name, _)| name.as_str())
            .collect();
        let cells = |(name, row): &(String, Vec<(String, u64)>)| {
            let values =
                names.iter().map(|name| of(row, name).map_or("–".to_owned(), |one| one.to_string()));
            [name.clone()].into_iter().chain(values).collect()
        };
        Table::new(&[&[""], &names[..]].concat().join(" | "), self.rows.iter().map(cells))
    }
}
