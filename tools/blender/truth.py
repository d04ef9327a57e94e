"""Renders a scene by Blender's Cycles, direct light alone, as the tests and the table of scenes compare with."""

import bpy


def render(path, size, samples, seed=0):
    """Writes radiance to `path`, an EXR, with so many samples a pixel."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = samples, False, 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.seed, scene.cycles.sample_clamp_direct = seed, 0.0
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
