"""The drawings of the documents: `tools/plots/docs.py docs/images`, where `cargo build -p arealight-python` was run."""

import importlib.machinery
import importlib.util
import json
import os
import pathlib
import sys

import numpy as np
from matplotlib.colors import to_rgba
from matplotlib.patches import Polygon

from plots import FAINT, INK, OURS, SOFT, THEIRS, error_cost, figure, svg

ROOT = pathlib.Path(__file__).resolve().parents[2]

# How far the viewer stands above the horizon, and about the normal from y towards x; radians
ELEVATION, AZIMUTH = 0.38, 0.35
RIGHT = np.array([-np.cos(AZIMUTH), np.sin(AZIMUTH), 0])
AWAY = np.array([np.sin(AZIMUTH), np.cos(AZIMUTH), 0])
UP = np.sin(ELEVATION) * AWAY + [0, 0, np.cos(ELEVATION)]

# Edge by edge: a quad light in the surface frame, the view on the other side, and a wall that crosses the horizon
LIGHT = np.array([-1.3, 0.1, 0.95]) + np.array([
    [-0.32, -0.47, -0.5], [-0.08, -0.53, 0.5], [0.32, 0.47, 0.5], [0.08, 0.53, -0.5]])
WALL = np.array([-0.85, -0.6, 0.12]) + np.array([
    [-0.36, 0.5, -0.55], [-0.36, 0.5, 0.55], [0.36, -0.5, 0.55], [0.36, -0.5, -0.55]])


def unit(points):
    """Directions of points."""
    return points / np.linalg.norm(points, axis=-1, keepdims=True)


def clipped(polygon):
    """The part of a polygon above the horizon."""
    kept = []
    for here, there in zip(polygon, np.roll(polygon, -1, axis=0)):
        if here[2] >= 0:
            kept.append(here)
        if (here[2] < 0) != (there[2] < 0):
            kept.append(here + (there - here) * here[2] / (here[2] - there[2]))
    return np.array(kept)


def form_factor(polygon):
    """The sum over the edges: each adds its angle along the vector across it."""
    ends = unit(clipped(polygon))
    total = 0.0
    for here, there in zip(ends, np.roll(ends, -1, axis=0)):
        across = np.cross(here, there)
        total += np.arccos(np.clip(here @ there, -1, 1)) * across[2] / np.linalg.norm(across)
    return abs(total) / (2 * np.pi)


def paper(width, height, columns=1, rows=1):
    """Panels without axes, as wide as high."""
    made, panels = figure(width, height, columns, rows, squeeze=False)
    for axes in panels.flat:
        axes.set_axis_off()
        axes.set_aspect("equal")
    return made, panels


def line(axes, points, colour, **options):
    """A line through points of the plane."""
    axes.plot(*np.transpose(points), color=colour, **options)


def area(axes, points, colour, alpha=0.22, **options):
    """An area within points, and its outline."""
    axes.add_patch(Polygon(points, facecolor=to_rgba(colour, alpha), edgecolor=colour, lw=2, **options))


def arrow(axes, start, end):
    """A straight line with a head."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1.5, "shrinkA": 0, "shrinkB": 0})


# Lobes in the plane of incidence: the distance from the point is the density, over the largest


def direction(angle):
    """A direction of the plane of incidence, by its angle from the normal towards the light's side."""
    return (-np.sin(angle), 0.0, np.cos(angle))


def lobe(axes, density, **options):
    """A lobe from horizon to horizon, over its largest value; the light's side is to the right."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, 97)
    values = np.array([density(direction(angle)) for angle in angles])
    curve = np.stack([np.sin(angles), np.cos(angles)], axis=1) * (values / values.max())[:, None]
    area(axes, curve, **{"colour": OURS, **options})


def cosine_to_lobe(arealight):
    """The clamped cosine, and what matrices of the table make of it beside the true lobes."""
    made, panels = paper(860, 200, columns=4)
    for axes, (roughness, degrees) in zip(panels.flat, [(0, 0), (0.8, 30), (0.5, 50), (0.35, 70)]):
        axes.set_xlim(-0.85, 1.05)
        axes.set_ylim(-0.04, 1.08)
        view = direction(-np.radians(degrees))
        at = arealight.Table().lookup(roughness, view[2]) if roughness else None
        line(axes, [(-0.85, 0), (0.85, 0)], SOFT, lw=1)
        line(axes, [(0, 0), (0, 1.06)], SOFT, lw=1, linestyle=":")
        # Directions of the cosine, evenly apart, and where the matrix takes them
        for step in range(-5, 6):
            to = np.array(direction(step * np.pi / 12))
            to = unit(np.linalg.solve(np.array(at.inverse), to)) if at else to
            line(axes, [(0, 0), (-to[0], to[2])], FAINT, lw=1)
        lobe(axes, at.density if at else lambda light: light[2])
        if at:
            lobe(axes, lambda light: arealight.ggx(roughness**2, view, light), colour=THEIRS, alpha=0, linestyle="--")
            arrow(axes, (-0.6 * view[0], 0.6 * view[2]), (-0.1 * view[0], 0.1 * view[2]))
        axes.set_title(f"roughness {roughness}, view {degrees}°" if at else "clamped cosine: one for all", y=-0.16)
    made.suptitle("filled: the cosine through M; dashed: GGX", x=0.99, ha="right", fontsize=12)
    return svg(made, "A clamped cosine, and three lobes made of it by matrices")


def table_axes(arealight):
    """What the table holds: a lobe for each roughness and view."""
    roughnesses, nodes = (0.15, 0.3, 0.45, 0.6, 0.8, 1.0), (0.95, 0.75, 0.5, 0.25, 0.0)
    made, axes = figure(860, 500)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.spines[:].set_visible(False)
    for row, node in enumerate(nodes):
        cosine = 1 - node * node
        angle = np.arccos(cosine)
        for column, roughness in enumerate(roughnesses):
            at = arealight.Table().lookup(roughness, cosine)
            cell = axes.inset_axes([2.2 * column, 1.35 * row, 2.2, 1.2], transform=axes.transData)
            cell.set_xlim(-1.1, 1.1)
            cell.set_ylim(-0.1, 1.1)
            cell.set_axis_off()
            line(cell, [(-1, 0), (1, 0)], SOFT, lw=1)
            lobe(cell, at.density)
            line(cell, [(0, 0), (-0.9 * np.sin(angle), 0.9 * np.cos(angle))], SOFT, lw=0.8)
    axes.set_xlim(0, 2.2 * len(roughnesses))
    axes.set_ylim(0, 1.35 * len(nodes))
    axes.set_xticks(1.1 + 2.2 * np.arange(len(roughnesses)), [f"{roughness:g}" for roughness in roughnesses])
    axes.set_yticks(0.4 + 1.35 * np.arange(len(nodes)),
                    [f"{node:g}\n{np.degrees(np.arccos(1 - node * node)):.0f}°" for node in nodes])
    axes.set_xlabel("roughness")
    axes.set_title("√(1 − cos θ) of the view, and θ", loc="left")
    return svg(made, "Lobes of the table by roughness and view")


# The hemisphere about a point, looked at from a little above


def flat(points):
    """Where points are in a drawing. The light's side (x negative) is to the right."""
    points = np.asarray(points)
    return np.stack([points @ RIGHT, points @ UP], axis=-1)


def dome(axes):
    """The horizon, the dome's outline and the normal."""
    turn = np.linspace(0, 2 * np.pi, 129)[:, None]
    horizon = flat(np.cos(turn) * [1, 0, 0] + np.sin(turn) * [0, 1, 0])
    axes.add_patch(Polygon(horizon, facecolor=to_rgba(SOFT, 0.1), edgecolor=SOFT))
    line(axes, flat(np.cos(turn[:65]) * RIGHT + np.sin(turn[:65]) * UP), SOFT, lw=1)
    arrow(axes, (0, 0), flat([0, 0, 1.18]))


def on_sphere(polygon):
    """A polygon's outline on the unit sphere: each edge an arc."""
    share = np.linspace(0, 1, 17)[:, None]
    return unit(np.concatenate([here + (there - here) * share
                                for here, there in zip(polygon, np.roll(polygon, -1, axis=0))]))


def light(axes, polygon, title, says):
    """A light, its outline on the sphere, and a caption."""
    dome(axes)
    for vertex in polygon:
        line(axes, flat([[0, 0, 0], vertex]), SOFT, lw=1, linestyle=":")
    for outline, colour, style in ((on_sphere(polygon), OURS, "-"), (polygon, THEIRS, "--")):
        area(axes, flat(outline), colour, linestyle=style)
    axes.set_xlim(-1.1, 2.1)
    axes.set_ylim(-1.4, 1.45)
    axes.text(0.5, -1.1, title, ha="center", fontsize=14, fontweight="bold")
    axes.text(0.5, -1.3, says, ha="center", color=SOFT)


def polygon_to_cosine_space(arealight):
    """A light above a glossy surface, and the same light in cosine space."""
    inverse = np.array(arealight.Table().lookup(0.5, np.cos(np.radians(50))).inverse)
    # The scale does not matter: one in which lights stay in the drawing
    moved = LIGHT @ (inverse * 0.75 / np.cbrt(abs(np.linalg.det(inverse)))).T
    made, panels = paper(860, 390, columns=2)
    light(panels[0, 0], LIGHT, "surface frame", "the lobe has no closed form over the outline")
    light(panels[0, 1], moved, "cosine space", f"the cosine has: form factor {form_factor(moved):.3f}")
    panels[0, 0].annotate("M⁻¹  →", (1.0, 0.62), xycoords="axes fraction", fontsize=16)
    return svg(made, "A quad light above a glossy surface, and in cosine space")


def clip(_):
    """A light that crosses the horizon of cosine space: what is below is cut off, along the horizon."""
    above = clipped(WALL)
    made, panels = paper(860, 390, columns=2)
    light(panels[0, 0], WALL, "crosses the horizon", "four edges; a part shines from below")
    light(panels[0, 1], above, "clipped", f"{len(above)} edges, one of them on the horizon: form factor {form_factor(WALL):.3f}")
    return svg(made, "A quad that crosses the horizon is clipped there")


def edge_integral(_):
    """An edge's arc on the sphere, its wedge, and the vector that it adds."""
    made, panels = paper(860, 330, columns=2)
    axes, words = panels[0]
    dome(axes)
    axes.set_xlim(-1.1, 1.15)
    axes.set_ylim(-0.45, 1.2)
    ends = unit(np.array([[-0.15, -0.75, 0.5], [-0.9, 0.05, 0.45]]))
    arc = unit(ends[0] + (ends[1] - ends[0]) * np.linspace(0, 1, 25)[:, None])
    axes.add_patch(Polygon(np.concatenate([[(0, 0)], flat(arc)]), facecolor=to_rgba(OURS, 0.22)))
    line(axes, flat(arc), OURS, lw=2)
    bold = {"ha": "center", "va": "center", "fontsize": 14, "fontweight": "bold"}
    for end, name in zip(ends, ("p₁", "p₂")):
        arrow(axes, (0, 0), flat(end))
        axes.text(*flat(1.12 * end), name, **bold)
    axes.text(*flat(0.22 * ends.sum(axis=0)), "θ", **bold)
    added = unit(np.cross(ends[1], ends[0]))
    tip = added * np.sign(added[2]) * np.arccos(ends[0] @ ends[1]) * 0.62
    arrow(axes, (0, 0), flat(tip))
    line(axes, flat([tip, [0, 0, tip[2]]]), SOFT, lw=1, linestyle=":")
    axes.text(*flat(1.14 * tip), "θ n", **bold)
    words.text(-0.1, 0.5, "p₁, p₂: the ends of an edge, of unit length\n\nθ: the angle between them: the arc's length\n\n"
               "n: the unit vector across both\n\nThe sum of θ n over all edges, over 2π, is the vector form factor.\n\n"
               "Its z is the form factor: the light that a Lambert surface gets.", va="center")
    words.set_aspect("auto")
    return svg(made, "An edge: its arc, and the vector that it adds")


def kernel(_):
    """What a place of a light's plane counts in cosine space, and the Gaussian of the same height."""
    made, (left, right) = figure(760, 300, columns=2)
    x = np.linspace(0, 4, 400)
    true, gaussian = 1 / (1 + x * x) ** 2, np.exp(-x * x)
    within = x * x / (1 + x * x), 1 - gaussian
    for axes, curves, says in ((left, (true, gaussian), "how much a place counts, the foot = 1"),
                               (right, within, "how much is within the distance")):
        for curve, colour, name in zip(curves, (OURS, THEIRS), ("K", "the Gaussian")):
            axes.plot(x, curve, color=colour, linewidth=1.8, label=name)
        axes.set_title(says, loc="left")
        axes.set_xlabel("distance from the foot, in heights")
        axes.set_xlim(0, 4)
        axes.set_ylim(0, 1.03)
    left.legend(frameon=False)
    return svg(made, "The kernel of a light's plane and the Gaussian of the same height")


DRAWINGS = (cosine_to_lobe, polygon_to_cosine_space, clip, edge_integral, table_axes, kernel)


def module():
    """The Python module, as it was built."""
    path = str(ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "debug/libarealight_python.so")
    loader = importlib.machinery.ExtensionFileLoader("arealight", path)
    built = importlib.util.module_from_spec(importlib.util.spec_from_loader("arealight", loader))
    loader.exec_module(built)
    return built


def drawings():
    """Every drawing's name and text."""
    arealight = module()
    for draw in DRAWINGS:
        yield draw.__name__.replace("_", "-") + ".svg", draw(arealight)
    found, compiled = (json.loads((ROOT / name).read_text()) for name in ("docs/results/nvidia-h200.json", "benches/data/compiled.json"))
    yield "error-cost.svg", error_cost(found, compiled)


def main():
    """Draws all."""
    if len(sys.argv) != 2:
        sys.exit("usage: docs.py FOLDER")
    for name, text in drawings():
        path = pathlib.Path(sys.argv[1], name)
        path.write_text(text)
        print(f"wrote {path}")


if __name__ == "__main__":
    main()
