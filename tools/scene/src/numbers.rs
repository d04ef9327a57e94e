//! Numbers as the file has them, where the gltf crate would change them: it takes 2^32 for 0, and has float32
//! alone.

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::borrow::Cow;
use std::fmt;

/// Where a node is in its parent's space, in all digits, which what is far from the origin needs.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Place {
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    /// How far its mesh is morphed to each target; none where the mesh says.
    pub weights: Option<Vec<f64>>,
}

/// Those of a JSON's nodes.
#[derive(Deserialize)]
pub(crate) struct Places {
    #[serde(default)]
    pub nodes: Vec<Place>,
}

/// Sizes, numbers that somebody may write without a fraction, and what is anybody's.
const OTHERS: [&str; 12] = [
    "byteLength",
    "byteOffset",
    "byteStride",
    "count",
    "extensions",
    "extras",
    "matrix",
    "max",
    "min",
    "scale",
    "translation",
    "zfar",
];

/// Refuses numbers above an index's, naming their field and line.
pub(crate) fn check(text: &[u8]) -> serde_json::Result<()> {
    Numbers("").deserialize(&mut serde_json::Deserializer::from_slice(text))
}

/// The value of a key, and all that is in it.
struct Numbers<'a>(&'a str);

impl<'de> DeserializeSeed<'de> for Numbers<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Numbers<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<(), E> {
        if u32::try_from(number).is_ok() {
            return Ok(());
        }
        Err(E::custom(format!("{}: {number} is too large for an index", self.0)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<Key<'de>>()? {
            if OTHERS.contains(&&*key.0) {
                map.next_value::<IgnoredAny>()?;
            } else {
                map.next_value_seed(Numbers(&key.0))?;
            }
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        while items.next_element_seed(Numbers(self.0))?.is_some() {}
        Ok(())
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }
}

/// A key, borrowed where it has no escape.
#[derive(Deserialize)]
struct Key<'a>(#[serde(borrow)] Cow<'a, str>);
