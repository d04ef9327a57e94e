//! What is said of a file while a scene is made of it.

use indexmap::{IndexMap, IndexSet};

/// Something in the file that is not shown word for word.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Warning {
    /// The mesh, material, node or extension.
    pub place: String,
    /// What it is and what was done.
    pub text: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.place, self.text)
    }
}

impl Warning {
    /// One line for each text, with the place where it came first and how many more there are.
    pub fn grouped(warnings: &[Self]) -> Vec<String> {
        let mut kinds: IndexMap<&str, (&Self, usize)> = IndexMap::new();
        for warning in warnings {
            kinds.entry(&warning.text).or_insert((warning, 0)).1 += 1;
        }
        let line = |(first, count): (&Self, usize)| match count {
            1 => first.to_string(),
            more => format!("{} and {} more: {}", first.place, more - 1, first.text),
        };
        kinds.into_values().map(line).collect()
    }
}

/// What has been said of a file so far, each thing once.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    /// [`crate::Scene::warnings`].
    pub warnings: IndexSet<Warning>,
    /// [`crate::Scene::notes`].
    pub notes: IndexSet<Warning>,
}

impl Messages {
    /// Notes what is not shown as the file says.
    pub fn warn(&mut self, place: impl Into<String>, text: impl Into<String>) {
        self.warnings.insert(Warning { place: place.into(), text: text.into() });
    }

    /// Notes what is shown as the file means, though not word for word.
    pub fn note(&mut self, place: impl Into<String>, text: impl Into<String>) {
        self.notes.insert(Warning { place: place.into(), text: text.into() });
    }
}
