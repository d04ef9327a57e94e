"""Tests what needs no Blender: python3 tools/blender/test_lamps.py."""

import importlib.util
import math
import unittest
from pathlib import Path

spec = importlib.util.spec_from_file_location("lamps", Path(__file__).parent / "arealight_lights/lamps.py")
lamps = importlib.util.module_from_spec(spec)
spec.loader.exec_module(lamps)


class Lamps(unittest.TestCase):
    def light(self, shape, size=(2.0, 1.0), axes=(1.0, 1.0, 1.0), **options):
        return lamps.area_light("lamp", shape, size, axes, 100.0, (1.0, 0.5, 0.0), **options)

    def flux(self, light, shape, scale=1.0):
        """Of the strongest channel, from what the file says."""
        extras = light.get("extras", {}).get("arealight", {})
        aspect = light["rect"]["aspect"] if "rect" in light else extras.get("aspect", 1.0)
        height = light["size"] * scale
        return math.pi * light["intensity"] / 683.0 * lamps.area(shape, aspect * height, height)

    def test_lamps_shine_with_their_power(self):
        for shape in ("RECTANGLE", "SQUARE", "DISK", "ELLIPSE"):
            light = self.light(shape)
            self.assertAlmostEqual(self.flux(light, shape), 100.0)
            self.assertEqual(light["color"], [1.0, 0.5, 0.0])
            self.assertEqual(light["type"], "disk" if shape in ("DISK", "ELLIPSE") else "rect")
            # Twin: the box of an ellipse is no ellipse
            self.assertNotAlmostEqual(self.flux(light, "DISK"), self.flux(light, "SQUARE"))

    def test_scales_are_in_the_size(self):
        light = self.light("RECTANGLE", axes=(3.0, 0.5, 1.0))
        # 6 wide and 0.5 high; a reader multiplies by 3
        self.assertAlmostEqual(light["size"] * 3.0, 0.5)
        self.assertAlmostEqual(light["rect"]["aspect"], 12.0)
        self.assertAlmostEqual(self.flux(light, "RECTANGLE", 3.0), 100.0)
        # A disk under such a scale is an ellipse
        self.assertAlmostEqual(self.light("DISK", axes=(3.0, 0.5, 1.0))["extras"]["arealight"]["aspect"], 6.0)
        self.assertNotIn("extras", self.light("DISK"))

    def test_lamps_that_are_not_normalized_shine_by_area(self):
        self.assertAlmostEqual(self.flux(self.light("RECTANGLE", normalize=False), "RECTANGLE"), 200.0)

    def test_spots_are_disks_of_their_intensity(self):
        said = lamps.round_light(0.2, math.radians(60.0), 0.5)
        self.assertEqual(said["radius"], 0.2)
        # Full on its axis, half in the middle of the blend of the cosine, and nothing at its edge
        self.assertEqual(said["profile"][0], [0.0, 1.0])
        middle = math.acos(math.cos(math.radians(30.0)) + 0.25 * (1.0 - math.cos(math.radians(30.0))))
        below = max(row for row in said["profile"] if row[0] <= math.degrees(middle))
        self.assertAlmostEqual(below[1] * math.cos(math.radians(below[0])), 0.5, delta=0.05)
        self.assertEqual([round(x, 9) for x in said["profile"][-1]], [30.0, 0.0])
        hard = lamps.round_light(0.2, math.radians(60.0), 0.0)["profile"]
        self.assertAlmostEqual(hard[-2][1] * math.cos(math.radians(hard[-2][0])), 1.0, delta=0.05)
        self.assertEqual(lamps.round_light(0.0), {"radius": 1e-3})

    def test_nothing_is_no_light(self):
        self.assertIsNone(self.light("RECTANGLE", size=(0.0, 1.0)))
        self.assertIsNone(lamps.area_light("dark", "DISK", (1, 1), (1, 1, 1), 0.0, (1, 1, 1)))
        self.assertIsNone(lamps.area_light("black", "DISK", (1, 1), (1, 1, 1), 1.0, (0, 0, 0)))

    def test_meshes_stand_for_shapes(self):
        box = ((-0.5, -0.5, -2.0), (0.5, 0.5, 2.0))
        self.assertEqual(lamps.shape_light("cylinder", *box)[0], {"shape": "cylinder", "radius": 0.5, "height": 4.0})
        self.assertEqual(lamps.shape_light("capsule", *box)[0], {"shape": "capsule", "radius": 0.5, "height": 3.0})
        for shape, low, high, word in [
            ("cone", *box, "none of"),
            ("sphere", (0, 0, 0), (1, 1, 1), "origin"),
            ("cylinder", (-1, -0.5, -1), (1, 0.5, 1), "round"),
            ("capsule", (-1, -1, -0.5), (1, 1, 0.5), "straight"),
        ]:
            said, problem = lamps.shape_light(shape, low, high)
            self.assertIsNone(said)
            self.assertIn(word, problem)


unittest.main()
