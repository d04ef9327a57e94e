"""Writes what Arealight reads with Blender's glTF exporter, once this add-on is enabled.

Where the exporter's "Punctual Lights" is ticked, area lamps become lights of EXT_lights_area, and points and spots keep their radius and
a spot its blend. Emissive meshes whose object has a custom
property `arealight` with the name of a shape (disk, sphere, cylinder, pipe, capsule) become that shape, about their Z axis.
"""

from . import lamps

NAME = "EXT_lights_area"


def register():
    pass


def unregister():
    pass


class glTF2ExportUserExtension:
    """What the exporter calls."""

    def __init__(self):
        from io_scene_gltf2.io.com import gltf2_io_extensions

        self.extensions = gltf2_io_extensions

    def gather_node_hook(self, node, blender_object, export_settings):
        if blender_object is None:
            return
        log = export_settings["log"]
        if blender_object.type == "LIGHT" and blender_object.data.type == "AREA":
            light = light_of(blender_object, log)
            if light is not None:
                child = self.extensions.ChildOfRootExtension(["lights"], NAME, light, required=False)
                if node.extensions is None:
                    node.extensions = {}
                node.extensions[NAME] = self.extensions.Extension(NAME, {"light": child}, required=False)
        elif blender_object.type == "LIGHT" and blender_object.data.type in ("POINT", "SPOT"):
            written = (node.extensions or {}).get("KHR_lights_punctual")
            if written is not None:
                said = lamps.round_light(blender_object.data.shadow_soft_size, *spot_of(blender_object.data))
                light = written.extension["light"].extension
                light["extras"] = {**(light.get("extras") or {}), "arealight": said}
        elif blender_object.type == "MESH" and isinstance(blender_object.get("arealight"), str):
            corners = [tuple(corner) for corner in blender_object.bound_box]
            low, high = (tuple(pick(axis) for axis in zip(*corners)) for pick in (min, max))
            said, problem = lamps.shape_light(blender_object["arealight"], low, high)
            if problem:
                log.warning(f"{blender_object.name}: arealight: {problem}: the mesh's own faces shine")
            node.extras = dict(node.extras or {})
            node.extras.pop("arealight", None)
            if said:
                node.extras["arealight"] = said


def spot_of(lamp):
    """A spot's angle and blend; none of a point."""
    return (lamp.spot_size, lamp.spot_blend) if lamp.type == "SPOT" else ()


def light_of(blender_object, log):
    """The light for an area lamp, or none where it gives no light."""
    lamp = blender_object.data
    color, strength = emission(lamp, blender_object.name, log)
    matrix = blender_object.matrix_world.to_3x3()
    axes = [matrix.col[axis].length for axis in range(3)]
    watts = lamp.energy * strength * 2.0 ** getattr(lamp, "exposure", 0.0)
    normalize = getattr(lamp, "normalize", True)
    return lamps.area_light(
        blender_object.name, lamp.shape, (lamp.size, lamp.size_y), axes, watts, color, normalize, lamp.spread
    )


def emission(lamp, name, log):
    """What the lamp's colour is, its temperature included, and what its power is multiplied by."""
    color, strength = list(lamp.color), 1.0
    if getattr(lamp, "use_temperature", False):
        color = [a * b for a, b in zip(color, lamp.temperature_color)]
    if lamp.use_nodes and lamp.node_tree:
        emitters = [node for node in lamp.node_tree.nodes if node.type == "EMISSION"]
        for emitter in emitters[:1]:
            if emitter.inputs["Color"].is_linked or emitter.inputs["Strength"].is_linked:
                log.warning(f"{name}: its emission is made by nodes: it is written with the values behind them")
            color = [a * b for a, b in zip(color, emitter.inputs["Color"].default_value)]
            strength = emitter.inputs["Strength"].default_value
    return color, strength
