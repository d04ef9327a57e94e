//! Data laid out as these kernels read it (std430). A test compares every offset with the SPIR-V.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};

/// Push constants of the Monte Carlo reference kernel.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ReferenceConstants {
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// How many lights are shaded.
    pub light_count: u32,
    /// The index of this dispatch's first sample: a pixel's random numbers depend on it, the pixel and
    /// `seed`.
    pub first_sample: u32,
    /// Samples this dispatch adds.
    pub sample_count: u32,
    /// What this dispatch's mean is multiplied with before it is added: `sample_count / total`.
    pub weight: f32,
    /// Another seed gives independent noise.
    pub seed: u32,
    /// How many shapes are shaded.
    pub shape_count: u32,
}

/// Push constants of the Monte Carlo reference of media.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct MediumReferenceConstants {
    /// From clip space to positions.
    pub position_from_clip: [[f32; 4]; 4],
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// How many polygons and meshes shine.
    pub light_count: u32,
    /// What is scattered per unit of length, a channel.
    pub scattering: [f32; 3],
    /// What is scattered or absorbed per unit of length.
    pub extinction: f32,
    /// How many shapes shine.
    pub shape_count: u32,
    /// As [`ReferenceConstants::first_sample`]; at 0 the picture is dimmed, too.
    pub first_sample: u32,
    /// As [`ReferenceConstants::sample_count`].
    pub sample_count: u32,
    /// As [`ReferenceConstants::weight`].
    pub weight: f32,
    /// Henyey and Greenstein's g.
    pub anisotropy: f32,
    /// Where the medium ends.
    pub farthest: f32,
    /// Another seed gives independent noise.
    pub seed: u32,
    /// Zero.
    pub reserved: u32,
}

/// A light's triangle for the reference's light sampling: three vertex indices, and the sum of the areas of
/// this light's triangles up to and with this one.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuLightTriangle {
    /// Indices into the light vertex buffer.
    pub vertices: [u32; 3],
    /// Cumulative area, divided by the light's area: 1 in the light's last triangle.
    pub cumulative: f32,
}

/// A light's range of triangles for the reference kernel.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuLightSampling {
    /// Unit normal of the front; zero for a mesh.
    pub normal: [f32; 3],
    /// Area.
    pub area: f32,
    /// Index of the first triangle.
    pub first_triangle: u32,
    /// How many triangles the light has.
    pub triangle_count: u32,
    /// Zero.
    pub reserved: [u32; 2],
}

/// One point in a medium of the eval kernel of those; its light is at the same index.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuMediumCase {
    /// Direction to the viewer, of any length.
    pub view: [f32; 3],
    /// Henyey and Greenstein's g.
    pub anisotropy: f32,
}

/// One shading point of the eval kernel. Its light's center is relative to the point.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuCase {
    /// Normal, of any length.
    pub normal: [f32; 3],
    /// Perceptual roughness.
    pub roughness: f32,
    /// Direction to the viewer, of any length.
    pub view: [f32; 3],
    /// Schlick's reflectance at grazing incidence.
    pub f90: f32,
    /// Lambert albedo.
    pub diffuse_albedo: [f32; 3],
    /// Index of the light.
    pub light: u32,
    /// Schlick's reflectance at normal incidence.
    pub f0: [f32; 3],
    /// Weight of the coat; 0 for none.
    pub coat_weight: f32,
    /// The coat's normal, of any length; zero for the surface's.
    pub coat_normal: [f32; 3],
    /// The coat's perceptual roughness.
    pub coat_roughness: f32,
    /// Colour of the sheen; black for none.
    pub sheen_color: [f32; 3],
    /// The sheen's perceptual roughness.
    pub sheen_roughness: f32,
    /// Reflectance of the interface above the Lambert lobe, at normal incidence; with both 0 there is none.
    pub interface_f0: f32,
    /// At grazing incidence.
    pub interface_f90: f32,
    /// Roughness of the diffuse lobe; 0 is Lambert's.
    pub diffuse_roughness: f32,
    /// Zero.
    pub reserved: f32,
    /// Tangent of the anisotropy, of any length.
    pub tangent: [f32; 3],
    /// Perceptual roughness along it.
    pub tangent_roughness: f32,
    /// How much of the surface a thin film covers; 0 for none.
    pub film_weight: f32,
    /// The film's index of refraction.
    pub film_ior: f32,
    /// Its thickness in nanometres.
    pub film_thickness: f32,
    /// Zero.
    pub reserved1: f32,
}

/// Push constants of the eval kernel, and of its twin for shapes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct EvalConstants {
    /// How many cases there are.
    pub case_count: u32,
}

/// A triangle of the visibility kernel, in the order of the hierarchy's leaves.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuTriangle {
    /// First vertex, relative to the origin.
    pub p0: [f32; 3],
    /// Index of the material.
    pub material: u32,
    /// Second vertex.
    pub p1: [f32; 3],
    /// Texture coordinate v of the first vertex.
    pub v0: f32,
    /// Third vertex.
    pub p2: [f32; 3],
    /// Texture coordinate v of the second vertex.
    pub v1: f32,
    /// Normal at the first vertex.
    pub n0: [f32; 3],
    /// Texture coordinate u of the first vertex.
    pub u0: f32,
    /// Normal at the second vertex.
    pub n1: [f32; 3],
    /// Texture coordinate u of the second vertex.
    pub u1: f32,
    /// Normal at the third vertex.
    pub n2: [f32; 3],
    /// Texture coordinate u of the third vertex.
    pub u2: f32,
    /// Texture coordinate v of the third vertex.
    pub v2: f32,
    /// [`GpuTriangle::TANGENTS`], [`GpuTriangle::MIRRORED`], [`GpuTriangle::COLORS`];
    /// the groups of [`arealight::Light::links`] from [`GpuTriangle::GROUPS_SHIFT`] on.
    pub flags: u32,
    /// Tangent at the first vertex: its place on the unfolded octahedron, of two numbers of 16 bits with a
    /// sign.
    pub tangent0: u32,
    /// Tangent at the second vertex.
    pub tangent1: u32,
    /// Tangent at the third vertex.
    pub tangent2: u32,
    /// What the base colour is multiplied with at the first vertex: square roots of linear red, green and
    /// blue, and alpha, in 255ths from the low byte on.
    pub color0: u32,
    /// At the second vertex.
    pub color1: u32,
    /// At the third vertex.
    pub color2: u32,
}

impl GpuTriangle {
    /// It has tangents.
    pub const TANGENTS: u32 = 1;
    /// Its bitangents are `cross(tangent, normal)`, not `cross(normal, tangent)`.
    pub const MIRRORED: u32 = 2;
    /// Some of its vertices have a colour other than white.
    pub const COLORS: u32 = 4;
    /// Where its groups begin.
    pub const GROUPS_SHIFT: u32 = 8;
}

/// A material of the visibility kernel. Texture indices are [`GpuMaterial::NO_TEXTURE`] where there is none.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuMaterial {
    /// Linear base colour factor.
    pub base_color: [f32; 3],
    /// Metalness factor.
    pub metalness: f32,
    /// Emitted radiance, as the camera sees it.
    pub emission: [f32; 3],
    /// Perceptual roughness factor.
    pub roughness: f32,
    /// Reflectance of the dielectric at normal incidence.
    pub dielectric_f0: [f32; 3],
    /// Reflectance of the dielectric at grazing incidence.
    pub dielectric_f90: f32,
    /// sRGB texture times `base_color`.
    pub base_color_texture: u32,
    /// Linear texture: green times `roughness`, blue times `metalness`.
    pub metallic_roughness_texture: u32,
    /// Tangent-space normal texture.
    pub normal_texture: u32,
    /// Scale of the normal texture's x and y.
    pub normal_scale: f32,
    /// [`GpuMaterial::DOUBLE_SIDED`], [`GpuMaterial::ALPHA_MASK`].
    pub flags: u32,
    /// Base colour alpha below which a masked hit is passed through.
    pub alpha_cutoff: f32,
    /// Base colour alpha factor.
    pub base_alpha: f32,
    /// sRGB texture times `emission`.
    pub emission_texture: u32,
    /// Weight factor of the coat.
    pub coat: f32,
    /// Perceptual roughness factor of the coat.
    pub coat_roughness: f32,
    /// Linear texture: red times `coat`.
    pub coat_texture: u32,
    /// Linear texture: green times `coat_roughness`.
    pub coat_roughness_texture: u32,
    /// Tangent-space normal texture of the coat.
    pub coat_normal_texture: u32,
    /// Scale of its x and y.
    pub coat_normal_scale: f32,
    /// sRGB texture times `sheen_color`.
    pub sheen_color_texture: u32,
    /// Linear texture: alpha times `sheen_roughness`.
    pub sheen_roughness_texture: u32,
    /// Colour factor of the sheen.
    pub sheen_color: [f32; 3],
    /// Perceptual roughness factor of the sheen.
    pub sheen_roughness: f32,
    /// Linear texture: a direction in tangent space in red and green, blue times `anisotropy_strength`.
    pub anisotropy_texture: u32,
    /// `anisotropyStrength` of `KHR_materials_anisotropy`.
    pub anisotropy_strength: f32,
    /// Unit direction in tangent space that the texture's is rotated by.
    pub anisotropy_direction: [f32; 2],
    /// How much a thin film covers; 0 for none.
    pub film_weight: f32,
    /// Its index of refraction.
    pub film_ior: f32,
    /// Its thickness in nanometres where the texture's green is 0.
    pub film_least_thickness: f32,
    /// And where it is 1, or there is no texture.
    pub film_thickness: f32,
    /// Linear texture: red times `film_weight`.
    pub film_texture: u32,
    /// Linear texture whose green says how thick the film is.
    pub film_thickness_texture: u32,
    /// Linear texture: alpha times `transmission`.
    pub transmission_texture: u32,
    /// sRGB texture times `transmission_color`.
    pub transmission_color_texture: u32,
    /// Colour factor of what is let through, of the diffuse part.
    pub transmission_color: [f32; 3],
    /// How much of the diffuse part is let through instead of reflected.
    pub transmission: f32,
    /// Linear texture: alpha times `dielectric_f0` and `dielectric_f90`.
    pub specular_texture: u32,
    /// sRGB texture times `dielectric_f0`, which is cut off at `dielectric_f90` after it.
    pub specular_color_texture: u32,
    /// Linear texture: red times `glass`.
    pub glass_texture: u32,
    /// How much of the diffuse part a pane lets through undiffused instead, by its base colour.
    pub glass: f32,
}

/// How far an orthographic camera's position is, in lengths of the direction to it: directions to it differ
/// by this part of a radian.
const FAR_AWAY: f32 = 1e5;

impl VisibilityConstants {
    /// From clip space to positions. The depth is that of a far plane at infinity; of an orthographic camera,
    /// it grows with the distance.
    pub fn position_from_clip(&self) -> Mat4 {
        let [camera, right, up, forward] =
            [self.camera, self.right, self.up, self.forward].map(Vec3::from_array);
        if self.orthographic != 0 {
            return Mat4::from_cols(
                right.extend(0.0),
                -up.extend(0.0),
                forward.extend(0.0),
                camera.extend(1.0),
            );
        }
        let row = |axis: Vec3| axis / axis.length_squared();
        let (right, down, forward) = (row(right), -row(up), row(forward));
        // The depth is 1 over the distance along the axis
        let rows = [right.extend(0.0), down.extend(0.0), Vec4::W, forward.extend(0.0)];
        let clip_from_view = Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
        (clip_from_view * Mat4::from_translation(-camera)).inverse()
    }

    /// The camera as the shade kernel has it: its position, or the direction to an orthographic one.
    pub fn seen_from(&self) -> Vec3 {
        if self.orthographic == 0 { Vec3::from_array(self.camera) } else { -Vec3::from_array(self.forward) }
    }

    /// The camera's position, for kernels that know of no other cameras: an orthographic one is so far away
    /// that all directions to it are one.
    pub fn position(&self) -> Vec3 {
        Vec3::from_array(self.camera)
            + if self.orthographic == 0 { Vec3::ZERO } else { FAR_AWAY * self.seen_from() }
    }
}

impl GpuMaterial {
    /// No texture.
    pub const NO_TEXTURE: u32 = u32::MAX;
    /// Seen from both sides.
    pub const DOUBLE_SIDED: u32 = 1;
    /// Transparent where the base colour's alpha is below the cutoff.
    pub const ALPHA_MASK: u32 = 2;
    /// There by the part that is the base colour's alpha.
    pub const ALPHA_BLEND: u32 = 4;
    /// Shows its base colour.
    pub const UNLIT: u32 = 8;

    /// Whether all of a surface is there, whatever its alpha.
    pub fn is_whole(&self) -> bool {
        self.flags & (Self::ALPHA_MASK | Self::ALPHA_BLEND) == 0
    }
}

/// A texture of the visibility kernel: a range of the texel buffer, one RGBA8 texel a `u32`, red in the low
/// byte, rows from the top. After those come the texels of its smaller levels, each of half the width and
/// height, rounded down but not to zero, to one texel.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct GpuTexture {
    /// Index of the first texel.
    pub first_texel: u32,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// [`GpuTexture::SRGB`], and a wrap mode for each axis.
    pub flags: u32,
}

impl GpuTexture {
    /// Red, green and blue are sRGB-encoded.
    pub const SRGB: u32 = 1;
    /// u is clamped to the edge (else repeated).
    pub const CLAMP_U: u32 = 2;
    /// v is clamped to the edge (else repeated).
    pub const CLAMP_V: u32 = 4;
    /// u is mirrored at every repeat.
    pub const MIRROR_U: u32 = 8;
    /// v is mirrored at every repeat.
    pub const MIRROR_V: u32 = 16;
}

/// Push constants of the visibility kernel: a camera.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct VisibilityConstants {
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// 1: lines of sight are parallel; else 0.
    pub orthographic: u32,
    /// From the middle of the image to its right edge, at distance 1 along `forward`; of an orthographic
    /// camera at any distance.
    pub right: [f32; 3],
    /// Lines of sight of a pixel along each axis, a texel each. Those of a pixel are in rows and columns of
    /// their own: an edge along either has as many steps as there are lines. 0 is 1.
    pub supersample: u32,
    /// Likewise to its top edge.
    pub up: [f32; 3],
    /// Of the picture's rows of texels, the one that the image begins at.
    pub first_row: u32,
    /// Unit viewing direction; of an orthographic camera as long as a perspective one that sees as much would
    /// be away.
    pub forward: [f32; 3],
    /// Zero.
    pub reserved3: u32,
    /// Radiance where nothing is hit.
    pub background: [f32; 3],
    /// Zero.
    pub reserved4: u32,
}
