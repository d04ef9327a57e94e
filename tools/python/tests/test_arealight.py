"""The module as a student uses it: against closed forms, itself, and wrong arguments."""

import math
import struct
import tempfile
import unittest
from pathlib import Path

import arealight
import numpy

VIEW = (0.6, 0.0, 0.8)


def square(height, half=1.0):
    """A square over the origin that shines down."""
    return [(-half, -half, height), (-half, half, height), (half, half, height), (half, -half, height)]


class Radiance(unittest.TestCase):
    def test_a_diffuse_surface_below_a_disk_has_a_closed_form(self):
        # The form factor of a disk above a point: r^2 / (r^2 + h^2)
        light = arealight.Light.disk((0, 0, 2), (0, 1, 0), (1, 0, 0), radiance=(1, 2, 3))
        material = arealight.Material((0.5, 0.5, 0.5), roughness=1.0, dielectric_f0=0.0)
        for found in (arealight.radiance(light, material, VIEW), arealight.truth(light, material, VIEW)[0]):
            # A specular lobe of F0 = 0 reflects what Schlick's term says
            specular = [value - radiance * 0.5 / 5 for value, radiance in zip(found, (1, 2, 3))]
            self.assertTrue(all(0 <= value < 0.02 * radiance for value, radiance in zip(specular, (1, 2, 3))), found)

    def test_the_table_is_near_the_truth(self):
        for light in (
            arealight.Light.polygon(square(2.0)),
            arealight.Light.sphere((0.5, 0, 1.5), 0.5),
            arealight.Light.tube((-1, 0, 1), (1, 0, 1), 0.1, ends="flat"),
        ):
            for roughness in (0.2, 0.5, 0.9):
                metal = arealight.Material((1, 1, 1), metalness=1.0, roughness=roughness)
                fitted = arealight.radiance(light, metal, VIEW)[0]
                (true, _, _), (error, _, _) = arealight.truth(light, metal, VIEW, tolerance=1e-5)
                self.assertLess(error, 1e-3 * true + 1e-9)
                self.assertLess(abs(fitted - true), 0.05 * true + 5e-3, (light, roughness))
        # The twin: another roughness is another radiance
        smooth = arealight.Material((1, 1, 1), metalness=1.0, roughness=0.2)
        light = arealight.Light.polygon(square(2.0))
        self.assertGreater(abs(arealight.radiance(light, smooth, VIEW)[0] - arealight.truth(light, metal, VIEW)[0][0]), 0.01)

    def test_a_light_is_seen_from_where_the_point_is(self):
        material = arealight.Material()
        moved = [(x + 5, y - 3, z + 1) for x, y, z in square(2.0)]
        here = arealight.radiance(arealight.Light.polygon(square(2.0)), material, VIEW)
        there = arealight.radiance(arealight.Light.polygon(moved), material, VIEW, position=(5, -3, 1))
        for a, b in zip(here, there):
            self.assertAlmostEqual(a, b, places=12)


    def test_a_function_has_a_truth(self):
        material = arealight.Material((1, 1, 1), metalness=1.0, roughness=0.6)
        for light in (arealight.Light.polygon(square(2.0), radiance=(1, 2, 3)), arealight.Light.sphere((0, 1, 1), 0.4)):
            known, _ = arealight.truth(light, material, VIEW)
            found, error = arealight.truth(light, lambda view, to: arealight.ggx(0.36, view, to), VIEW)
            for a, b in zip(known, found):
                self.assertAlmostEqual(a, b, delta=1e-5 * a)
            # The twin: another roughness
            other, _ = arealight.truth(light, lambda view, to: arealight.ggx(0.3, view, to), VIEW)
            self.assertGreater(abs(other[0] - known[0]), 0.01 * known[0])
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            arealight.truth(light, lambda view, to: 1 / 0, VIEW)
        with self.assertRaisesRegex(ValueError, "brdf: -1 for view"):
            arealight.truth(light, lambda view, to: -1.0, VIEW)

    def test_rows_of_points_are_answered_as_each(self):
        light, material = arealight.Light.polygon(square(2.0)), arealight.Material()
        places = [(0.1 * i, -0.05 * i, 0.0) for i in range(7)]
        for rows in (places, numpy.array(places), numpy.zeros((0, 3))):
            found = arealight.radiance(light, material, VIEW, position=rows)
            self.assertEqual(found.shape, (len(rows), 3))
            for place, one in zip(rows, found):
                self.assertEqual(list(one), list(arealight.radiance(light, material, VIEW, position=place)))
        values, errors = arealight.truth(light, material, [VIEW, (0, 0, 1)], tolerance=1e-4)
        self.assertEqual((values.shape, errors.shape), ((2, 3), (2, 3)))
        self.assertNotEqual(values[0, 0], values[1, 0])
        with self.assertRaisesRegex(ValueError, "view: 2 rows, where others have 7"):
            arealight.radiance(light, material, [VIEW, VIEW], position=places)


class Tables(unittest.TestCase):
    def test_a_lobe_integrates_to_one(self):
        lobe = arealight.Table().lookup(0.5, 0.8)
        steps, sum = 200, 0.0
        for i in range(steps):
            z = -1 + 2 * (i + 0.5) / steps
            for j in range(2 * steps):
                angle = math.pi * (j + 0.5) / steps
                radius = math.sqrt(1 - z * z)
                sum += lobe.density((radius * math.cos(angle), radius * math.sin(angle), z))
        self.assertAlmostEqual(sum * 4 * math.pi / (2 * steps * steps), 1.0, places=3)
        self.assertTrue(0 < lobe.schlick < lobe.albedo < 1)

    def test_what_is_saved_is_loaded(self):
        table = arealight.Table()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.exr"
            table.save(path)
            self.assertEqual(arealight.Table.load(path).texels(), table.texels())
        texels = struct.unpack(f"<{len(table.texels()) // 4}f", table.texels())
        self.assertEqual(len(texels) % (table.size**2 * 4), 0)
        self.assertTrue(all(map(math.isfinite, texels)))


class Fit(unittest.TestCase):
    def test_a_table_of_ggx_from_python_is_that_from_rust(self):
        steps = []
        table = arealight.fit(arealight.ggx, size=4, progress=lambda done, of: steps.append((done, of)))
        self.assertEqual((table.size, table.brdf), (4, "python"))
        self.assertEqual(steps[-1][0], steps[-1][1])
        # At a node both are fitted
        roughness = 2 / 3
        ours, theirs = table.lookup(roughness, 1.0), arealight.Table().lookup(roughness, 1.0)
        self.assertAlmostEqual(ours.albedo, theirs.albedo, places=3)
        self.assertAlmostEqual(ours.inverse[0][0] / theirs.inverse[0][0], 1.0, places=1)

    def test_what_a_brdf_raises_is_raised(self):
        def wrong(alpha, view, light):
            raise KeyError("no such material")

        with self.assertRaisesRegex(KeyError, "no such material"):
            arealight.fit(wrong, size=2)
        with self.assertRaisesRegex(ValueError, "brdf: -1 for alpha"):
            arealight.fit(lambda alpha, view, light: -1.0, size=2)
        with self.assertRaisesRegex(ValueError, "brdf: NaN for alpha"):
            arealight.fit(lambda alpha, view, light: math.nan, size=2)
        with self.assertRaises(ValueError):
            arealight.fit(arealight.ggx, size=1)


class Mistakes(unittest.TestCase):
    def test_what_is_wrong_is_named(self):
        light, material = arealight.Light.polygon(square(2.0)), arealight.Material()
        for name, call in {
            "view": lambda: arealight.radiance(light, material, (0, 0, 0)),
            "normal": lambda: arealight.radiance(light, material, VIEW, normal=(math.nan, 0, 1)),
            "position": lambda: arealight.truth(light, material, VIEW, position=(math.inf, 0, 0)),
            "tolerance": lambda: arealight.truth(light, material, VIEW, tolerance=0.0),
            "roughness": lambda: arealight.Material(roughness=1.5),
            "metalness": lambda: arealight.Material(metalness=math.nan),
            "vertices": lambda: arealight.Light.polygon([(0, 0, 1), (1, 0, 1)]),
            "radius": lambda: arealight.Light.sphere((0, 0, 0), -1.0),
            "ends": lambda: arealight.Light.tube((0, 0, 0), (1, 0, 0), 0.1, ends="sharp"),
            "radiance": lambda: arealight.Light.sphere((0, 0, 0), 1.0, radiance=(-1, 0, 0)),
            "cos_view": lambda: arealight.Table().lookup(0.5, -0.1),
            "alpha": lambda: arealight.ggx(0.0, VIEW, VIEW),
            "missing.exr": lambda: arealight.Table.load("missing.exr"),
        }.items():
            with self.assertRaisesRegex(ValueError, name):
                call()
        with self.assertRaises(OSError):
            arealight.Table().save("no/such/folder/table.exr")


if __name__ == "__main__":
    unittest.main()
