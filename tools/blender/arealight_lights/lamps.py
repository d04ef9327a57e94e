"""What a lamp of Blender is in glTF: numbers in, dictionaries out, without Blender."""

import math

# Radiance in W/(m² sr) to nits, as EXT_lights_area has it.
LUMENS_PER_WATT = 683.0

# Shapes that a mesh can stand for, and whether each has a height.
SHAPES = {"disk": False, "sphere": False, "cylinder": True, "pipe": True, "capsule": True}


def area(shape, width, height):
    """The area of a lamp, from the width and height of the box around it."""
    part = math.pi / 4.0 if shape in ("DISK", "ELLIPSE") else 1.0
    return part * width * height


def area_light(name, shape, size, axes, watts, color, normalize=True, spread=math.pi):
    """The light of EXT_lights_area for an area lamp.

    `shape` is Blender's name for it, `size` the lamp's own width and height, `axes` the lengths of its node's three axes in the world.
    `spread` is the angle that Cycles lets its light through in, radians; EXT_lights_area has none: other readers show all of its front.
    `watts` is its power, or, where it is not normalized, its power for each square metre; `color` is linear and multiplies it.
    """
    width, height = size[0] * axes[0], (size[0] if shape in ("SQUARE", "DISK") else size[1]) * axes[1]
    strongest = max(*color, 0.0)
    if not (width > 0.0 and height > 0.0 and watts * strongest > 0.0):
        return None
    radiance = watts / (math.pi * (area(shape, width, height) if normalize else 1.0))
    light = {
        "name": name,
        "color": [channel / strongest for channel in color],
        "intensity": radiance * strongest * LUMENS_PER_WATT,
        # A reader multiplies the size by the largest of the node's scales
        "size": height / max(axes),
    }
    aspect = width / height
    if shape in ("DISK", "ELLIPSE"):
        light["type"] = "disk"
        if abs(aspect - 1.0) > 1e-6:
            # EXT_lights_area has no ellipse: other readers show a disk
            light["extras"] = {"arealight": {"aspect": aspect}}
    else:
        light["type"] = "rect"
        light["rect"] = {"aspect": aspect}
    if spread < math.pi - 1e-3:
        light.setdefault("extras", {}).setdefault("arealight", {})["spread"] = spread
    return light


def round_light(radius, angle=None, blend=0.0):
    """`extras.arealight` of a point of a radius, or of a spot of an angle, radians, and a blend as Cycles has it.

    A spot is a disk here: by rows of degrees and factors its intensity is what Cycles has, a smooth step of the cosine.
    """
    # A lamp without a radius is a point to Cycles too: as small as casts no soft shadow
    said = {"radius": max(radius, 1e-3)}
    if angle is not None:
        half = min(0.5 * angle, math.radians(89.0))
        end = math.cos(half)
        width = (1.0 - end) * max(blend, 1e-3)

        def factor(turn):
            step = min(max((math.cos(turn) - end) / width, 0.0), 1.0)
            return step * step * (3.0 - 2.0 * step) / math.cos(turn)

        turns = [half * index / 90.0 for index in range(91)]
        # Where a hard edge is, between the last two
        turns[-1:] = [math.acos(end + width), half] if blend < 0.01 else [half]
        said["profile"] = [[math.degrees(turn), factor(turn)] for turn in turns]
    return said


def shape_light(shape, low, high):
    """`extras.arealight` for a mesh that stands for `shape`, from the corners of its box in its own space, along Blender's axes; or the
    reason why there is none."""
    if shape not in SHAPES:
        return None, f"'{shape}' is none of {', '.join(SHAPES)}"
    size = [b - a for a, b in zip(low, high)]
    longest = max(size)
    if any(abs(a + b) > 1e-3 * longest for a, b in zip(low, high)):
        return None, "its origin is not in its middle"
    # A mesh of few faces is a little narrower along one axis than along the other
    if abs(size[0] - size[1]) > 0.05 * longest:
        return None, "it is not round about its Z axis"
    radius = 0.5 * max(size[0], size[1])
    said = {"shape": shape, "radius": radius}
    if SHAPES[shape]:
        height = size[2] - (2.0 * radius if shape == "capsule" else 0.0)
        if height <= 0.0:
            return None, "it has no straight part along its Z axis"
        said["height"] = height
    return said, None
