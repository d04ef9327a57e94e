"""Prints what pictures of scenes differ from Cycles on a screen: python3 tools/blender/scenes.py AREALIGHT FOLDER [SCENE.glb ...].

Blender opens each scene (else five of this project's) with its own importer. A row has the levels of 255 between 4 x 4 blocks, by
the model of layers that Cycles has and by glTF's: with shadows, and with the reference in place of the product. Two pictures
by Cycles tell their noise, which is taken off; where FOLDER has them from before, they are not made again. `pip install bpy`
is all that it needs.
"""

import json
import subprocess
import sys
from pathlib import Path

import bpy
import truth

SCENES = Path(__file__).resolve().parents[2] / "scenes"
SIZE = (384, 216)
# The product by both models of layers, the same by the rays of its own reference
WAYS = {
    "albedo": ["--coupling", "albedo"],
    "gltf": ["--coupling", "gltf"],
    "reference": ["--coupling", "albedo", "--reference", "32"],
}


def said(*arguments):
    done = subprocess.run(list(map(str, arguments)) + ["--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def mend(material):
    """Gives a material what Blender's importer leaves out: emission on one side where the file is not doubleSided, and glTF's two
    widths of a brushed surface, along the texture's axes."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = nodes["Principled BSDF"].inputs
    if material.use_backface_culling:
        front, strength = nodes.new("ShaderNodeMath"), surface["Emission Strength"]
        front.operation = "MULTIPLY_ADD"
        front.inputs[1].default_value, front.inputs[2].default_value = -strength.default_value, strength.default_value
        links.new(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], front.inputs[0])
        links.new(front.outputs[0], strength)
    strength = surface["Anisotropic"].default_value
    if strength > 0.0:
        across = surface["Roughness"].default_value ** 2
        along = across + (1.0 - across) * strength**2
        # Blender's widths are width / aspect and width * aspect, where aspect^2 = 1 - .9 anisotropic
        surface["Roughness"].default_value = (along * across) ** 0.25
        surface["Anisotropic"].default_value = (1.0 - across / along) / 0.9
        axis = nodes.new("ShaderNodeTangent")
        axis.direction_type = "UV_MAP"
        links.new(axis.outputs[0], surface["Tangent"])


def row(arealight, folder, scene):
    name = scene.stem
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(scene))
    for material in bpy.data.materials:
        if material.node_tree and "Principled BSDF" in material.node_tree.nodes:
            mend(material)
    bpy.context.scene.camera = next(found for found in bpy.data.objects if found.type == "CAMERA")
    theirs = [folder / f"{name}-cycles{seed}.exr" for seed in (1, 2)]
    for seed, path in enumerate(theirs):
        if not path.exists():
            truth.render(path, SIZE, 1024 if name == "shop" else 256, seed)
    view = [arealight, "render", scene, "--size", f"{SIZE[0]}x{SIZE[1]}", "--exposure", "auto"]
    stops = said(*view, "-o", folder / f"{name}.png")["exposure"]
    cells = []
    for way, options in WAYS.items():
        ours = folder / f"{name}-{way}.exr"
        said(*view[:-1], stops, *options, "-o", ours)
        result = said(arealight, "compare", ours, *theirs, "--exposure", stops)
        cells += [f"{result['levels']:.1f}", f"{result['mean_ratio']:.3f}"]
    print(f"| `{scene.name}` | {' | '.join(cells)} |", flush=True)


def main():
    arealight, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    names = ("studio", "interior", "shop", "product", "neon")
    for scene in sys.argv[3:] or [SCENES / f"{name}.glb" for name in names]:
        row(arealight, folder, Path(scene))


main()
