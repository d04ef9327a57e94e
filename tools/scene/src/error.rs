//! What can be wrong with a scene file.

/// Why a scene cannot be loaded. Each text names the file and the field, and says what to do where that is
/// not plain.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read.
    #[error("{file}: {source}")]
    Read {
        /// The scene file.
        file: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is neither glTF JSON nor binary glTF of version 2.
    #[error("{file}: not a glTF 2.0 file: {reason}")]
    NotGltf {
        /// The scene file.
        file: String,
        /// What is wrong with its container or its JSON.
        reason: String,
    },
    /// The file says that it cannot be shown without an extension that is not supported.
    #[error("{file}: extensionsRequired: {extension} is not supported; export the scene without it")]
    RequiredExtension {
        /// The scene file.
        file: String,
        /// The extension.
        extension: String,
    },
    /// Data that are only in an extension that is not supported.
    #[error(
        "{file}: {field}: is only there in {extension}, which is not supported; export the scene without it"
    )]
    OnlyInExtension {
        /// The scene file.
        file: String,
        /// Where, as a path through the JSON.
        field: String,
        /// The extension.
        extension: String,
    },
    /// A field breaks a rule of glTF.
    #[error("{file}: {field}: {problem}")]
    Invalid {
        /// The scene file.
        file: String,
        /// Where, as a path through the JSON.
        field: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A buffer or image that the file refers to cannot be read.
    #[error("{file}: {field}: cannot read '{uri}': {reason}")]
    Resource {
        /// The scene file.
        file: String,
        /// The buffer or image, as a path through the JSON.
        field: String,
        /// What it refers to, shortened.
        uri: String,
        /// Why it cannot be read.
        reason: String,
    },
    /// An image cannot be decoded.
    #[error("{file}: {field}: {source}")]
    Image {
        /// The scene file.
        file: String,
        /// The image, as a path through the JSON.
        field: String,
        /// What the decoder says.
        source: image::ImageError,
    },
    /// A number is NaN, infinite, or farther out than [`crate::MAX_COORDINATE`].
    #[error("{file}: {field}: {value} is not a finite number in range")]
    NotFinite {
        /// The scene file.
        file: String,
        /// The element, as a path through the JSON.
        field: String,
        /// Its value.
        value: String,
    },
    /// A vertex index reaches beyond the vertices.
    #[error("{file}: {field}: index {index}, but there are {count} vertices")]
    IndexOutOfRange {
        /// The scene file.
        file: String,
        /// The index, as a path through the JSON.
        field: String,
        /// Its value.
        index: u32,
        /// How many vertices the primitive has.
        count: usize,
    },
    /// The nodes are not a tree: one is its own ancestor or has two parents.
    #[error("{file}: nodes[{node}]: is reached twice; a node must have one parent and no loop")]
    NodeTwice {
        /// The scene file.
        file: String,
        /// The node's index.
        node: usize,
    },
    /// More memory than the file may take.
    #[error(
        "{file}: {field}: takes {bytes} bytes of memory, more than is left of {limit}; --memory allows others"
    )]
    TooMuch {
        /// The scene file.
        file: String,
        /// What asks for it, as a path through the JSON.
        field: String,
        /// How much.
        bytes: u64,
        /// How much the whole file may take.
        limit: u64,
    },
    /// More data than a scene may have.
    #[error("{file}: {what}: {count}, at most {limit} are supported")]
    TooLarge {
        /// The scene file.
        file: String,
        /// What there is too much of.
        what: String,
        /// How much there is.
        count: u64,
        /// How much there may be.
        limit: u64,
    },
}
