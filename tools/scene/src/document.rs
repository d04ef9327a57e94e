//! The file as glTF has it: container, JSON, buffers. Nothing here trusts the file.

use crate::budget::Budget;
use crate::error::SceneError;
use crate::extensions;
use crate::numbers::{self, Place, Places};
use gltf::json;
use std::cell::RefCell;
use std::collections::HashSet;
use std::path::{Component, Path, PathBuf};

/// The largest file, buffer or encoded image that is read, in bytes.
const MAX_FILE_BYTES: u64 = 1 << 32;

/// A checked glTF document with its buffers: every index in `root` refers to something that exists.
pub(crate) struct Document {
    /// What messages call the file.
    pub file: String,
    /// The JSON.
    pub root: json::Root,
    /// Where each of the root's nodes is.
    pub places: Vec<Place>,
    /// One for each of the root's buffers, as long as the buffer says.
    buffers: Vec<Vec<u8>>,
    /// Where relative URIs start; none for a scene from memory.
    folder: Option<PathBuf>,
    /// What the scene may take.
    pub budget: Budget,
    pub files: RefCell<HashSet<PathBuf>>,
    /// When it is shown, in seconds.
    pub time: f64,
}

impl Document {
    /// Reads the document at `path` and its buffers.
    pub fn open(path: &Path, memory: Option<u64>) -> Result<Self, SceneError> {
        let file = path.display().to_string();
        let bytes = read_file(path).map_err(|source| SceneError::Read { file: file.clone(), source })?;
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Self::parse(&bytes, file, Some(folder), memory)
    }

    /// Reads the document in `bytes`, and its buffers from `folder`.
    pub fn parse(
        bytes: &[u8],
        file: String,
        folder: Option<PathBuf>,
        memory: Option<u64>,
    ) -> Result<Self, SceneError> {
        // Split the container
        let (text, blob) =
            split(bytes).map_err(|reason| SceneError::NotGltf { file: file.clone(), reason })?;
        // Parse and check the JSON
        let (root, Places { nodes: places }) = numbers::check(text)
            .and_then(|()| Ok((parse_root(text)?, serde_json::from_slice(text)?)))
            .map_err(|e| SceneError::NotGltf { file: file.clone(), reason: e.to_string() })?;
        let budget = Budget::new(memory);
        budget.read(bytes.len());
        let (buffers, files) = (Vec::new(), RefCell::default());
        let mut document = Self { file, root, places, buffers, folder, budget, files, time: 0.0 };
        document.check_version_and_extensions()?;
        document.check_fields()?;
        // Read the buffers
        let buffers = document.root.buffers.iter().enumerate();
        document.buffers =
            buffers.map(|(i, b)| document.read_buffer(i, b, blob)).collect::<Result<Vec<_>, _>>()?;
        Ok(document)
    }

    /// Adds a buffer with a view of all of it.
    pub fn push(&mut self, bytes: Vec<u8>) -> json::Index<json::buffer::View> {
        let byte_length = bytes.len().into();
        let buffer = self.root.push(json::Buffer {
            byte_length,
            name: None,
            uri: None,
            extensions: None,
            extras: json::Extras::default(),
        });
        self.buffers.push(bytes);
        self.root.push(json::buffer::View {
            buffer,
            byte_length,
            byte_offset: None,
            byte_stride: None,
            name: None,
            target: None,
            extensions: None,
            extras: json::Extras::default(),
        })
    }

    /// Puts other bytes in the place of a view's.
    pub fn fill(&mut self, view: usize, bytes: Vec<u8>) {
        let filled = self.push(bytes);
        let buffer = self.root.buffer_views[filled.value()].buffer;
        let view = &mut self.root.buffer_views[view];
        (view.buffer, view.byte_offset) = (buffer, None);
    }

    /// Whether a view is of a buffer that is not [compressed alone](extensions::is_fallback).
    pub fn has_data(&self, view: &json::buffer::View) -> bool {
        self.buffers.get(view.buffer.value()).is_some_and(|buffer| !buffer.is_empty())
    }

    /// An error about a field.
    pub fn invalid(&self, field: impl Into<String>, problem: impl Into<String>) -> SceneError {
        SceneError::Invalid { file: self.file.clone(), field: field.into(), problem: problem.into() }
    }

    /// An error about a number.
    pub fn not_finite(&self, field: impl Into<String>, value: impl std::fmt::Debug) -> SceneError {
        SceneError::NotFinite { file: self.file.clone(), field: field.into(), value: format!("{value:?}") }
    }

    /// An error about a count.
    pub fn too_large(&self, what: impl Into<String>, count: u64, limit: u64) -> SceneError {
        SceneError::TooLarge { file: self.file.clone(), what: what.into(), count, limit }
    }

    /// Takes bytes of memory for what `field` names, before they are reserved.
    pub fn take(&self, field: impl Into<String>, bytes: u64) -> Result<(), SceneError> {
        if self.budget.take(bytes) {
            return Ok(());
        }
        let (file, limit) = (self.file.clone(), self.budget.limit());
        Err(SceneError::TooMuch { file, field: field.into(), bytes, limit })
    }

    /// The bytes of a buffer view.
    pub fn view(&self, index: usize) -> Result<(&[u8], Option<usize>), SceneError> {
        let field = || format!("bufferViews[{index}]");
        let view =
            self.root.buffer_views.get(index).ok_or_else(|| self.invalid(field(), "does not exist"))?;
        let offset = view.byte_offset.unwrap_or_default().0;
        let bytes = self.bytes(field, view.buffer.value(), offset, view.byte_length.0)?;
        // A stride of zero is what some exporters write for tightly packed
        Ok((bytes, view.byte_stride.map(|s| s.0).filter(|s| *s > 0)))
    }

    /// `length` bytes of a buffer from `offset` on, for what `field` names.
    pub fn bytes(
        &self,
        field: impl Fn() -> String,
        buffer: usize,
        offset: u64,
        length: u64,
    ) -> Result<&[u8], SceneError> {
        let buffer = self.buffers.get(buffer);
        let buffer = buffer.ok_or_else(|| self.invalid(field(), "its buffer does not exist"))?;
        slice(buffer, offset, length).ok_or_else(|| {
            let problem = format!("bytes {offset} + {length} reach beyond the buffer's {}", buffer.len());
            self.invalid(field(), problem)
        })
    }

    /// The bytes that a URI refers to: base64 data, or a file beside the scene.
    pub fn resource(&self, field: &str, uri: &str) -> Result<Vec<u8>, SceneError> {
        let failed = |reason: String| SceneError::Resource {
            file: self.file.clone(),
            field: field.to_owned(),
            uri: uri.chars().take(60).collect(),
            reason,
        };
        if uri.starts_with("data:") {
            let source = gltf::buffer::Source::Uri(uri);
            return Ok(gltf::buffer::Data::from_source(source, None).map_err(|e| failed(e.to_string()))?.0);
        }
        let relative = percent_decode(uri).ok_or_else(|| failed("its name is not UTF-8".into()))?;
        if uri.contains(':') || Path::new(&relative).is_absolute() {
            return Err(failed("only data URIs and relative paths are supported".into()));
        }
        // A scene of somebody else's reads nothing that does not lie with it
        let mut depth = 0_i32;
        for part in Path::new(&relative).components() {
            depth += match part {
                Component::ParentDir => -1,
                Component::CurDir => 0,
                _ => 1,
            };
            if depth < 0 {
                return Err(failed("it lies outside of the scene's folder: move it there".into()));
            }
        }
        let folder = self.folder.as_ref().ok_or_else(|| failed("a scene from memory has no files".into()))?;
        // A scene that is named without a folder lies in the current one
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let real = |path: &Path| path.canonicalize().map_err(|error| failed(error.to_string()));
        let path = real(&folder.join(relative))?;
        if !path.starts_with(real(folder)?) {
            return Err(failed("a link leads outside of the scene's folder".into()));
        }
        let bytes = read_file(&path).map_err(|e| failed(e.to_string()))?;
        // A file's bytes count once, however often it is read
        if self.files.borrow_mut().insert(path) {
            self.budget.read(bytes.len());
        }
        Ok(bytes)
    }

    fn check_version_and_extensions(&mut self) -> Result<(), SceneError> {
        let version = &self.root.asset.version;
        if !version.starts_with("2.") {
            return Err(SceneError::NotGltf {
                file: self.file.clone(),
                reason: format!("asset.version is '{version}'"),
            });
        }
        // The gltf crate would refuse what it does not read itself
        let required = std::mem::take(&mut self.root.extensions_required);
        extensions::check_required(&self.file, &required)?;
        self.root.extensions_used.extend(required);
        extensions::check_fallbacks(&self.file, &mut self.root)
    }

    fn check_fields(&self) -> Result<(), SceneError> {
        // The gltf crate's own check reads the accessor of POSITION without asking whether it exists
        for (m, mesh) in self.root.meshes.iter().enumerate() {
            for (p, primitive) in mesh.primitives.iter().enumerate() {
                if primitive.attributes.values().any(|a| a.value() >= self.root.accessors.len()) {
                    let field = format!("meshes[{m}].primitives[{p}].attributes");
                    return Err(self.invalid(field, "an accessor does not exist"));
                }
            }
        }
        // Check every index and enumeration; a missing minimum or maximum does no harm, and an accessor
        // without a view is of zeros, or compressed
        let mut first = None;
        let report = &mut |path: &dyn Fn() -> json::Path, error: json::validation::Error| {
            let field = path();
            let bounds = ["min", "max"].map(|bound| format!("[\"POSITION\"].{bound}"));
            let bounds = bounds.iter().any(|bound| field.as_str().ends_with(bound));
            let is_empty = field.as_str().starts_with("accessors[")
                && field.as_str().ends_with("].bufferView")
                && error == json::validation::Error::Missing;
            if first.is_none() && !bounds && !is_empty {
                first = Some((field.as_str().to_owned(), error.to_string()));
            }
        };
        json::validation::Validate::validate(&self.root, &self.root, json::Path::new, report);
        first.map_or(Ok(()), |(field, problem)| Err(self.invalid(field, problem)))
    }

    fn read_buffer(
        &self,
        index: usize,
        buffer: &json::Buffer,
        blob: Option<&[u8]>,
    ) -> Result<Vec<u8>, SceneError> {
        let field = format!("buffers[{index}]");
        let mut bytes = match (&buffer.uri, blob) {
            (Some(uri), _) => self.resource(&field, uri)?,
            (None, Some(blob)) if index == 0 => blob.to_vec(),
            _ if extensions::is_fallback(buffer) => return Ok(Vec::new()),
            _ => return Err(self.invalid(field, "has neither a URI nor a binary chunk")),
        };
        let expected = buffer.byte_length.0;
        if (bytes.len() as u64) < expected {
            return Err(self.invalid(field, format!("has {} bytes, should have {expected}", bytes.len())));
        }
        bytes.truncate(expected as usize);
        self.take(field, expected)?;
        Ok(bytes)
    }
}

/// The JSON's root. A scene may be without `nodes`, and an animation's channel of an extension without
/// `node`, which the gltf crate insists on.
fn parse_root(text: &[u8]) -> serde_json::Result<json::Root> {
    let failure = match serde_json::from_slice(text) {
        Err(error) if error.to_string().contains("missing field `node") => error,
        other => return other,
    };
    let mut root: serde_json::Value = serde_json::from_slice(text)?;
    for scene in objects(&mut root, "scenes") {
        scene.entry("nodes").or_insert_with(|| serde_json::json!([]));
    }
    for animation in objects(&mut root, "animations") {
        if let Some(channels) = animation.get_mut("channels").and_then(serde_json::Value::as_array_mut) {
            channels.retain(|channel| channel["target"].get("node").is_some());
        }
    }
    serde_json::from_slice(&serde_json::to_vec(&root)?).map_err(|_| failure)
}

/// The objects of one of the root's arrays.
fn objects<'a>(
    root: &'a mut serde_json::Value,
    name: &str,
) -> impl Iterator<Item = &'a mut serde_json::Map<String, serde_json::Value>> {
    let array = root.get_mut(name).and_then(serde_json::Value::as_array_mut);
    array.into_iter().flatten().filter_map(serde_json::Value::as_object_mut)
}

/// `length` bytes from `offset` on.
pub(crate) fn slice(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let end = offset.checked_add(length)?;
    bytes.get(usize::try_from(offset).ok()?..usize::try_from(end).ok()?)
}

/// The JSON text and the binary chunk of a file.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    if !bytes.starts_with(b"glTF") {
        let is_json = bytes.trim_ascii_start().first() == Some(&b'{');
        return is_json.then_some((bytes, None)).ok_or("it is neither binary glTF nor a JSON object".into());
    }
    let word = |at: usize| {
        bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).ok_or("it is cut short")
    };
    match word(4)? {
        2 => {}
        version => return Err(format!("binary glTF of version {version}")),
    }
    let length = word(8)? as usize;
    if length > bytes.len() {
        return Err(format!("cut short: {} bytes of {length}", bytes.len()));
    }
    // Go through the chunks: the first is JSON, a second one is binary, others are to be ignored
    let chunk = |at: usize, kind: &[u8; 4]| -> Result<&[u8], String> {
        let size = word(at)? as usize;
        if bytes.get(at + 4..at + 8) != Some(kind) {
            return Err(format!("no {} chunk at byte {at}", String::from_utf8_lossy(&kind[..3])));
        }
        let data = slice(bytes, at as u64 + 8, size as u64).filter(|_| at + 8 + size <= length);
        data.ok_or_else(|| format!("the chunk at byte {at} reaches beyond the file"))
    };
    let text = chunk(12, b"JSON")?;
    let next = 20 + text.len().next_multiple_of(4);
    let blob = if next + 8 <= length { Some(chunk(next, b"BIN\0")?) } else { None };
    Ok((text, blob))
}

/// Reads a plain file; a device or a pipe could be endless.
fn read_file(path: &Path) -> std::io::Result<Vec<u8>> {
    let about = std::fs::metadata(path)?;
    let refuse = |why: &str| Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, why.to_owned()));
    if !about.is_file() {
        return refuse("not a plain file");
    }
    if about.len() > MAX_FILE_BYTES {
        return refuse("larger than 4 GiB");
    }
    std::fs::read(path)
}

fn percent_decode(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = tail.get(..2).and_then(|hex| std::str::from_utf8(hex).ok());
        let code = code.and_then(|hex| u8::from_str_radix(hex, 16).ok());
        if let (b'%', Some(code)) = (first, code) {
            bytes.push(code);
            rest = &tail[2..];
        } else {
            bytes.push(*first);
            rest = tail;
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_percent_decoded() {
        assert_eq!(percent_decode("a%20b%C3%A9.bin").as_deref(), Some("a bé.bin"));
        assert_eq!(percent_decode("100%").as_deref(), Some("100%"));
        assert_eq!(percent_decode("%FF"), None, "not UTF-8");
    }

    #[test]
    fn slices_do_not_overflow() {
        assert_eq!(slice(&[1, 2, 3], 1, 2), Some(&[2, 3][..]));
        assert_eq!(slice(&[1, 2, 3], 2, 2), None);
        assert_eq!(slice(&[1, 2, 3], u64::MAX, 2), None);
    }
}
