//! What a primitive has of each vertex.

use crate::accessor;
use crate::document::Document;
use crate::error::SceneError;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked::Valid;

/// The attributes of a primitive.
pub(crate) struct Attributes<'a> {
    /// The file.
    pub document: &'a Document,
    /// The primitive.
    pub source: &'a Primitive,
    /// Where it is in the file.
    pub field: &'a str,
}

impl Attributes<'_> {
    /// The accessor of an attribute, if there is one.
    pub fn accessor(&self, semantic: &Semantic) -> Option<usize> {
        self.source.attributes.get(&Valid(semantic.clone())).map(gltf::json::Index::value)
    }

    /// The values of an attribute, if there are any.
    pub fn read<const N: usize>(&self, semantic: &Semantic) -> Result<Option<Vec<[f32; N]>>, SceneError> {
        let place = format!("{}.{}", self.field, semantic.to_string());
        self.accessor(semantic).map(|accessor| accessor::floats(self.document, accessor, &place)).transpose()
    }

    /// The same, as many as the `count` vertices.
    pub fn of_vertices<const N: usize>(
        &self,
        semantic: &Semantic,
        count: usize,
    ) -> Result<Option<Vec<[f32; N]>>, SceneError> {
        let values = self.read(semantic)?;
        match &values {
            Some(values) if values.len() != count => {
                let place = format!("{}.{}", self.field, semantic.to_string());
                Err(self.document.invalid(place, format!("{} for {count} positions", values.len())))
            }
            _ => Ok(values),
        }
    }
}
