//! A scene as the visibility kernel reads it.

use crate::camera::Camera;
use crate::mips;
use crate::scene::{Scene, SceneMaterial, Texture, Triangle, Wrap};
use arealight::gpu::GpuBvhNode;
use arealight::{BlockerError, Blockers};
use arealight_oracle::thin_film::ThinFilm;
use arealight_tool_kernels::gpu::{GpuMaterial, GpuTexture, GpuTriangle, VisibilityConstants};
use glam::{DVec3, Vec3};

pub use crate::rays::Hit;

/// The buffers of the visibility kernel, and of the shade pass's own hierarchy. Any of them may be empty.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneBuffers {
    /// What positions are relative to.
    pub origin: DVec3,
    /// The hierarchy: [`Blockers::nodes`].
    pub nodes: Vec<GpuBvhNode>,
    /// In the order of the hierarchy's leaves.
    pub triangles: Vec<GpuTriangle>,
    /// In the order of [`Scene::materials`].
    pub materials: Vec<GpuMaterial>,
    /// In the order of [`Scene::textures`].
    pub textures: Vec<GpuTexture>,
    /// The images' texels, one after the other, each followed by its smaller levels': 128 MiB at most, for
    /// which the largest images lose their finest levels.
    pub texels: Vec<u32>,
}

/// Why a scene cannot be packed. Scenes that were loaded can, about any origin that is finite and no farther
/// out than [`crate::MAX_COORDINATE`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BufferError {
    /// A vertex is NaN or too far from the origin.
    #[error(transparent)]
    Triangles(#[from] BlockerError),
    /// An index points at nothing.
    #[error("{field}: index {index}, but there are {count}")]
    BadIndex {
        /// Where the index is.
        field: String,
        /// Its value.
        index: u32,
        /// How many there are.
        count: usize,
    },
}

impl SceneBuffers {
    /// Whether a material is not all there: what sends rays asks for alpha then.
    pub fn has_alpha(&self) -> bool {
        self.materials.iter().any(|material| !material.is_whole())
    }

    /// Packs `scene` relative to `origin`; the subtraction is made in float64. Use the same origin for the
    /// lights ([`arealight::PackedLights::new`]).
    ///
    /// # Errors
    /// [`BufferError`] names the triangle or index.
    pub fn new(scene: &Scene, origin: DVec3) -> Result<Self, BufferError> {
        check_indices(scene)?;
        // Round the triangles once, and build the hierarchy of what the GPU will see
        let unordered: Vec<GpuTriangle> = scene.triangles.iter().map(|t| pack(t, origin)).collect();
        let vertices = |t: &GpuTriangle| [t.p0, t.p1, t.p2].map(Vec3::from_array);
        let blockers = Blockers::new(&unordered.iter().map(vertices).collect::<Vec<_>>())?;
        let (places, texels) = mips::pack(scene, mips::MOST_TEXELS);
        let texture = |(texture, place): (&Texture, &[u32; 3])| {
            let [first_texel, width, height] = *place;
            GpuTexture { first_texel, width, height, flags: texture_flags(*texture) }
        };
        Ok(Self {
            origin,
            triangles: blockers.order.iter().map(|&i| unordered[i as usize]).collect(),
            nodes: blockers.nodes,
            materials: scene.materials.iter().map(GpuMaterial::from).collect(),
            textures: scene.textures.iter().zip(&places).map(texture).collect(),
            texels,
        })
    }

    /// The texels of a scene whose images show other frames.
    pub fn show_frames(&mut self, scene: &Scene) {
        (_, self.texels) = mips::pack(scene, mips::MOST_TEXELS);
    }

    /// Push constants of the visibility kernel for `camera`, in an image of `size` pixels; `background` is
    /// the radiance where nothing is hit.
    pub fn constants(&self, camera: &Camera, size: [u32; 2], background: Vec3) -> VisibilityConstants {
        camera.constants(size, self.origin, background)
    }

    /// What a ray meets first, from a world position: [`crate::rays::closest_hit`].
    pub fn closest_hit(&self, position: DVec3, direction: DVec3) -> Option<Hit> {
        let position = position - self.origin;
        crate::rays::closest_hit(&self.nodes, &self.triangles, &self.materials, position, direction)
    }
}

fn check_indices(scene: &Scene) -> Result<(), BufferError> {
    let check = |field: &dyn Fn() -> String, index: u32, count: usize| {
        let good = (index as usize) < count;
        if good { Ok(()) } else { Err(BufferError::BadIndex { field: field(), index, count }) }
    };
    for (i, triangle) in scene.triangles.iter().enumerate() {
        check(&|| format!("triangles[{i}].material"), triangle.material, scene.materials.len())?;
    }
    for (i, material) in scene.materials.iter().enumerate() {
        for (name, texture) in material.textures() {
            check(&|| format!("materials[{i}].{name}"), texture, scene.textures.len())?;
        }
    }
    for (i, texture) in scene.textures.iter().enumerate() {
        check(&|| format!("textures[{i}].image"), texture.image, scene.images.len())?;
    }
    for (i, image) in scene.images.iter().enumerate() {
        let (size, count) = (u64::from(image.width) * u64::from(image.height), image.texels.len());
        check(&|| format!("images[{i}].texels"), size.saturating_sub(1) as u32, count)?;
    }
    Ok(())
}

fn pack(triangle: &Triangle, origin: DVec3) -> GpuTriangle {
    let [p0, p1, p2] = triangle.positions.map(|p| (p - origin).as_vec3().to_array());
    let [n0, n1, n2] = triangle.normals.map(|n| n.to_array());
    let [uv0, uv1, uv2] = triangle.uvs;
    let has_tangents = triangle.tangents.iter().all(|tangent| tangent.truncate() != Vec3::ZERO);
    let [tangent0, tangent1, tangent2] = triangle.tangents.map(|tangent| pack_direction(tangent.truncate()));
    let [color0, color1, color2] = triangle.colors.map(u32::from_le_bytes);
    let flag = |on: bool, flag: u32| if on { flag } else { 0 };
    GpuTriangle {
        p0,
        material: triangle.material,
        p1,
        v0: uv0.y,
        p2,
        v1: uv1.y,
        n0,
        u0: uv0.x,
        n1,
        u1: uv1.x,
        n2,
        u2: uv2.x,
        v2: uv2.y,
        flags: u32::from(triangle.groups) << GpuTriangle::GROUPS_SHIFT
            | flag(has_tangents, GpuTriangle::TANGENTS)
            | flag(triangle.colors != [Triangle::WHITE; 3], GpuTriangle::COLORS)
            | flag(triangle.tangents[0].w < 0.0, GpuTriangle::MIRRORED),
        tangent0,
        tangent1,
        tangent2,
        color0,
        color1,
        color2,
    }
}

/// A unit direction's place on the unfolded octahedron, as two numbers of 16 bits with a sign
/// (`unpackSnorm2x16`). Source: Cigolle et al. 2014.
fn pack_direction(direction: Vec3) -> u32 {
    let size = direction.abs().element_sum();
    if size.is_nan() || size <= 0.0 {
        return 0;
    }
    let [x, y, z] = (direction / size).to_array();
    let sign = |value: f32| if value >= 0.0 { 1.0 } else { -1.0 };
    let place = if z >= 0.0 { [x, y] } else { [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)] };
    let [low, high] = place.map(|value| u32::from((value.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16));
    low | high << 16
}

impl From<&SceneMaterial> for GpuMaterial {
    fn from(material: &SceneMaterial) -> Self {
        let texture = |index: Option<u32>| index.unwrap_or(GpuMaterial::NO_TEXTURE);
        let flag = |on: bool, flag: u32| if on { flag } else { 0 };
        let film = material.material.film.unwrap_or(ThinFilm { weight: 0.0, ior: 1.0, thickness: 0.0 });
        Self {
            base_color: material.material.base_color.to_array(),
            metalness: material.material.metalness,
            emission: material.emission.to_array(),
            roughness: material.material.roughness,
            dielectric_f0: material.material.dielectric_f0.to_array(),
            dielectric_f90: material.material.dielectric_f90,
            base_color_texture: texture(material.base_color_texture),
            metallic_roughness_texture: texture(material.metallic_roughness_texture),
            normal_texture: texture(material.normal_texture),
            normal_scale: material.normal_scale,
            flags: flag(material.double_sided, GpuMaterial::DOUBLE_SIDED)
                | flag(material.alpha_cutoff.is_some(), GpuMaterial::ALPHA_MASK)
                | flag(material.blended, GpuMaterial::ALPHA_BLEND)
                | flag(material.unlit, GpuMaterial::UNLIT),
            alpha_cutoff: material.alpha_cutoff.unwrap_or(0.0),
            base_alpha: material.base_alpha,
            emission_texture: texture(material.emission_texture),
            coat: material.material.coat,
            coat_roughness: material.material.coat_roughness,
            coat_texture: texture(material.coat_texture),
            coat_roughness_texture: texture(material.coat_roughness_texture),
            coat_normal_texture: texture(material.coat_normal_texture),
            coat_normal_scale: material.coat_normal_scale,
            sheen_color_texture: texture(material.sheen_color_texture),
            sheen_roughness_texture: texture(material.sheen_roughness_texture),
            sheen_color: material.material.sheen_color.to_array(),
            sheen_roughness: material.material.sheen_roughness,
            anisotropy_texture: texture(material.anisotropy_texture),
            anisotropy_strength: material.anisotropy_strength,
            anisotropy_direction: [material.anisotropy_rotation.cos(), material.anisotropy_rotation.sin()],
            film_weight: film.weight as f32,
            film_ior: film.ior as f32,
            film_least_thickness: material.film_least_thickness,
            film_thickness: film.thickness as f32,
            film_texture: texture(material.film_texture),
            film_thickness_texture: texture(material.film_thickness_texture),
            transmission_texture: texture(material.transmission_texture),
            transmission_color_texture: texture(material.transmission_color_texture),
            transmission_color: material.material.transmission_color.to_array(),
            transmission: material.material.transmission,
            specular_texture: texture(material.specular_texture),
            specular_color_texture: texture(material.specular_color_texture),
            glass_texture: texture(material.glass_texture),
            glass: material.material.glass,
        }
    }
}

fn texture_flags(texture: Texture) -> u32 {
    let wrap = |wrap: Wrap, clamp: u32, mirror: u32| match wrap {
        Wrap::Repeat => 0,
        Wrap::Clamp => clamp,
        Wrap::Mirror => mirror,
    };
    let srgb = if texture.srgb { GpuTexture::SRGB } else { 0 };
    srgb | wrap(texture.wrap_u, GpuTexture::CLAMP_U, GpuTexture::MIRROR_U)
        | wrap(texture.wrap_v, GpuTexture::CLAMP_V, GpuTexture::MIRROR_V)
}
