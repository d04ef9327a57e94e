//! Metallic-roughness materials with the extensions that are supported.

use crate::document::Document;
use crate::error::SceneError;
use crate::extensions::{
    ANISOTROPY, CLEARCOAT, DIFFUSE_TRANSMISSION, IRIDESCENCE, OF_MATERIALS, SHEEN, TRANSMISSION, UNLIT,
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
    let [r, g, b, base_alpha] = reader.fractions("baseColorFactor", pbr.base_color_factor.0);
    let metalness = reader.fraction("metallicFactor", pbr.metallic_factor.0);
    let roughness = reader.fraction("roughnessFactor", pbr.roughness_factor.0);
    let specular = specular(source);
    let (dielectric_f0, dielectric_f90) = reader.dielectric(source, &specular);
    // Nothing is left of an extension whose factor is zero
    let coat = reader.extension(source, CLEARCOAT, |coat: &Clearcoat| coat.clearcoat_factor != 0.0)?;
    let sheen = reader.extension(source, SHEEN, |sheen: &Sheen| sheen.sheen_color_factor != [0.0; 3])?;
    let through = |it: &DiffuseTransmission| it.diffuse_transmission_factor != 0.0;
    let film = reader.iridescence(source)?;
    let diffused = reader.extension(source, DIFFUSE_TRANSMISSION, through)?;
    let pane: Transmission = reader.extension(source, TRANSMISSION, |_| true)?;
    let sheen_color = reader.fractions("sheenColorFactor", sheen.sheen_color_factor);
    let transmission_color =
        reader.fractions("diffuseTransmissionColorFactor", diffused.diffuse_transmission_color_factor);
    let material = Material {
        base_color: Vec3::new(r, g, b),
        metalness,
        roughness,
        dielectric_f0,
        dielectric_f90,
        coat: reader.fraction("clearcoatFactor", coat.clearcoat_factor),
        coat_roughness: reader.fraction("clearcoatRoughnessFactor", coat.clearcoat_roughness_factor),
        sheen_color: Vec3::from_array(sheen_color),
        sheen_roughness: reader.fraction("sheenRoughnessFactor", sheen.sheen_roughness_factor),
        film: film.film(),
        transmission: reader.fraction("diffuseTransmissionFactor", diffused.diffuse_transmission_factor),
        transmission_color: Vec3::from_array(transmission_color),
        glass: reader.fraction("transmissionFactor", pane.transmission_factor),
    };
    let anisotropy = reader.anisotropy(source)?;
    let anisotropy_strength = reader.fraction("anisotropyStrength", anisotropy.anisotropy_strength);
    let emission = reader.emission(source);
    let (normal, coat_normal) = (source.normal_texture.as_ref(), coat.clearcoat_normal_texture.as_ref());
    let alpha_cutoff = match source.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => Some(source.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0)),
        Checked::Valid(AlphaMode::Blend) => {
            reader.warn("alphaMode BLEND: seen whole where alpha is 0.5 or more; its shadow is blended");
            None
        }
        _ => None,
    };
    let read = SceneMaterial {
        name,
        material,
        base_alpha,
        emission,
        base_color_texture: reader.texture(pbr.base_color_texture.as_ref(), true)?,
        metallic_roughness_texture: reader.texture(pbr.metallic_roughness_texture.as_ref(), false)?,
        specular_texture: reader.texture(specular.specular_texture.as_ref(), false)?,
        specular_color_texture: reader.texture(specular.specular_color_texture.as_ref(), true)?,
        emission_texture: reader.texture(source.emissive_texture.as_ref(), true)?,
        normal_texture: reader.normal_texture(normal)?,
        normal_scale: normal_scale(normal),
        coat_texture: reader.texture(coat.clearcoat_texture.as_ref(), false)?,
        coat_roughness_texture: reader.texture(coat.clearcoat_roughness_texture.as_ref(), false)?,
        coat_normal_texture: reader.normal_texture(coat_normal)?,
        coat_normal_scale: normal_scale(coat_normal),
        sheen_color_texture: reader.texture(sheen.sheen_color_texture.as_ref(), true)?,
        sheen_roughness_texture: reader.texture(sheen.sheen_roughness_texture.as_ref(), false)?,
        anisotropy_strength,
        anisotropy_rotation: anisotropy.anisotropy_rotation,
        anisotropy_texture: reader.texture(anisotropy.anisotropy_texture.as_ref(), false)?,
        film_texture: reader.texture(film.iridescence_texture.as_ref(), false)?,
        film_thickness_texture: reader.texture(film.iridescence_thickness_texture.as_ref(), false)?,
        film_least_thickness: film.iridescence_thickness_minimum,
        transmission_texture: reader.texture(diffused.diffuse_transmission_texture.as_ref(), false)?,
        transmission_color_texture: reader
            .texture(diffused.diffuse_transmission_color_texture.as_ref(), true)?,
        glass_texture: reader
            .texture(pane.transmission_texture.as_ref().filter(|_| material.glass > 0.0), false)?,
        alpha_cutoff,
        blended: matches!(source.alpha_mode, Checked::Valid(AlphaMode::Blend)),
        double_sided: source.double_sided,
        unlit: source.extensions.as_ref().is_some_and(|e| e.others.contains_key(UNLIT)),
    };
    Ok(if read.unlit { without_light(read) } else { read })
}

/// What is left of a material whose base colour is shown, whatever lights it.
fn without_light(read: SceneMaterial) -> SceneMaterial {
    let base_color = read.material.base_color;
    let black = Material { dielectric_f0: Vec3::ZERO, dielectric_f90: 0.0, ..Material::default() };
    SceneMaterial {
        name: read.name,
        material: Material { base_color, ..black },
        base_alpha: read.base_alpha,
        base_color_texture: read.base_color_texture,
        alpha_cutoff: read.alpha_cutoff,
        blended: read.blended,
        double_sided: read.double_sided,
        unlit: true,
        ..SceneMaterial::default()
    }
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

    fn fraction(&mut self, field: &str, value: f32) -> f32 {
        let [clamped] = self.fractions(field, [value]);
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
        let weight = self.fraction("specularFactor", specular.specular_factor.0);
        let color = Vec3::from_array(specular.specular_color_factor.0.map(|c| c.clamp(0.0, f32::MAX)));
        let f0 = color * by_index;
        // What is above 1 is cut off where the colour's texture has been multiplied in
        let f0 = if specular.specular_color_texture.is_some() { f0 } else { f0.min(Vec3::ONE) };
        (f0 * weight, weight)
    }

    /// What an extension says that the gltf crate does not read; its defaults without it, and where there is
    /// nothing of it.
    fn extension<T: Default + DeserializeOwned>(
        &self,
        source: &json::Material,
        name: &str,
        is_there: impl Fn(&T) -> bool,
    ) -> Result<T, SceneError> {
        let extension = source.extensions.as_ref().and_then(|e| e.others.get(name));
        let Some(extension) = extension else { return Ok(T::default()) };
        let field = || format!("{}: {name}", self.place);
        let read = T::deserialize(extension);
        let read = read.map_err(|error| self.document.invalid(field(), error.to_string()))?;
        Ok(if is_there(&read) { read } else { T::default() })
    }

    /// The anisotropy; nothing of it where its strength is zero.
    fn anisotropy(&mut self, source: &json::Material) -> Result<Anisotropy, SceneError> {
        let mut anisotropy: Anisotropy = self.extension(source, ANISOTROPY, |_| true)?;
        let rotation = &mut anisotropy.anisotropy_rotation;
        if !rotation.is_finite() {
            self.warn(format!("anisotropyRotation {rotation} is not finite: 0 is used"));
            *rotation = 0.0;
        }
        Ok(if anisotropy.anisotropy_strength == 0.0 { Anisotropy::default() } else { anisotropy })
    }

    /// The thin film; nothing of it where its factor is zero, or it has no thickness anywhere.
    fn iridescence(&mut self, source: &json::Material) -> Result<Iridescence, SceneError> {
        let mut film: Iridescence = self.extension(source, IRIDESCENCE, |_| true)?;
        if film.iridescence_factor == 0.0 {
            return Ok(Iridescence::default());
        }
        film.iridescence_factor = self.fraction("iridescenceFactor", film.iridescence_factor);
        let ior = &mut film.iridescence_ior;
        if !(1.0..=MAX_FILM_IOR).contains(ior) {
            self.warn(format!("iridescenceIor {ior} is not in 1 to {MAX_FILM_IOR}: 1.3 is used"));
            *ior = 1.3;
        }
        let (least, most) =
            (&mut film.iridescence_thickness_minimum, &mut film.iridescence_thickness_maximum);
        for (name, thickness) in
            [("iridescenceThicknessMinimum", &mut *least), ("iridescenceThicknessMaximum", &mut *most)]
        {
            if !thickness.is_finite() || *thickness < 0.0 {
                self.warn(format!("{name} {thickness} is no thickness: 0 is used"));
                *thickness = 0.0;
            }
        }
        // Without a texture, the film is as thick as it gets
        let is_thick = *most > 0.0 || (film.iridescence_thickness_texture.is_some() && *least > 0.0);
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
        info.map(|info| self.textures.texture(info.index.value(), srgb)).transpose()
    }

    fn normal_texture(
        &mut self,
        info: Option<&json::material::NormalTexture>,
    ) -> Result<Option<u32>, SceneError> {
        info.map(|info| self.textures.texture(info.index.value(), false)).transpose()
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

fn normal_scale(info: Option<&json::material::NormalTexture>) -> f32 {
    info.map(|info| info.scale).filter(|scale| scale.is_finite()).unwrap_or(1.0)
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
#[serde(default, rename_all = "camelCase")]
#[expect(clippy::struct_field_names, reason = "fields of glTF's extensions have its names, here and below")]
struct Iridescence {
    iridescence_factor: f32,
    iridescence_texture: Option<json::texture::Info>,
    iridescence_ior: f32,
    iridescence_thickness_minimum: f32,
    iridescence_thickness_maximum: f32,
    iridescence_thickness_texture: Option<json::texture::Info>,
}

impl Default for Iridescence {
    fn default() -> Self {
        Self {
            iridescence_factor: 0.0,
            iridescence_texture: None,
            iridescence_ior: 1.3,
            iridescence_thickness_minimum: 100.0,
            iridescence_thickness_maximum: 400.0,
            iridescence_thickness_texture: None,
        }
    }
}

impl Iridescence {
    fn film(&self) -> Option<ThinFilm> {
        let numbers = [self.iridescence_factor, self.iridescence_ior, self.iridescence_thickness_maximum];
        let [weight, ior, thickness] = numbers.map(f64::from);
        (weight > 0.0).then_some(ThinFilm { weight, ior, thickness })
    }
}

/// `KHR_materials_anisotropy`.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
#[expect(clippy::struct_field_names, reason = "as above")]
struct Anisotropy {
    anisotropy_strength: f32,
    anisotropy_rotation: f32,
    anisotropy_texture: Option<json::texture::Info>,
}

/// `KHR_materials_sheen`.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
#[expect(clippy::struct_field_names, reason = "as above")]
struct Sheen {
    sheen_color_factor: [f32; 3],
    sheen_color_texture: Option<json::texture::Info>,
    sheen_roughness_factor: f32,
    sheen_roughness_texture: Option<json::texture::Info>,
}

/// `KHR_materials_clearcoat`.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
#[expect(clippy::struct_field_names, reason = "as above")]
struct Clearcoat {
    clearcoat_factor: f32,
    clearcoat_texture: Option<json::texture::Info>,
    clearcoat_roughness_factor: f32,
    clearcoat_roughness_texture: Option<json::texture::Info>,
    clearcoat_normal_texture: Option<json::material::NormalTexture>,
}

/// `KHR_materials_transmission`.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Transmission {
    transmission_factor: f32,
    transmission_texture: Option<json::texture::Info>,
}

/// `KHR_materials_diffuse_transmission`.
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
#[expect(clippy::struct_field_names, reason = "as above")]
struct DiffuseTransmission {
    diffuse_transmission_factor: f32,
    diffuse_transmission_texture: Option<json::texture::Info>,
    diffuse_transmission_color_factor: [f32; 3],
    diffuse_transmission_color_texture: Option<json::texture::Info>,
}

impl Default for DiffuseTransmission {
    fn default() -> Self {
        Self {
            diffuse_transmission_factor: 0.0,
            diffuse_transmission_texture: None,
            diffuse_transmission_color_factor: [1.0; 3],
            diffuse_transmission_color_texture: None,
        }
    }
}
