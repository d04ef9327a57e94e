//! A file's metadata: the same names and values in every format.

use arealight::table::LobePairs;
use arealight::{LightTable, TableDescription};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;

use crate::{ReadError, TableFile};

/// The attribute `arealight.format`.
pub const FORMAT: &str = "arealight-table";
/// The attribute `arealight.version`: the version of the format that is written; all from 1 on are read.
pub const VERSION: i32 = 4;
/// The attribute `arealight.axes`.
pub const AXES: &str =
    "x: roughness = x / (size - 1), alpha = roughness^2; y: sqrt(1 - cos theta_view) = y / (size - 1)";
/// The attribute `arealight.frame`.
pub const FRAME: &str = "inverse matrix; rows in cosine space; columns (cos t, 0, sin t), (0, 1, 0), (-sin \
t, 0, cos t) in the surface frame, for a view (sin t, 0, cos t)";
/// The attribute `arealight.normalisation`.
pub const NORMALISATION: &str = "R G B A = q00 q02 q20 q22 of [q00 0 q02; 0 1 0; alpha*q20 0 alpha*q22]; \
    magnitude R G = integral f cos, integral f cos (1 - cos theta_vh)^5";

/// The values of the attribute `arealight.grazing_dip`.
const NO_DIP: &str = "none";
const GGX_DIP: &str = "ggx";

pub mod name {
    pub const FORMAT: &str = "arealight.format";
    pub const VERSION: &str = "arealight.version";
    pub const AXES: &str = "arealight.axes";
    pub const FRAME: &str = "arealight.frame";
    pub const NORMALISATION: &str = "arealight.normalisation";
    pub const BRDF: &str = "arealight.brdf";
    pub const MADE_BY: &str = "arealight.made_by";
    pub const FIT_ERROR: &str = "arealight.fit_error";
    pub const HASH: &str = "arealight.hash";
    pub const GRAZING_DIP: &str = "arealight.grazing_dip";
    /// Of formats whose layers are always the same.
    pub const MATRICES: &str = "arealight.matrices";
}

/// An attribute's value.
pub enum Value {
    Text(String),
    Number(i32),
    /// Of a type that no attribute has, as printed for debugging.
    Other(String),
}

impl Value {
    fn into_text(self) -> String {
        match self {
            Self::Text(text) | Self::Other(text) => text,
            Self::Number(number) => number.to_string(),
        }
    }

    /// The error for an attribute of this value.
    pub fn unexpected(self, attribute: &'static str, expected: &str) -> ReadError {
        ReadError::Attribute { attribute, found: printable(&self.into_text()), expected: expected.to_owned() }
    }
}

/// The attributes that are left after those which say what the texels mean were found to be as expected.
#[derive(Debug)]
pub struct Attributes {
    pub version: i32,
    pub description: TableDescription,
    pub fit_error: Option<String>,
    /// Always there from version 2 on.
    hash: Option<String>,
}

impl Attributes {
    /// Reads the attributes, in the order in which they matter. `oldest` is the first version that the file's
    /// format had, `get` finds an attribute by its name.
    pub fn read(oldest: i32, get: impl Fn(&str) -> Option<Value>) -> Result<Self, ReadError> {
        let find = |attribute| get(attribute).ok_or(ReadError::MissingAttribute { attribute });
        let text = |attribute| match find(attribute)? {
            Value::Text(text) => Ok(text),
            other => Err(other.unexpected(attribute, "a string")),
        };
        let expect = |attribute, expected: &str| match find(attribute)? {
            Value::Text(text) if text == expected => Ok(()),
            other => Err(other.unexpected(attribute, expected)),
        };
        expect(name::FORMAT, FORMAT)?;
        let version = match find(name::VERSION)? {
            Value::Number(version) if (oldest..=VERSION).contains(&version) => version,
            other if oldest == VERSION => return Err(other.unexpected(name::VERSION, &VERSION.to_string())),
            other => return Err(other.unexpected(name::VERSION, &format!("{oldest} to {VERSION}"))),
        };
        expect(name::AXES, AXES)?;
        expect(name::FRAME, FRAME)?;
        expect(name::NORMALISATION, NORMALISATION)?;
        let dip = if version < 3 { Value::Text(NO_DIP.to_owned()) } else { find(name::GRAZING_DIP)? };
        let ggx_dip = match dip {
            Value::Text(text) if text == NO_DIP => false,
            Value::Text(text) if text == GGX_DIP => true,
            other => return Err(other.unexpected(name::GRAZING_DIP, "none or ggx")),
        };
        Ok(Self {
            version,
            description: TableDescription { brdf: text(name::BRDF)?, made_by: text(name::MADE_BY)?, ggx_dip },
            fit_error: get(name::FIT_ERROR).map(|_| text(name::FIT_ERROR)).transpose()?,
            hash: if version == 1 { None } else { Some(text(name::HASH)?) },
        })
    }

    /// How many layers a file of this version may have.
    pub fn layer_counts(&self) -> &'static [usize] {
        match self.version {
            1 => &[2],
            2 | 3 => &[2, 3],
            _ => &[2, 3, 5, 6],
        }
    }

    /// Makes the table, and checks its hash.
    pub fn table(
        self,
        size: u32,
        matrix: Vec<[f32; 4]>,
        magnitude: Vec<[f32; 2]>,
        schlick_matrix: Option<Vec<[f32; 4]>>,
        pairs: Option<LobePairs>,
    ) -> Result<TableFile, ReadError> {
        let mut table = LightTable::new(self.description, size, matrix, magnitude)?;
        if let Some(schlick_matrix) = schlick_matrix {
            table = table.with_schlick_matrix(schlick_matrix)?;
        }
        if let Some(pairs) = pairs {
            table = table.with_pairs(pairs)?;
        }
        let hash = hash(&table);
        match self.hash {
            Some(found) if found != hash => Err(ReadError::Hash { found: hash, expected: printable(&found) }),
            _ => Ok(TableFile { table, fit_error: self.fit_error }),
        }
    }
}

/// The attribute `arealight.grazing_dip` of a table.
fn dip_name(table: &LightTable) -> &'static str {
    if table.description().ggx_dip { GGX_DIP } else { NO_DIP }
}

/// The attributes of a table, but for the version.
pub fn texts(file: &TableFile) -> Vec<(&'static str, String)> {
    let description = file.table.description();
    let mut texts = vec![
        (name::FORMAT, FORMAT.to_owned()),
        (name::AXES, AXES.to_owned()),
        (name::FRAME, FRAME.to_owned()),
        (name::NORMALISATION, NORMALISATION.to_owned()),
        (name::BRDF, description.brdf.clone()),
        (name::MADE_BY, description.made_by.clone()),
        (name::GRAZING_DIP, dip_name(&file.table).to_owned()),
        (name::HASH, hash(&file.table)),
    ];
    texts.extend(file.fit_error.iter().map(|error| (name::FIT_ERROR, error.clone())));
    texts
}

/// How many matrices a table has for each node: one or two, and two more of pairs.
pub fn matrix_count(table: &LightTable) -> u32 {
    1 + u32::from(table.schlick_matrix().is_some()) + if table.pairs().is_some() { 2 } else { 0 }
}

/// The hash of a table's texels, `sha256:` and 64 hexadecimal digits: two tables shade alike if it is the
/// same.
///
/// Over the size and the number of matrices as `u32`, then the matrix, the magnitude and Schlick's matrix if
/// there is one, then the matrices of pairs and the second lobe's shares if there are any, texel by texel as
/// `f32`, all in little-endian order; then, if the magnitudes have a dip added, its name. Other metadata does
/// not count.
pub fn hash(table: &LightTable) -> String {
    let schlick_matrix = table.schlick_matrix();
    let mut hasher = Sha256::new();
    hasher.update(table.size().to_le_bytes());
    hasher.update(matrix_count(table).to_le_bytes());
    let mut update = |numbers: &[f32]| {
        // Few calls: a texel at a time is slow
        for chunk in numbers.chunks(4096) {
            let bytes: Vec<u8> = chunk.iter().flat_map(|number| number.to_le_bytes()).collect();
            hasher.update(&bytes);
        }
    };
    update(table.matrix().as_flattened());
    update(table.magnitude().as_flattened());
    update(schlick_matrix.unwrap_or_default().as_flattened());
    if let Some(pairs) = table.pairs() {
        for matrix in &pairs.matrices {
            update(matrix.as_flattened());
        }
        update(pairs.second_shares.as_flattened());
    }
    if table.description().ggx_dip {
        hasher.update(dip_name(table));
    }
    let mut text = String::from("sha256:");
    for byte in hasher.finalize() {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// Text of a file that may be anybody's: it must not steer the terminal, nor repeat a book that someone
/// stored there.
pub fn printable(text: &str) -> String {
    const LONGEST: usize = 200;
    let mut printable: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        printable.push_str("...");
    }
    printable
}
