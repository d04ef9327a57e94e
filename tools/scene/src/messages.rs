//! What is said of a file while a scene is made of it.

/// Something in the file that is not shown word for word.
#[derive(Debug, Clone, PartialEq, Eq)]
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
        let mut kinds: Vec<(&Self, usize)> = Vec::new();
        for warning in warnings {
            match kinds.iter_mut().find(|(first, _)| first.text == warning.text) {
                Some((_, count)) => *count += 1,
                None => kinds.push((warning, 1)),
            }
        }
        let line = |(first, count): (&Self, usize)| match count {
            1 => first.to_string(),
            more => format!("{} and {} more: {}", first.place, more - 1, first.text),
        };
        kinds.into_iter().map(line).collect()
    }
}

/// What has been said of a file so far, each thing once.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    /// [`crate::Scene::warnings`].
    pub warnings: Vec<Warning>,
    /// [`crate::Scene::notes`].
    pub notes: Vec<Warning>,
}

impl Messages {
    /// Notes what is not shown as the file says.
    pub fn warn(&mut self, place: impl Into<String>, text: impl Into<String>) {
        say(&mut self.warnings, place.into(), text.into());
    }

    /// Notes what is shown as the file means, though not word for word.
    pub fn note(&mut self, place: impl Into<String>, text: impl Into<String>) {
        say(&mut self.notes, place.into(), text.into());
    }
}

fn say(said: &mut Vec<Warning>, place: String, text: String) {
    let message = Warning { place, text };
    if !said.contains(&message) {
        said.push(message);
    }
}
