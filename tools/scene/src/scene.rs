//! What a scene holds.

use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::messages::Warning;
use arealight::Light;
pub use arealight::texture_part::Wrap;
use arealight_oracle::material::Material;
use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};
use std::collections::HashSet;
use std::ops::Range;
use std::path::PathBuf;

/// The most triangles a scene may have; a file beyond is refused.
pub const MAX_TRIANGLES: usize = 1 << 24;

/// What is said of a scene without lights.
pub(crate) const NO_LIGHTS: &str = "has no area lights (emissive faces or EXT_lights_area): surfaces are \
black (--lights studio adds softboxes)";

/// A scene, as a renderer needs it.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// The glTF scene's name, else the file's.
    pub name: String,
    /// Every visible triangle; emissive ones too.
    pub triangles: Vec<Triangle>,
    /// Materials that the triangles use.
    pub materials: Vec<SceneMaterial>,
    /// Textures that the materials use.
    pub textures: Vec<Texture>,
    /// Images that the textures use.
    pub images: Vec<Image>,
    /// Every light; each passes [`Light::validate`].
    pub lights: Vec<Light>,
    /// What can be moved of the lights: each of them is one lamp's.
    pub lamps: Vec<SceneLamp>,
    /// What the textured lights show, at most [`crate::MAX_LIGHT_TEXTURES`]: their layers, in order.
    pub light_textures: Vec<SceneLightTexture>,
    /// The file's cameras, in the order of its nodes.
    pub cameras: Vec<Camera>,
    /// What all of it is in.
    pub fog: Option<SceneFog>,
    /// Holds every triangle, or every light if there is no triangle.
    pub bounds: Bounds,
    /// What the file has that is not shown as it says, and what was done instead.
    pub warnings: Vec<Warning>,
    /// What is shown as the file means, though not word for word: nothing is lost.
    pub notes: Vec<Warning>,
    /// The files beside the scene's own that were read for it.
    pub files: HashSet<PathBuf>,
}

/// An even medium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneFog {
    /// Extinction per metre, above 0.
    pub density: f64,
    /// Henyey and Greenstein's g, in (-1, 1): above 0 light goes on forwards.
    pub anisotropy: f64,
    /// What is scattered of what is taken away, in [0, 1].
    pub albedo: f64,
}

/// What emits: lights, and the triangles that look like them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneLamp {
    /// Those of [`Scene::triangles`]; none of a light that no mesh is.
    pub triangles: Range<usize>,
    /// Those of [`Scene::lights`].
    pub lights: Range<usize>,
}

impl Scene {
    /// Whether a triangle is what one of the lights looks like.
    pub fn is_lamp(&self, triangle: usize) -> bool {
        self.lamps.iter().any(|lamp| lamp.triangles.contains(&triangle))
    }
}

impl SceneLamp {
    /// One for each of some lights that nothing looks like.
    pub(crate) fn bare(lights: Range<usize>) -> impl Iterator<Item = Self> {
        lights.map(|light| Self { triangles: 0..0, lights: light..light + 1 })
    }
}

/// A triangle. Seen from its front the vertices run counter-clockwise, also under mirroring transforms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// World positions.
    pub positions: [DVec3; 3],
    /// Unit shading normals in world space; where the file has none, the triangle's own.
    pub normals: [Vec3; 3],
    /// Texture coordinates; zero where the file has none. (0, 0) is the image's upper left corner.
    pub uvs: [Vec2; 3],
    /// Unit tangents, the direction of growing u, in xyz, and in w, 1 or -1, the side of the bitangent,
    /// `cross(normal, tangent) w`. Zero where no material needs them, or nothing in the file says what they
    /// are.
    pub tangents: [Vec4; 3],
    /// What the base colour is multiplied with at each vertex: the square roots of linear red, green and
    /// blue, which keep dark colours apart, and alpha, in 255ths.
    pub colors: [[u8; 4]; 3],
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// The groups that it is in, for [`Light::links`].
    pub groups: u8,
}

impl Triangle {
    /// [`Triangle::colors`] of a vertex whose colour is its material's.
    pub const WHITE: [u8; 4] = [255; 4];
}

/// A material: factors, and the textures that multiply them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneMaterial {
    /// The file's name for it, or its index.
    pub name: String,
    /// Factors, each in range.
    pub material: Material,
    /// Factor of the base colour's alpha, in [0, 1].
    pub base_alpha: f32,
    /// Emitted radiance, W/(m² sr), not negative.
    pub emission: Vec3,
    /// Index into [`Scene::textures`] of an sRGB texture times base colour and alpha.
    pub base_color_texture: Option<u32>,
    /// Of a linear texture: green times roughness, blue times metalness.
    pub metallic_roughness_texture: Option<u32>,
    /// Of a linear texture: alpha times the dielectric's reflectances, normal and grazing.
    pub specular_texture: Option<u32>,
    /// Of an sRGB texture times the dielectric's reflectance at normal incidence, which it cuts off at that
    /// at grazing incidence.
    pub specular_color_texture: Option<u32>,
    /// Of a linear texture of tangent-space normals.
    pub normal_texture: Option<u32>,
    /// Scale of the normal texture's x and y.
    pub normal_scale: f32,
    /// Of an sRGB texture times emission.
    pub emission_texture: Option<u32>,
    /// Of a linear texture: red times the coat's weight.
    pub coat_texture: Option<u32>,
    /// Of a linear texture: green times the coat's roughness.
    pub coat_roughness_texture: Option<u32>,
    /// Of a linear texture of the coat's tangent-space normals. Without one the coat is as the geometry is,
    /// whatever bends the base.
    pub coat_normal_texture: Option<u32>,
    /// Scale of its x and y.
    pub coat_normal_scale: f32,
    /// Of an sRGB texture times the sheen's colour.
    pub sheen_color_texture: Option<u32>,
    /// Of a linear texture: alpha times the sheen's roughness.
    pub sheen_roughness_texture: Option<u32>,
    /// How much longer highlights are along the direction of anisotropy, in [0, 1]: `anisotropyStrength`. 0
    /// for none.
    pub anisotropy_strength: f32,
    /// That direction's angle from the tangent towards the bitangent, radians.
    pub anisotropy_rotation: f32,
    /// Of a linear texture: a direction in tangent space in red and green, blue times the strength.
    pub anisotropy_texture: Option<u32>,
    /// Of a linear texture: red times the film's weight.
    pub film_texture: Option<u32>,
    /// Of a linear texture whose green says how thick the film is: from the least thickness to the film's
    /// own.
    pub film_thickness_texture: Option<u32>,
    /// The film's thickness where that texture is 0, in nanometres.
    pub film_least_thickness: f32,
    /// Of a linear texture: alpha times how much is let through.
    pub transmission_texture: Option<u32>,
    /// Of an sRGB texture times the colour of that.
    pub transmission_color_texture: Option<u32>,
    /// Of a linear texture: red times how much of it is a pane.
    pub glass_texture: Option<u32>,
    /// Alpha below which a surface is not there; none for opaque materials.
    pub alpha_cutoff: Option<f32>,
    /// A surface is there by the part that is its alpha: its shadow is as dark, and where that is less than a
    /// half it is not seen.
    pub blended: bool,
    /// Seen from both sides. Other surfaces are seen from their front only.
    pub double_sided: bool,
    /// Shows its base colour as radiance, whatever lights it, and lights nothing.
    pub unlit: bool,
}

/// How an image is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Texture {
    /// Index into [`Scene::images`].
    pub image: u32,
    /// Red, green and blue are sRGB-encoded.
    pub srgb: bool,
    /// Beyond 0 to 1 in u.
    pub wrap_u: Wrap,
    /// Beyond 0 to 1 in v.
    pub wrap_v: Wrap,
}

/// A layer of the light textures: a rectangle of a texture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneLightTexture {
    /// Index into [`Scene::textures`]. Its image is within the limits of [`arealight::TexturePart`]; a larger
    /// one has been scaled down.
    pub texture: u32,
    /// The corner that is (0, 0) in the layer, in the texture's coordinates. It may be outside of [0, 1],
    /// where the texture's wrap modes say what there is.
    pub low: DVec2,
    /// Width and height, in the texture's coordinates; both are positive.
    pub size: DVec2,
    /// [`arealight::TexturePart::aspect`] of the first light that shows it.
    pub aspect: f32,
    /// A disk or ellipse shows it.
    pub is_ellipse: bool,
}

/// A decoded image.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Image {
    /// The file's name for it, or its index.
    pub name: String,
    /// Width in texels, not zero.
    pub width: u32,
    /// Height in texels, not zero.
    pub height: u32,
    /// Red in the low byte, then green, blue, alpha; rows from the top.
    pub texels: Vec<u32>,
    /// Of one that moves (APNG, WebP) until when each frame is shown, in seconds, and its texels; else empty.
    pub frames: Vec<(f64, Vec<u32>)>,
}

impl Scene {
    /// The camera called `name`, or the file's first, or, where the file has none,
    /// [`Scene::framing_camera`]. None if `name` is given and no camera has it.
    pub fn camera(&self, name: Option<&str>, aspect: f64) -> Option<Camera> {
        match name {
            Some(name) => self.cameras.iter().find(|camera| camera.name == name).cloned(),
            None => Some(self.cameras.first().cloned().unwrap_or_else(|| self.framing_camera(aspect))),
        }
    }

    /// A camera that sees the whole scene, from the front, a little from the right and from above, in an
    /// image of `aspect` (width over height).
    pub fn framing_camera(&self, aspect: f64) -> Camera {
        Camera::framing("framing", self.bounds, DVec3::new(-0.45, -0.35, -1.0), DVec3::Y, aspect)
    }
}
