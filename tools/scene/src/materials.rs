//! Metallic-roughness materials with the extensions that are supported.

use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::{
    ANISOTROPY, CLEARCOAT, DIFFUSE_TRANSMISSION, IRIDESCENCE, OF_MATERIALS, SHEEN, TRANSMISSION,
};
use crate::images::{TextureReader, Textures};
use crate::messages::Messages;
use crate::scene::SceneMaterial;
use crate::uv_mapping::Mappings;
use arealight_oracle::material::Material;
use arealight_oracle::thin_film::ThinFilm;
use glam::Vec3;
use gltf::json;
use gltf::json::extensions::material::Specular;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// The materials that a scene's surfaces have.
pub(crate) struct Materials {
    /// [`crate::Scene::materials`].
    pub list: Vec<SceneMaterial>,
    /// What they are textured with.
    pub textures: Textures,
    /// The scene's index of each of the file's materials that is used; the last is the default one.
    of_file: Vec<Option<u32>>,
}

impl Materials {
    /// The scene's index of one of the file's materials that is used.
    pub fn index(&self, material: Option<usize>) -> u32 {
        let slot = material.unwrap_or(self.of_file.len() - 1);
        self.of_file.get(slot).copied().flatten().unwrap_or_default()
    }
}

/// Reads those of the file's materials that are used; none stands for the default one.
pub(crate) fn read(
    document: &Document,
    used: impl Iterator<Item = Option<usize>>,
    messages: &mut Messages,
) -> Result<Materials, SceneError> {
    let count = document.root.materials.len();
    let mut textures = TextureReader::new(document);
    let mut list = Vec::new();
    let mut of_file = vec![None; count + 1];
    for slot in used.map(|material| material.unwrap_or(count)) {
        if of_file[slot].is_none() {
            of_file[slot] = Some(list.len() as u32);
            let source = document.root.materials.get(slot).cloned().unwrap_or_default();
            let name = match &source.name {
                Some(name) => name.clone(),
                None if slot < count => format!("#{slot}"),
                None => "default".into(),
            };
            let place = format!("material '{name}'");
            let mut reader = Reader { place, document, textures: &mut textures, messages };
            list.push(read_material(&mut reader, name, &source)?);
        }
    }
    Ok(Materials { list, textures: textures.read, of_file })
}

impl SceneMaterial {
    /// Its textures, with the names of their fields.
    pub(crate) fn textures(&self) -> impl Iterator<Item = (&'static str, u32)> {
        [
            ("base_color_texture", self.base_color_texture),
            ("metallic_roughness_texture", self.metallic_roughness_texture),
            ("specular_texture", self.specular_texture),
            ("specular_color_texture", self.specular_color_texture),
            ("normal_texture", self.normal_texture),
            ("emission_texture", self.emission_texture),
            ("coat_texture", self.coat_texture),
            ("coat_roughness_texture", self.coat_roughness_texture),
            ("coat_normal_texture", self.coat_normal_texture),
            ("sheen_color_texture", self.sheen_color_texture),
            ("sheen_roughness_texture", self.sheen_roughness_texture),
            ("anisotropy_texture", self.anisotropy_texture),
            ("film_texture", self.film_texture),
            ("film_thickness_texture", self.film_thickness_texture),
            ("transmission_texture", self.transmission_texture),
            ("transmission_color_texture", self.transmission_color_texture),
            ("glass_texture", self.glass_texture),
        ]
        .into_iter()
        .filter_map(|(field, texture)| Some((field, texture?)))
    }
}

/// A material of the file.
fn read_material(
    reader: &mut Reader<'_, '_>,
    name: String,
    source: &json::Material,
) -> Result<SceneMaterial, SceneError> {
    reader.warn_of_unknown_extensions(source);
    reader.warn_of_mappings(source);
    // Factors
    let pbr = &source.pbr_metallic_roughness;
    let [r, g, b, alpha] = reader.fractions("baseColorFactor", pbr.base_color_factor.0);
    let [metalness] = reader.fractions("metallicFactor", [pbr.metallic_factor.0]);
    let [roughness] = reader.fractions("roughnessFactor", [pbr.roughness_factor.0]);
    let specular = specular(source);
    let (dielectric_f0, dielectric_f90) = reader.dielectric(source, &specular);
    let clearcoat = reader.clearcoat(source)?;
    let [coat] = reader.fractions("clearcoatFactor", [clearcoat.factor]);
    let [coat_roughness] = reader.fractions("clearcoatRoughnessFactor", [clearcoat.roughness_factor]);
    let sheen = reader.sheen(source)?;
    let sheen_color = reader.fractions("sheenColorFactor", sheen.color_factor);
    let [sheen_roughness] = reader.fractions("sheenRoughnessFactor", [sheen.roughness_factor]);
    let iridescence = reader.iridescence(source)?;
    let transmission = reader.diffuse_transmission(source)?;
    let [transmission_factor] = reader.fractions("diffuseTransmissionFactor", [transmission.factor]);
    let transmission_color = reader.fractions("diffuseTransmissionColorFactor", transmission.color_factor);
    let pane: Transmission = reader.extension(source, TRANSMISSION)?;
    let [glass] = reader.fractions("transmissionFactor", [pane.factor]);
    let material = Material {
        base_color: Vec3::new(r, g, b),
        metalness,
        roughness,
        dielectric_f0,
        dielectric_f90,
        coat,
        coat_roughness,
        sheen_color: Vec3::from_array(sheen_color),
        sheen_roughness,
        film: iridescence.film(),
        transmission: transmission_factor,
        transmission_color: Vec3::from_array(transmission_color),
        glass,
    };
    let anisotropy = reader.anisotropy(source)?;
    let [anisotropy_strength] = reader.fractions("anisotropyStrength", [anisotropy.strength]);
    let emission = reader.emission(source);
    // Textures
    let base_color_texture = reader.texture(pbr.base_color_texture.as_ref(), true)?;
    let metallic_roughness_texture = reader.texture(pbr.metallic_roughness_texture.as_ref(), false)?;
    let specular_texture = reader.texture(specular.specular_texture.as_ref(), false)?;
    let specular_color_texture = reader.texture(specular.specular_color_texture.as_ref(), true)?;
    let emission_texture = reader.texture(source.emissive_texture.as_ref(), true)?;
    let (normal_texture, normal_scale) = reader.normal_texture(source.normal_texture.as_ref())?;
    let coat_texture = reader.texture(clearcoat.texture.as_ref(), false)?;
    let coat_roughness_texture = reader.texture(clearcoat.roughness_texture.as_ref(), false)?;
    let (coat_normal_texture, coat_normal_scale) =
        reader.normal_texture(clearcoat.normal_texture.as_ref())?;
    let sheen_color_texture = reader.texture(sheen.color_texture.as_ref(), true)?;
    let sheen_roughness_texture = reader.texture(sheen.roughness_texture.as_ref(), false)?;
    let anisotropy_texture = reader.texture(anisotropy.texture.as_ref(), false)?;
    let film_texture = reader.texture(iridescence.texture.as_ref(), false)?;
    let film_thickness_texture = reader.texture(iridescence.thickness_texture.as_ref(), false)?;
    let transmission_texture = reader.texture(transmission.texture.as_ref(), false)?;
    let transmission_color_texture = reader.texture(transmission.color_texture.as_ref(), true)?;
    let glass_texture = reader.texture(pane.texture.as_ref().filter(|_| glass > 0.0), false)?;
    // Transparency
    let alpha_cutoff = match source.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => Some(source.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0)),
        Checked::Valid(AlphaMode::Blend) => {
            reader.warn("alphaMode BLEND: seen whole where alpha is 0.5 or more; its shadow is blended");
            None
        }
        _ => None,
    };
    Ok(SceneMaterial {
        name,
        material,
        base_alpha: alpha,
        emission,
        base_color_texture,
        metallic_roughness_texture,
        specular_texture,
        specular_color_texture,
        normal_texture,
        normal_scale,
        emission_texture,
        coat_texture,
        coat_roughness_texture,
        coat_normal_texture,
        coat_normal_scale,
        sheen_color_texture,
        sheen_roughness_texture,
        anisotropy_strength,
        anisotropy_rotation: anisotropy.rotation,
        anisotropy_texture,
        film_texture,
        film_thickness_texture,
        film_least_thickness: iridescence.least_thickness,
        transmission_texture,
        transmission_color_texture,
        glass_texture,
        alpha_cutoff,
        blended: matches!(source.alpha_mode, Checked::Valid(AlphaMode::Blend)),
        double_sided: source.double_sided,
    })
}

struct Reader<'a, 'd> {
    place: String,
    document: &'d Document,
    textures: &'a mut TextureReader<'d>,
    messages: &'a mut Messages,
}

impl Reader<'_, '_> {
    fn warn(&mut self, text: impl Into<String>) {
        self.messages.warn(self.place.as_str(), text);
    }

    /// Clamps factors to [0, 1].
    fn fractions<const N: usize>(&mut self, field: &str, values: [f32; N]) -> [f32; N] {
        let clamped = values.map(|value| value.clamp(0.0, 1.0));
        if clamped != values {
            self.warn(format!("{field} {values:?} is not in [0, 1]: clamped"));
        }
        clamped
    }

    /// Reflectance of the dielectric at normal and at grazing incidence, by `KHR_materials_ior` and
    /// `KHR_materials_specular`.
    fn dielectric(&mut self, source: &json::Material, specular: &Specular) -> (Vec3, f32) {
        let ior = source.extensions.as_ref().and_then(|e| e.ior.as_ref());
        // An index of zero means a reflectance of one
        let mut index = ior.map_or(1.5, |ior| f64::from(ior.ior.0));
        if !index.is_finite() || (index < 1.0 && index != 0.0) {
            self.warn(format!("KHR_materials_ior: {index} is below 1: 1.5 is used"));
            index = 1.5;
        }
        let by_index = (((index - 1.0) / (index + 1.0)) * ((index - 1.0) / (index + 1.0))) as f32;
        let [weight] = self.fractions("specularFactor", [specular.specular_factor.0]);
        let color = Vec3::from_array(specular.specular_color_factor.0.map(|c| c.clamp(0.0, f32::MAX)));
        let f0 = color * by_index;
        // What is above 1 is cut off where the colour's texture has been multiplied in
        let f0 = if specular.specular_color_texture.is_some() { f0 } else { f0.min(Vec3::ONE) };
        (f0 * weight, weight)
    }

    /// What an extension says that the gltf crate does not read; its defaults without it.
    fn extension<T: Default + DeserializeOwned>(
        &self,
        source: &json::Material,
        name: &str,
    ) -> Result<T, SceneError> {
        let extension = source.extensions.as_ref().and_then(|e| e.others.get(name));
        let Some(extension) = extension else { return Ok(T::default()) };
        let field = || format!("{}: {name}", self.place);
        T::deserialize(extension).map_err(|error| self.document.invalid(field(), error.to_string()))
    }

    /// The coat; nothing of it where its factor is zero.
    fn clearcoat(&self, source: &json::Material) -> Result<Clearcoat, SceneError> {
        let coat: Clearcoat = self.extension(source, CLEARCOAT)?;
        Ok(if coat.factor == 0.0 { Clearcoat::default() } else { coat })
    }

    /// The sheen; nothing of it where its colour is black.
    fn sheen(&self, source: &json::Material) -> Result<Sheen, SceneError> {
        let sheen: Sheen = self.extension(source, SHEEN)?;
        Ok(if sheen.color_factor == [0.0; 3] { Sheen::default() } else { sheen })
    }

    /// The anisotropy; nothing of it where its strength is zero.
    fn anisotropy(&mut self, source: &json::Material) -> Result<Anisotropy, SceneError> {
        let mut anisotropy: Anisotropy = self.extension(source, ANISOTROPY)?;
        if !anisotropy.rotation.is_finite() {
            self.warn(format!("anisotropyRotation {} is not finite: 0 is used", anisotropy.rotation));
            anisotropy.rotation = 0.0;
        }
        Ok(if anisotropy.strength == 0.0 { Anisotropy::default() } else { anisotropy })
    }

    /// What is let through; nothing of it where its factor is zero.
    fn diffuse_transmission(&self, source: &json::Material) -> Result<DiffuseTransmission, SceneError> {
        let transmission: DiffuseTransmission = self.extension(source, DIFFUSE_TRANSMISSION)?;
        Ok(if transmission.factor == 0.0 { DiffuseTransmission::default() } else { transmission })
    }

    /// The thin film; nothing of it where its factor is zero, or it has no thickness anywhere.
    fn iridescence(&mut self, source: &json::Material) -> Result<Iridescence, SceneError> {
        let mut film: Iridescence = self.extension(source, IRIDESCENCE)?;
        if film.factor == 0.0 {
            return Ok(Iridescence::default());
        }
        [film.factor] = self.fractions("iridescenceFactor", [film.factor]);
        if !(1.0..=MAX_FILM_IOR).contains(&film.ior) {
            self.warn(format!("iridescenceIor {} is not in 1 to {MAX_FILM_IOR}: 1.3 is used", film.ior));
            film.ior = 1.3;
        }
        for (name, thickness) in [
            ("iridescenceThicknessMinimum", &mut film.least_thickness),
            ("iridescenceThicknessMaximum", &mut film.thickness),
        ] {
            if !thickness.is_finite() || *thickness < 0.0 {
                self.warn(format!("{name} {thickness} is no thickness: 0 is used"));
                *thickness = 0.0;
            }
        }
        // Without a texture, the film is as thick as it gets
        let is_thick =
            film.thickness > 0.0 || (film.thickness_texture.is_some() && film.least_thickness > 0.0);
        Ok(if is_thick { film } else { Iridescence::default() })
    }

    /// emissiveFactor times `KHR_materials_emissive_strength`.
    fn emission(&mut self, source: &json::Material) -> Vec3 {
        let factor = Vec3::from_array(source.emissive_factor.0);
        if factor.min_element() < 0.0 {
            self.warn(format!("emissiveFactor {:?} is negative: clamped", factor.to_array()));
        } else if factor.max_element() > 1.0 {
            let text = format!("emissiveFactor {:?} is above 1: a strength, too", factor.to_array());
            self.messages.note(self.place.as_str(), text);
        }
        let factor = factor.max(Vec3::ZERO);
        let strength = source.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |s| s.emissive_strength.0);
        if (factor * strength).is_finite() && strength >= 0.0 {
            return factor * strength;
        }
        self.warn(format!("emissiveStrength {strength} must be finite and not negative: 0 is used"));
        Vec3::ZERO
    }

    fn texture(&mut self, info: Option<&json::texture::Info>, srgb: bool) -> Result<Option<u32>, SceneError> {
        let Some(info) = info else { return Ok(None) };
        self.textures.texture(info.index.value(), srgb).map(Some)
    }

    fn normal_texture(
        &mut self,
        info: Option<&json::material::NormalTexture>,
    ) -> Result<(Option<u32>, f32), SceneError> {
        let Some(info) = info else { return Ok((None, 1.0)) };
        let scale = if info.scale.is_finite() { info.scale } else { 1.0 };
        Ok((Some(self.textures.texture(info.index.value(), false)?), scale))
    }

    fn warn_of_mappings(&mut self, source: &json::Material) {
        let Mappings { first, others, .. } = Mappings::of(source);
        if !others.is_empty() {
            let others = others.join(", ");
            self.warn(format!("{others}: mapped otherwise than {first}, drawn as that is"));
        }
    }

    fn warn_of_unknown_extensions(&mut self, source: &json::Material) {
        let others = source.extensions.iter().flat_map(|e| e.others.keys());
        for extension in others.filter(|name| !OF_MATERIALS.contains(&name.as_str())) {
            self.warn(format!("{extension} is not supported: ignored"));
        }
    }
}

/// `KHR_materials_specular`; no textures of it where its factor is zero.
fn specular(source: &json::Material) -> Specular {
    let mut specular = source.extensions.as_ref().and_then(|e| e.specular.clone()).unwrap_or_default();
    if specular.specular_factor.0 <= 0.0 {
        (specular.specular_texture, specular.specular_color_texture) = (None, None);
    }
    specular
}

/// Whether a material is shaded by its surface's tangents.
pub(crate) fn has_tangents(material: &json::Material) -> bool {
    let extension = |name: &str| material.extensions.as_ref().and_then(|e| e.others.get(name));
    let coat_is_bent = extension(CLEARCOAT).is_some_and(|coat| coat.get("clearcoatNormalTexture").is_some());
    material.normal_texture.is_some() || coat_is_bent || extension(ANISOTROPY).is_some()
}

/// Above it, the library takes a film's index of refraction for this.
const MAX_FILM_IOR: f32 = 100.0;

/// `KHR_materials_iridescence`; thicknesses in nanometres.
#[derive(Deserialize)]
#[serde(default)]
struct Iridescence {
    #[serde(rename = "iridescenceFactor")]
    factor: f32,
    #[serde(rename = "iridescenceTexture")]
    texture: Option<json::texture::Info>,
    #[serde(rename = "iridescenceIor")]
    ior: f32,
    #[serde(rename = "iridescenceThicknessMinimum")]
    least_thickness: f32,
    #[serde(rename = "iridescenceThicknessMaximum")]
    thickness: f32,
    #[serde(rename = "iridescenceThicknessTexture")]
    thickness_texture: Option<json::texture::Info>,
}

impl Default for Iridescence {
    fn default() -> Self {
        Self {
            factor: 0.0,
            texture: None,
            ior: 1.3,
            least_thickness: 100.0,
            thickness: 400.0,
            thickness_texture: None,
        }
    }
}

impl Iridescence {
    fn film(&self) -> Option<ThinFilm> {
        let [weight, ior, thickness] = [self.factor, self.ior, self.thickness].map(f64::from);
        (weight > 0.0).then_some(ThinFilm { weight, ior, thickness })
    }
}

/// `KHR_materials_anisotropy`.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Anisotropy {
    #[serde(rename = "anisotropyStrength")]
    strength: f32,
    #[serde(rename = "anisotropyRotation")]
    rotation: f32,
    #[serde(rename = "anisotropyTexture")]
    texture: Option<json::texture::Info>,
}

/// `KHR_materials_sheen`.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Sheen {
    #[serde(rename = "sheenColorFactor")]
    color_factor: [f32; 3],
    #[serde(rename = "sheenColorTexture")]
    color_texture: Option<json::texture::Info>,
    #[serde(rename = "sheenRoughnessFactor")]
    roughness_factor: f32,
    #[serde(rename = "sheenRoughnessTexture")]
    roughness_texture: Option<json::texture::Info>,
}

/// `KHR_materials_clearcoat`.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Clearcoat {
    #[serde(rename = "clearcoatFactor")]
    factor: f32,
    #[serde(rename = "clearcoatTexture")]
    texture: Option<json::texture::Info>,
    #[serde(rename = "clearcoatRoughnessFactor")]
    roughness_factor: f32,
    #[serde(rename = "clearcoatRoughnessTexture")]
    roughness_texture: Option<json::texture::Info>,
    #[serde(rename = "clearcoatNormalTexture")]
    normal_texture: Option<json::material::NormalTexture>,
}

/// `KHR_materials_transmission`.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Transmission {
    #[serde(rename = "transmissionFactor")]
    factor: f32,
    #[serde(rename = "transmissionTexture")]
    texture: Option<json::texture::Info>,
}

/// `KHR_materials_diffuse_transmission`.
#[derive(Deserialize)]
#[serde(default)]
struct DiffuseTransmission {
    #[serde(rename = "diffuseTransmissionFactor")]
    factor: f32,
    #[serde(rename = "diffuseTransmissionTexture")]
    texture: Option<json::texture::Info>,
    #[serde(rename = "diffuseTransmissionColorFactor")]
    color_factor: [f32; 3],
    #[serde(rename = "diffuseTransmissionColorTexture")]
    color_texture: Option<json::texture::Info>,
}

impl Default for DiffuseTransmission {
    fn default() -> Self {
        Self { factor: 0.0, texture: None, color_factor: [1.0; 3], color_texture: None }
    }
}
