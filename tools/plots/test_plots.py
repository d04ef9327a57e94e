"""Tests of the drawings: that they are those of the documents, and what they are drawn by."""

import re
import unittest

import numpy as np
from matplotlib.text import Text

import docs
import page
import plots


def words(svg):
    """What is written in a drawing, and how many shapes it has: no matter by which matplotlib."""
    return re.findall(r"<text[^>]*>([^<]*)<", svg), len(re.findall(r"<(?:path|use)", svg))


class Drawings(unittest.TestCase):
    def test_documents_have_them_as_they_are_drawn(self):
        for name, drawn in docs.drawings():
            stored = (docs.ROOT / "docs/images" / name).read_text()
            self.assertEqual(words(drawn), words(stored), f"{name}: tools/plots/docs.py docs/images")
            self.assertNotIn("nan", drawn)

    def test_rows_of_the_report_find_their_dots(self):
        report = (docs.ROOT / "docs/report-lavapipe.html").read_text()
        self.assertIn(page.SCRIPT, report)
        methods = set(re.findall("●</span> ([^<]*)</td>", report))
        for chart in ("False", "fit"):
            dots = {dot for dot in re.findall(f'id="dot:{chart}:([^"]*)"', report) if not dot.isdigit()}
            self.assertEqual(dots, methods, chart)

    def test_a_box_of_walls_sums_to_one(self):
        ground = np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]], float)
        top = ground + [0, 0, 1]
        walls = [np.array([here, there, there + [0, 0, 1], here + [0, 0, 1]])
                 for here, there in zip(ground, np.roll(ground, -1, axis=0))]
        total = docs.form_factor(top) + sum(docs.form_factor(wall) for wall in walls)
        self.assertAlmostEqual(total, 1, 12)
        # The twin: what is below the horizon adds nothing
        self.assertAlmostEqual(docs.form_factor(docs.WALL), docs.form_factor(docs.clipped(docs.WALL)), 12)
        self.assertTrue((docs.WALL[:, 2] < 0).any() and (docs.clipped(docs.WALL)[:, 2] > -1e-12).all())
        self.assertTrue((docs.LIGHT[:, 2] > 0).all())

    def test_names_do_not_cover_each_other(self):
        made, axes = plots.figure(400, 300)
        plots.scatter(axes, [(f"name {index}", 1 + 1e-3 * index, 0.1, plots.OURS) for index in range(4)])
        boxes = [Text.get_window_extent(text) for text in axes.texts]
        self.assertEqual(len(boxes), 4)
        self.assertFalse(any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i]))

    def test_numbers_have_three_digits(self):
        self.assertEqual([plots.number(value) for value in (0, 0.0123, 1.234, 9.996, 123.4, 2e7)],
                         ["0", "0.0123", "1.23", "10.0", "123", "2.0e+07"])


if __name__ == "__main__":
    unittest.main()
