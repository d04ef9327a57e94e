//! What numbers in structs mean.

/// The Lambert lobe: some surface has a metalness below one and a base colour that is not black.
pub const AREALIGHT_EFFECT_DIFFUSE: u32 = 1;
/// The GGX lobe: some surface reflects specularly.
pub const AREALIGHT_EFFECT_GLOSSY: u32 = 2;
/// Some light lights both of its sides.
pub const AREALIGHT_EFFECT_TWO_SIDED: u32 = 4;
/// Some surface has a dielectric reflectance of its own: AREALIGHT_PLANE_SPECULAR is read.
pub const AREALIGHT_EFFECT_SPECULAR_INPUT: u32 = 8;
/// Some light is concave, not quite flat, or has more than four vertices.
pub const AREALIGHT_EFFECT_POLYGON: u32 = 16;
/// Some polygon is textured: ArealightResources.light_textures is read.
pub const AREALIGHT_EFFECT_TEXTURED: u32 = 32;
/// Some light is a disk or an ellipse.
pub const AREALIGHT_EFFECT_ELLIPSE: u32 = 256;
/// Some light is a sphere.
pub const AREALIGHT_EFFECT_SPHERE: u32 = 512;
/// Some light is a cylinder or a capsule.
pub const AREALIGHT_EFFECT_TUBE: u32 = 1024;
/// Some light has several faces: a mesh.
pub const AREALIGHT_EFFECT_MESH: u32 = 2048;
/// Some disk or ellipse is textured: ArealightResources.light_textures is read. AREALIGHT_EFFECT_ELLIPSE is
/// set then, too.
pub const AREALIGHT_EFFECT_TEXTURED_ELLIPSE: u32 = 4096;
/// Some surface has a clear coat: AREALIGHT_PLANE_COAT is read.
pub const AREALIGHT_EFFECT_COAT: u32 = 8192;
/// Some coat has a normal of its own. AREALIGHT_EFFECT_COAT is set then, too.
pub const AREALIGHT_EFFECT_COAT_NORMAL: u32 = 16384;
/// Diffuse lobes get what the Fresnel term above them leaves, as in glTF; else they are added to the specular
/// lobe.
pub const AREALIGHT_EFFECT_COUPLED: u32 = 32768;
/// They get what the specular lobe's albedo leaves, as in OpenPBR. AREALIGHT_EFFECT_COUPLED is set then, too.
pub const AREALIGHT_EFFECT_COUPLED_BY_ALBEDO: u32 = 65536;
/// What is below a coat gets what the coat's albedo leaves, as in OpenPBR. AREALIGHT_EFFECT_COAT is set then,
/// too.
pub const AREALIGHT_EFFECT_COAT_BY_ALBEDO: u32 = 131072;
/// Some diffuse lobe is rough: AREALIGHT_PLANE_ANISOTROPY is read.
pub const AREALIGHT_EFFECT_DIFFUSE_ROUGHNESS: u32 = 262144;
/// Some surface has sheen: AREALIGHT_PLANE_SHEEN is read.
pub const AREALIGHT_EFFECT_SHEEN: u32 = 524288;
/// Some surface's specular lobe has two roughnesses: AREALIGHT_PLANE_ANISOTROPY is read.
pub const AREALIGHT_EFFECT_ANISOTROPY: u32 = 1048576;
/// What specular lobes' facets reflect more than once is added, as in OpenPBR; else it is lost, as in glTF.
pub const AREALIGHT_EFFECT_MULTIPLE_SCATTERING: u32 = 2097152;
/// The pass is of light that thin surfaces let through: what the G-buffer holds is shaded from behind, for a
/// pass of its own whose base colour is the part of the light that is let through.
pub const AREALIGHT_EFFECT_TRANSMISSION: u32 = 4194304;
/// Some surface has a thin film that its reflectances lack: AREALIGHT_PLANE_FILM is read.
pub const AREALIGHT_EFFECT_THIN_FILM: u32 = 8388608;
/// Some thin surface is glass. A pass ignores it: give the pass with AREALIGHT_EFFECT_TRANSMISSION
/// AREALIGHT_EFFECT_GLOSSY, and put the part of its base colour that is not diffused into its metalness.
pub const AREALIGHT_EFFECT_GLASS: u32 = 16777216;
/// Some light has a profile.
pub const AREALIGHT_EFFECT_PROFILE: u32 = 33554432;
/// Some light is seen through an opening.
pub const AREALIGHT_EFFECT_OPENING: u32 = 67108864;
/// Lights shine on surfaces of some groups alone, ArealightLight.links: AREALIGHT_PLANE_STENCIL is read.
pub const AREALIGHT_EFFECT_LINKED: u32 = 134217728;
/// Some profile is not round about the normal.
pub const AREALIGHT_EFFECT_AZIMUTH: u32 = 268435456;
/// Polygons are clipped at the horizon of the lobe's cosine space.
pub const AREALIGHT_HORIZON_COSINE: u32 = 0;
/// And at the surface's horizon: nothing leaks from behind the surface.
pub const AREALIGHT_HORIZON_BOTH: u32 = 1;

/// One integral a light and specular lobe.
pub const AREALIGHT_SPECULAR_LOBES_ONE: u32 = 0;
/// Two, at .6 to .8 times the error, exact in the reflectance and its colour.
pub const AREALIGHT_SPECULAR_LOBES_TWO: u32 = 1;
/// GGX itself over half vectors, of polygons and meshes without an image: lobes of two roughnesses at a tenth
/// of two lobes' error.
pub const AREALIGHT_SPECULAR_LOBES_HALF_VECTORS: u32 = 2;

/// The glossy lobe is the table's.
pub const AREALIGHT_LOBES_TABLE: u32 = 0;
/// Formulas instead, without a texture, at 1.2 to 1.35 times the error.
pub const AREALIGHT_LOBES_FORMULA: u32 = 1;

/// A light's image is looked up with three fetches of what a lobe sees of it.
pub const AREALIGHT_FOOTPRINT_KERNEL: u32 = 0;
/// With one of its mips.
pub const AREALIGHT_FOOTPRINT_MIPS: u32 = 1;

/// Positions relative to the origin in xyz, 0 in w where there is no surface (rgba32f); or depth (d32f). As
/// the next ones, an index into ArealightResources.planes.
pub const AREALIGHT_PLANE_POSITION: u32 = 0;
/// Shading normal in xyz, of any length; perceptual roughness in w (rgba16f, rgba32f for mirrors). By
/// AREALIGHT_G_BUFFER_*, as the next two.
pub const AREALIGHT_PLANE_NORMAL: u32 = 1;
/// Linear base colour in rgb, metalness in a (rgba8).
pub const AREALIGHT_PLANE_BASE_COLOR: u32 = 2;
/// Dielectric F0 in rgb, F90 in a (rgba8). May be 0 without AREALIGHT_EFFECT_SPECULAR_INPUT, in a pass with
/// AREALIGHT_G_BUFFER_AREALIGHT.
pub const AREALIGHT_PLANE_SPECULAR: u32 = 3;
/// Of clear coats: weight in r, perceptual roughness in g (rg8), and with AREALIGHT_EFFECT_COAT_NORMAL the
/// coat's normal in ba, as its place in [-1, 1] x [-1, 1] on an unfolded octahedron (rgba16f). May be 0
/// without AREALIGHT_EFFECT_COAT.
pub const AREALIGHT_PLANE_COAT: u32 = 4;
/// Of sheen: linear colour in rgb, perceptual roughness in a (rgba8). May be 0 without
/// AREALIGHT_EFFECT_SHEEN.
pub const AREALIGHT_PLANE_SHEEN: u32 = 5;
/// Of lobes of two roughnesses: the tangent in rg, as its place in [-1, 1] x [-1, 1] on an unfolded
/// octahedron, perceptual roughness along it in b, 0 where there is one roughness; and the roughness of the
/// diffuse lobe in a (rgba16f). May be 0 without AREALIGHT_EFFECT_ANISOTROPY and _DIFFUSE_ROUGHNESS.
pub const AREALIGHT_PLANE_ANISOTROPY: u32 = 6;
/// Of thin films: how much of the surface one covers in r, its index of refraction in g, its thickness in
/// nanometres in b (rgba16f). May be 0 without AREALIGHT_EFFECT_THIN_FILM.
pub const AREALIGHT_PLANE_FILM: u32 = 7;
/// A stencil for each texel: the stencil aspect (s8_uint) or unsigned integers (r8_uint). May be 0 without
/// ArealightPassOptions.stencil and AREALIGHT_EFFECT_LINKED.
pub const AREALIGHT_PLANE_STENCIL: u32 = 8;
/// Where a pixel's point was in the frame before less where it is, in parts of the image's width and height
/// (rg16f). May be 0 but for a shadow pass with AREALIGHT_SHADOW_HISTORY_MOTION.
pub const AREALIGHT_PLANE_MOTION: u32 = 9;
/// How many planes there are.
pub const AREALIGHT_PLANE_COUNT: usize = 10;

/// AREALIGHT_PLANE_POSITION holds positions; w = 0 where there is no surface.
pub const AREALIGHT_POSITION_IMAGE: u32 = 0;
/// It holds depth as stored; exactly 0 or 1 where there is no surface.
pub const AREALIGHT_POSITION_DEPTH: u32 = 1;

/// ArealightFrame.camera is the camera's position.
pub const AREALIGHT_CAMERA_PERSPECTIVE: u32 = 0;
/// It is the direction to the camera, of any length but 0: an orthographic one.
pub const AREALIGHT_CAMERA_ORTHOGRAPHIC: u32 = 1;

/// Passes read resources by descriptor sets: arealight_pass_set_layout, arealight_pass_write_set,
/// arealight_pass_record.
pub const AREALIGHT_DESCRIPTORS_SETS: u32 = 0;
/// Likewise; the buffers of lights, vertices and shapes are VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, with
/// ArealightFrame.light_offsets, and their ArealightBuffer.range is given.
pub const AREALIGHT_DESCRIPTORS_LIGHT_OFFSETS: u32 = 1;
/// Without sets: arealight_pass_record_pushed. The device was made with VK_KHR_push_descriptor.
pub const AREALIGHT_DESCRIPTORS_PUSHED: u32 = 2;

/// What AREALIGHT_PLANE_NORMAL, _BASE_COLOR and _SPECULAR hold: normal and roughness; base colour and
/// metalness; dielectric F0 and F90.
pub const AREALIGHT_G_BUFFER_AREALIGHT: u32 = 0;
/// Unreal Engine's `GBufferA`, `GBufferC` and `GBufferB`, of its default shading model.
pub const AREALIGHT_G_BUFFER_UNREAL: u32 = 1;
/// `GBuffer2`, `GBuffer0` and `GBuffer1` of Unity's Universal Render Pipeline: metallic materials, no
/// accurate normals.
pub const AREALIGHT_G_BUFFER_UNITY: u32 = 2;
/// A signed place on an octahedron; base colour; occlusion (not used), roughness, metalness.
pub const AREALIGHT_G_BUFFER_OCTAHEDRAL: u32 = 3;

/// Radiance replaces what is in the image.
pub const AREALIGHT_OUTPUT_OVERWRITE: u32 = 0;
/// Radiance is added to it.
pub const AREALIGHT_OUTPUT_ADD: u32 = 1;

/// The radiance of both lobes goes to ArealightResources.radiance.
pub const AREALIGHT_IMAGES_COMBINED: u32 = 0;
/// That of the glossy lobe goes to ArealightResources.glossy instead.
pub const AREALIGHT_IMAGES_SEPARATE: u32 = 1;

/// Radiance is stored in 32-bit floats.
pub const AREALIGHT_RADIANCE_RGBA32F: u32 = 0;
/// In 16-bit floats, rounded to the nearest; what is above 65,504 as that.
pub const AREALIGHT_RADIANCE_RGBA16F: u32 = 1;

/// The mean of a pixel's shadow rays as it is: unbiased, with noise in penumbras.
pub const AREALIGHT_SHADOW_FILTER_OFF: u32 = 0;
/// A mean over neighbours in the same plane, as wide as a part of the penumbra.
pub const AREALIGHT_SHADOW_FILTER_GATHER: u32 = 1;

/// One frame's rays.
pub const AREALIGHT_SHADOW_HISTORY_OFF: u32 = 0;
/// Those of up to sixteen frames, found again by the camera's motion alone.
pub const AREALIGHT_SHADOW_HISTORY_CAMERA: u32 = 1;
/// Likewise, by motion vectors of the host's.
pub const AREALIGHT_SHADOW_HISTORY_MOTION: u32 = 2;

/// The table is kept in 32-bit floats, 16 bytes a texel.
pub const AREALIGHT_TABLE_RGBA32F: u32 = 0;
/// In 16-bit floats, 8 bytes a texel, at 5e-4 of a light more error.
pub const AREALIGHT_TABLE_RGBA16F: u32 = 1;

/// A flat polygon, convex or concave, without crossing edges; with holes, if it has any.
pub const AREALIGHT_LIGHT_POLYGON: u32 = 0;
/// Several flat faces.
pub const AREALIGHT_LIGHT_MESH: u32 = 1;
/// A flat disk or ellipse about `center` with the conjugate half axes `axis_u` and `axis_v`, which shines to
/// the side of their cross product.
pub const AREALIGHT_LIGHT_DISK: u32 = 2;
/// A sphere about `center`.
pub const AREALIGHT_LIGHT_SPHERE: u32 = 3;
/// A tube about `center`, whose axis goes from `center - axis_u` to `center + axis_u`.
pub const AREALIGHT_LIGHT_TUBE: u32 = 4;

/// The lateral surface of a tube alone shines.
pub const AREALIGHT_TUBE_OPEN: u32 = 0;
/// Flat caps shine too.
pub const AREALIGHT_TUBE_FLAT: u32 = 1;
/// Half spheres about both ends do: a capsule.
pub const AREALIGHT_TUBE_ROUND: u32 = 2;

/// Beyond the image is its edge.
pub const AREALIGHT_WRAP_CLAMP: u32 = 0;
/// The image again.
pub const AREALIGHT_WRAP_REPEAT: u32 = 1;
/// The image again, every other one mirrored.
pub const AREALIGHT_WRAP_MIRROR: u32 = 2;

/// The range of an ArealightBuffer from its offset to its end.
pub const AREALIGHT_WHOLE_SIZE: u64 = u64::MAX;

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::{Effects, Plane};

    #[test]
    fn constants_have_the_numbers_of_the_vocabulary() {
        let lines = || include_str!("constants.rs").lines();
        let effects =
            Effects::all().iter_names().map(|(name, effect)| ("EFFECT", name.into(), effect.bits()));
        let planes = Plane::ALL.map(|plane| ("PLANE", plane.name().to_uppercase(), plane as u32));
        for (kind, name, number) in effects.chain(planes) {
            let expected = format!("pub const AREALIGHT_{kind}_{name}: u32 = {number};");
            assert!(lines().any(|line| line == expected), "{expected}");
        }
        let effects = lines().filter(|line| line.starts_with("pub const AREALIGHT_EFFECT_")).count();
        assert_eq!((effects, AREALIGHT_PLANE_COUNT), (Effects::all().iter().count(), Plane::COUNT));
    }
}
