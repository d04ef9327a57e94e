//! Writes binary glTF: JSON as it is built, and one buffer.

use serde_json::{Value, json};

/// Triangles with what their vertices need.
#[derive(Debug, Clone, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    pub indices: Vec<u32>,
}

/// A glTF file in the making.
#[derive(Clone)]
pub struct Writer {
    pub root: Value,
    pub buffer: Vec<u8>,
}

impl Writer {
    pub fn new() -> Self {
        let root = json!({
            "asset": { "version": "2.0", "generator": "arealight" },
            "scene": 0, "scenes": [{ "nodes": [] }], "nodes": [], "meshes": [], "materials": [],
            "accessors": [], "bufferViews": [], "buffers": [],
        });
        Self { root, buffer: Vec::new() }
    }

    /// Appends to one of the root's arrays, and gives the index.
    pub fn push(&mut self, array: &str, value: Value) -> usize {
        if self.root[array].is_null() {
            self.root[array] = json!([]);
        }
        let array = self.root[array].as_array_mut().expect("an array");
        array.push(value);
        array.len() - 1
    }

    /// Appends a node to the scene.
    pub fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.root["scenes"][0]["nodes"].as_array_mut().expect("an array").push(json!(index));
        index
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.buffer.len().is_multiple_of(4) {
            self.buffer.push(0);
        }
        let view = json!({ "buffer": 0, "byteOffset": self.buffer.len(), "byteLength": bytes.len() });
        self.buffer.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    pub fn floats<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = vectors.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let corner = |pick: fn(f32, f32) -> f32, start: f32| {
            let mut corner = vec![start; N];
            for vector in vectors {
                corner.iter_mut().zip(vector).for_each(|(c, x)| *c = pick(*c, *x));
            }
            corner
        };
        let (min, max) = (corner(f32::min, f32::MAX), corner(f32::max, f32::MIN));
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": 5126, "count": vectors.len(), "type": kind,
                    "min": min, "max": max }),
        )
    }

    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let short = indices.iter().all(|i| *i < 65535);
        let bytes: Vec<u8> = if short {
            indices.iter().flat_map(|i| (*i as u16).to_le_bytes()).collect()
        } else {
            indices.iter().flat_map(|i| i.to_le_bytes()).collect()
        };
        let view = self.view(&bytes);
        let component = if short { 5123 } else { 5125 };
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": component, "count": indices.len(),
                    "type": "SCALAR" }),
        )
    }

    /// A primitive without a material; clone it, and set one, to share the shape's data.
    pub fn primitive(&mut self, shape: &Shape) -> Value {
        let mut attributes = json!({ "POSITION": self.floats(&shape.positions) });
        if !shape.normals.is_empty() {
            attributes["NORMAL"] = json!(self.floats(&shape.normals));
        }
        if !shape.uvs.is_empty() {
            attributes["TEXCOORD_0"] = json!(self.floats(&shape.uvs));
        }
        json!({ "attributes": attributes, "indices": self.indices(&shape.indices) })
    }

    pub fn mesh(&mut self, name: &str, primitive: &Value, material: usize) -> usize {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(material);
        self.push("meshes", json!({ "name": name, "primitives": [primitive] }))
    }

    /// A mesh of its own for `shape`, on a node with the given transform properties.
    pub fn object(&mut self, name: &str, shape: &Shape, material: usize, mut node: Value) -> usize {
        let primitive = self.primitive(shape);
        node["name"] = json!(name);
        node["mesh"] = json!(self.mesh(name, &primitive, material));
        self.node(node)
    }

    pub fn use_extension(&mut self, name: &str) {
        let used = &self.root["extensionsUsed"];
        if !used.as_array().is_some_and(|used| used.iter().any(|e| e == name)) {
            self.push("extensionsUsed", json!(name));
        }
    }

    /// A black material that emits `radiance`.
    pub fn emitter(&mut self, name: &str, radiance: [f32; 3], double_sided: bool) -> usize {
        self.use_extension("KHR_materials_emissive_strength");
        let strength = radiance.into_iter().fold(0.0, f32::max);
        self.push(
            "materials",
            json!({ "name": name, "doubleSided": double_sided,
                    "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0 },
                    "emissiveFactor": radiance.map(|x| x / strength),
                    "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": strength } } }),
        )
    }

    /// [`Writer::emitter`] whose radiance is multiplied by a texture.
    pub fn emitter_of_image(
        &mut self,
        name: &str,
        radiance: [f32; 3],
        texture: usize,
        double_sided: bool,
    ) -> usize {
        let material = self.emitter(name, radiance, double_sided);
        self.root["materials"][material]["emissiveTexture"] = json!({ "index": texture });
        material
    }

    pub fn surface(&mut self, name: &str, color: [f32; 3], metalness: f32, roughness: f32) -> usize {
        let [r, g, b] = color;
        self.push(
            "materials",
            json!({ "name": name,
                    "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1],
                        "metallicFactor": metalness, "roughnessFactor": roughness } }),
        )
    }

    /// A camera at `eye` that looks at `target`.
    pub fn camera(&mut self, name: &str, eye: [f64; 3], target: [f64; 3], yfov: f64, aspect: f64) {
        let camera = json!({ "type": "perspective",
            "perspective": { "yfov": yfov, "aspectRatio": aspect, "znear": 0.01 } });
        let camera = self.push("cameras", camera);
        let mut node = look_at(eye, target);
        node["name"] = json!(name);
        node["camera"] = json!(camera);
        self.node(node);
    }

    pub fn texture(&mut self, name: &str, png: &[u8]) -> usize {
        let view = self.view(png);
        let image = json!({ "name": name, "bufferView": view, "mimeType": "image/png" });
        let source = self.push("images", image);
        self.push("textures", json!({ "source": source }))
    }

    /// A texture of an image, which ends at its edges.
    pub fn picture(&mut self, name: &str, image: &image::RgbImage) -> usize {
        let texture = self.texture(name, &png(image.clone()));
        let sampler = self.push("samplers", json!({ "wrapS": 33071, "wrapT": 33071 }));
        self.root["textures"][texture]["sampler"] = json!(sampler);
        texture
    }

    /// The finished file.
    pub fn glb(mut self) -> Vec<u8> {
        while !self.buffer.len().is_multiple_of(4) {
            self.buffer.push(0);
        }
        self.root["buffers"] = json!([{ "byteLength": self.buffer.len() }]);
        let mut text = serde_json::to_vec(&self.root).expect("JSON");
        while !text.len().is_multiple_of(4) {
            text.push(b' ');
        }
        container(&text, &self.buffer)
    }
}

/// An image as a PNG.
pub fn png(image: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut png = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    png.into_inner()
}

/// A binary glTF container around JSON and a buffer whose lengths are multiples of four.
pub fn container(text: &[u8], buffer: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    file.extend(b"glTF");
    file.extend(2_u32.to_le_bytes());
    file.extend((28 + text.len() as u32 + buffer.len() as u32).to_le_bytes());
    for (bytes, kind) in [(text, b"JSON"), (buffer, b"BIN\0")] {
        file.extend((bytes.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(bytes);
    }
    file
}

/// Transform properties of a node at `eye` whose -Z points at `target`, with +Y up.
pub fn look_at(eye: [f64; 3], target: [f64; 3]) -> Value {
    let (eye, target) = (glam::DVec3::from(eye), glam::DVec3::from(target));
    let back = (eye - target).normalize_or(glam::DVec3::Z);
    let right = glam::DVec3::Y.cross(back).normalize_or(glam::DVec3::X);
    let rotation = glam::DQuat::from_mat3(&glam::DMat3::from_cols(right, back.cross(right), back));
    json!({ "translation": eye.to_array(), "rotation": rotation.to_array() })
}
