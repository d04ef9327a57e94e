"""Charts and pictures of what `arealight` finds, by matplotlib.

The program runs this file for `inspect -o`, `bench --html` and `--svg`. By itself it draws what a command saved:
`plots.py KIND found.json -o FILE`, where KIND is a name of `KINDS`.
"""

import base64
import io
import json
import re
import sys

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

# A colour's name, on light pages, on dark ones
COLOURS = {
    "ink": ("#1c2430", "#e6e9ee"),
    "soft": ("#5b6675", "#9aa5b4"),
    "faint": ("#d8dde4", "#333c48"),
    "paper": ("#fefefe", "#14181e"),
    "ours": ("#0b6bcb", "#5aa9f5"),
    "theirs": ("#c2410c", "#fb923c"),
    "noise": ("#7c3aed", "#b794f6"),
    "good": ("#15803d", "#4ade80"),
}
INK, SOFT, FAINT, PAPER, OURS, THEIRS, NOISE, GOOD = (light for light, _ in COLOURS.values())
DOT = {"marker": "o", "markersize": 8, "linestyle": "none", "markeredgewidth": 0}

matplotlib.rcParams.update({
    "font.size": 12, "figure.dpi": 72, "svg.fonttype": "none", "svg.hashsalt": "arealight",
    "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": FAINT, "axes.facecolor": "none",
    "xtick.color": SOFT, "ytick.color": SOFT, "xtick.major.size": 0, "ytick.major.size": 0,
    "axes.grid": True, "grid.color": FAINT, "axes.axisbelow": True, "figure.facecolor": PAPER,
    "axes.titlesize": 12, "legend.frameon": False, "axes.spines.top": False, "axes.spines.right": False,
})


def figure(width, height, columns=1, rows=1, **options):
    """A figure of a size in pixels, and its axes."""
    made = Figure(figsize=(width / 72, height / 72), layout="constrained")
    FigureCanvasAgg(made)
    return made, made.subplots(rows, columns, **options)


def style(selector="svg"):
    """The colours as CSS variables, for light and for dark pages."""
    light, dark = (";".join(f"--{name}:{pair[i]}" for name, pair in COLOURS.items()) for i in (0, 1))
    return f"{selector} {{{light}}} @media (prefers-color-scheme: dark) {{ {selector} {{{dark}}} }}"


def svg(made, title, alone=True):
    """The text of a figure as SVG: a file of its own, or a part of a page that has the colours."""
    out = io.StringIO()
    made.savefig(out, format="svg", metadata={"Date": None})
    text = re.sub(r"<metadata>.*?</metadata>", "", out.getvalue(), flags=re.S)
    text = re.sub(r'(width|height)="([0-9.]+)pt"', r'\1="\2"', text[text.index("<svg"):], count=2)
    text = text.replace("<svg", f'<svg role="img" aria-label="{title}"', 1)
    text = re.sub(r"\s*\n\s*", " ", text).rstrip() + "\n"
    # A hundredth of a pixel is enough
    text = re.sub(r'="[^"]*"', lambda value: re.sub(r"(\d\.\d\d)\d+", r"\1", value[0]), text)
    for name, (light, _) in COLOURS.items():
        text = text.replace(light, f"var(--{name})")
    return re.sub(r"(<style[^>]*>)", rf"\1{style()} ", text, count=1) if alone else text


def png(made):
    """The bytes of a figure as PNG."""
    out = io.BytesIO()
    made.savefig(out, format="png", dpi=72, metadata={"Software": None})
    return out.getvalue()


def number(value):
    """Three digits, and as few zeros as can be."""
    if value == 0:
        return "0"
    if abs(value) < 1e-3 or abs(value) >= 1e6:
        return f"{value:.1e}"
    exponent = int(f"{value:.2e}".split("e")[1])
    return f"{value:.{max(0, min(4, 2 - exponent))}f}"


def percent(value):
    """A share in percent."""
    return f"{value * 100:.0e} %" if 0 < abs(value) < 1e-5 else f"{number(value * 100)} %"


def tick_percent(value):
    """A share in percent, as a tick."""
    return f"{100 * value:.3g} %"


def short(value):
    """A tick."""
    return f"{value:g}" if 1e-3 <= abs(value) < 1e6 or value == 0 else f"{value:.0e}"


def log_axis(axis, values, name=short):
    """A logarithmic axis over values above zero, with a margin."""
    values = [value for value in values if value and np.isfinite(value) and value > 0] or [1, 10]
    low, high = np.log10(min(values)), np.log10(max(values))
    margin = 0.06 * max(high - low, 0.5)
    axis._set_axes_scale("log")
    steps = (1, 1.5, 2, 3, 4, 5, 7) if high - low < 0.8 else (1, 2, 5) if high - low < 2.5 else (1,)
    axis.set_major_locator(LogLocator(subs=steps, numticks=20))
    axis.set_major_formatter(FuncFormatter(lambda value, _: name(value)))
    axis.set_minor_locator(NullLocator())
    (axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim)(
        10 ** (low - margin), 10 ** (high + margin))


def place_labels(axes, dots, named=None):
    """Writes the names of dots (name, x, y, colour) where neither a dot nor another name is."""
    made = axes.figure
    made.canvas.draw()
    renderer, inside = made.canvas.get_renderer(), axes.get_window_extent()
    at = [axes.transData.transform(dot[1:3]) for dot in dots]
    taken = [matplotlib.transforms.Bbox.from_bounds(x - 5, y - 5, 10, 10) for x, y in at]
    places = [(9, 0), (-9, 0), (0, 12), (0, -12)]
    places += [(x, y) for y in (14, -14, 28, -28, 42, -42) for x in (10, -10)]
    for name, x, y, _ in dots:
        if named is not None and name not in named:
            continue
        for dx, dy in places:
            sides = {"ha": "left" if dx > 0 else "right" if dx else "center", "va": "center"}
            line = {"arrowstyle": "-", "color": SOFT, "lw": 0.6, "shrinkA": 0, "shrinkB": 4}
            text = axes.annotate(name, (x, y), (dx, dy), textcoords="offset points", **sides,
                                 arrowprops=line if dx and dy else None)
            text.update_positions(renderer)
            box = matplotlib.text.Text.get_window_extent(text, renderer)
            free = not any(box.overlaps(other) for other in taken)
            if free and inside.x0 <= box.x0 and box.x1 <= inside.x1 + 4 and box.y1 <= inside.y1 + 8:
                taken.append(box)
                break
            text.remove()


def scatter(axes, dots, named=None, x_name=short, y_name=tick_percent):
    """Dots (name, x, y, colour) with their names, both axes logarithmic."""
    log_axis(axes.xaxis, [dot[1] for dot in dots], x_name)
    log_axis(axes.yaxis, [dot[2] for dot in dots], y_name)
    for _, x, y, colour in dots:
        axes.plot(x, y, color=colour, **DOT)
    place_labels(axes, dots, named)


def colour_key(axes, entries):
    """Dots with what they stand for, above a chart."""
    dots = [matplotlib.lines.Line2D([], [], color=colour, **DOT) for colour, _ in entries]
    axes.legend(dots, [text for _, text in entries], loc="lower left", bbox_to_anchor=(0, 1.01), ncol=len(entries),
                handletextpad=0, columnspacing=1.2, borderaxespad=0)


# What benches find


def first_rows(found):
    """The rows of the first lights, which have every method."""
    return [row for row in found["rows"] if row["lights"] == found["workloads"][0][0]]


def side(row):
    """The colour of whose a method is."""
    return OURS if row["levels"] else THEIRS


def error_cost(found, compiled, family="navi21"):
    """Error over compiled cost to the left, over time on the bench's device to the right."""
    aliases = {"two lobes": "two specular lobes"}
    costs = {(row["kernel"], row["level"]): row.get("ratio")
             for kind in compiled["families"] if kind["family"] == family
             for row in kind["rows"] if row["lights"] == "quads"}
    by_compiler, by_clock = [], []
    for row in first_rows(found):
        method = row["name"].removesuffix(", published quality")
        name, error = method + "°" * (method != row["name"]), row["errors"]["all"]["rmse"]
        kernel = "shade" if row["levels"] else "shade_yardstick"
        cost = costs.get((kernel, aliases.get(method, method)))
        if cost is not None:
            by_compiler.append((name, cost, error, side(row)))
        by_clock.append((name, row["time"]["ratio"]["median"], error, side(row)))
    made, (left, right) = figure(960, 430, columns=2, sharey=True)
    left.set_xlabel(f"{family}: compiled cost, clipless = 1 (inverse throughput; no time)")
    left.set_ylabel("error: RMSE over the mean of the truth")
    right.set_xlabel(f"{found['device'].split(' (')[0]}{', on a CPU' * found['software']}: time, clipless = 1")
    colour_key(left, [(OURS, "Arealight's quality levels"), (THEIRS, "what engines ship; ° published quality")])
    scatter(left, by_compiler)
    scatter(right, by_clock)
    return svg(made, "Error against cost of our quality levels and of what engines ship")


HARD_METHODS = {
    "clip-and-acos": ("clip and arc cosines", GOOD), "clipless": ("clipless", SOFT),
    "sphere-horizon": ("clipped sphere", NOISE), "clip-by-cases": ("clip by cases", THEIRS),
    "polygon-exact": ("Arealight, exact", OURS),
}


def stability(found):
    """A line for each family of hard cases, a dot for each method; to the right what is NaN or infinite."""
    families = list(dict.fromkeys(row["family"] for row in found["rows"]))
    made, (axes, wrong) = figure(900, 110 + 18 * len(families), columns=2, sharey=True, width_ratios=(5, 1))
    log_axis(axes.xaxis, [1e-8, 1], short)
    wrong.set_xlim(-0.7, len(HARD_METHODS) - 0.3)
    wrong.set_xticks([])
    wrong.set_xlabel("NaN or infinite")
    axes.set_xlabel("largest backward error")
    axes.set_yticks(range(len(families)), families)
    axes.set_ylim(len(families) - 0.4, -0.6)
    axes.axvline(6e-7, color=OURS, linestyle=(0, (5, 4)))
    axes.annotate("promised: 6e-7", (6e-7, 0), (4, 4), xycoords=("data", "axes fraction"),
                  textcoords="offset points", color=SOFT)
    colour_key(axes, [(colour, name) for name, colour in HARD_METHODS.values()])
    for row in found["rows"]:
        tally = row["tally"]
        if row["method"] in HARD_METHODS and tally["samples"] > 0:
            place, error = families.index(row["family"]), tally["largest_backward_error"]
            colour = HARD_METHODS[row["method"]][1]
            if tally["not_finite"] > 0:
                wrong.plot(list(HARD_METHODS).index(row["method"]), place, color=colour, **DOT)
            elif error is not None:
                axes.plot(max(error, 1e-8), place, color=colour, **DOT)
    return svg(made, "The largest error of each family of hard cases, by method")


def growth(axes, lines, x_label, y_name=short, colours=(SOFT, OURS, THEIRS)):
    """Lines (name, [(x, y)]) with their names at the ends, both axes logarithmic."""
    lines = [(name, [step for step in steps if step[1] > 0]) for name, steps in lines]
    log_axis(axes.xaxis, [x for _, steps in lines for x, _ in steps])
    log_axis(axes.yaxis, [y for _, steps in lines for _, y in steps], y_name)
    axes.set_xlabel(x_label)
    lowest, ends = -np.inf, []
    for (name, steps), colour in zip(lines, colours):
        if steps:
            axes.plot(*zip(*steps), color=colour, marker="o", markersize=6, lw=2)
            ends.append((axes.transData.transform(steps[-1])[1], name, steps[-1]))
    for height, name, end in sorted(ends):
        lowest = max(height, lowest + 14)
        axes.annotate(name, end, (10, lowest - height), textcoords="offset points", va="center", annotation_clip=False)


def lights(found):
    """Time and error over the number of lamps."""
    ways = list(dict.fromkeys(row["way"] for row in found["rows"]))
    made, (left, right) = figure(960, 380, columns=2)

    def lines(key):
        return [(way, [(row["lamps"], row[key]) for row in found["rows"] if row["way"] == way]) for way in ways]
    growth(left, lines("milliseconds"), f"milliseconds on {found['device'].split(' (')[0]}, over lamps")
    growth(right, lines("rmse"), "difference from all lights, RMSE over mean, over lamps", tick_percent)
    return svg(made, "Time and error over the number of lights, with all of them and by tiles")


# What `inspect` finds


def floats(text, *shape):
    """Numbers that the program handed over."""
    return np.frombuffer(base64.b64decode(text), dtype="<f4").reshape(shape)


DIFFERENCES = LinearSegmentedColormap.from_list(
    "differences", ["#2166ac", "#67a9cf", "#d1e5f0", "#f7f7f7", "#fddbc7", "#ef8a62", "#b2182b"])


def plain(text):
    """A text as it is: foreign names hold no formulas."""
    return text.replace("$", r"\$")


def entitle(made, title):
    made.suptitle(plain(title), x=0.01, ha="left", fontsize=13)


def lobes(found):
    """Fitted lobes beside true ones on the hemisphere from above, as figure 8 of Heitz et al. 2016."""
    columns, rows, pixels = len(found["roughness"]), len(found["view"]), found["pixels"]
    made, cells = figure(1480, 110 + 124 * rows, columns=3 * columns, rows=rows)
    made.get_layout_engine().set(rect=(0, 0.08, 1, 0.92))
    entitle(made, found["title"])
    for row, axes_of_row in enumerate(cells):
        for column in range(columns):
            cell = found["cells"][row * columns + column]
            true, fitted = (floats(cell[key], pixels, pixels) for key in ("true", "fitted"))
            peak = true.max()
            pictures = [(true, "true"), (fitted, "fitted"), ((fitted - true) / peak, "error")]
            for axes, (picture, name) in zip(axes_of_row[3 * column:3 * column + 3], pictures):
                if name == "error":
                    error = axes.imshow(picture, cmap=DIFFERENCES, vmin=-0.25, vmax=0.25)
                else:
                    # The square root shows the tails
                    image = axes.imshow(np.sqrt(np.maximum(picture / peak, 0)), cmap="viridis", vmin=0, vmax=1)
                axes.set_axis_off()
                rim = axes.add_patch(matplotlib.patches.Circle([pixels / 2 - 0.5] * 2, pixels / 2 - 0.5, fill=False, ec=SOFT, lw=0.6))
                axes.images[0].set_clip_path(rim)
                if row == 0:
                    head = f"roughness {found['roughness'][column]:g}\n" if name == "fitted" else "\n"
                    axes.set_title(head + name)
        axes_of_row[0].text(-0.12, 0.5, f"view\n{found['view'][row]:g}°", transform=axes_of_row[0].transAxes,
                            ha="right", va="center")
    for left, scale, ticks, labels in ((0.04, image, [0, 0.5, 1], ["0", "a quarter of the peak", "peak"]),
                                       (0.3, error, [-0.25, 0, 0.25], ["-25 %", "0", "+25 % of the peak"])):
        bar = made.colorbar(scale, cax=made.add_axes([left, 0.05, 0.2, 0.015]), orientation="horizontal")
        bar.set_ticks(ticks, labels=labels)
    made.text(0.55, 0.035, "The hemisphere from above, in equal areas; the view lies on the left of each disc.", color=SOFT)
    return png(made)


def table_axes(axes, title, view=True):
    """Roughness to the right, the view's angle upwards."""
    axes.set_title(plain(title), loc="left")
    axes.grid(False)
    axes.set_xlabel("roughness")
    if view:
        axes.set_ylabel("view angle")


def errors(found):
    """Error maps, a column a subject, a row a reflectance; one scale of colours for all."""
    size, maps = found["cells_a_side"], found["maps"]
    columns = -(-len(maps) // 2)
    made, cells = figure(320 * max(columns, 3), 760, columns=max(columns, 3), rows=2)
    entitle(made, found["title"])
    image = None
    for index, axes in enumerate(cells.T.flat):
        if index >= len(maps):
            axes.set_axis_off()
            continue
        one = maps[index]
        name = one["of"] if len(one["of"]) <= 16 else one["of"][:15] + "…"
        note = f"{name}, {one['specular_lobes']}, F0 = {one['f0']:g}\nmean {one['mean']:.1e}, most {one['most']:.1e}"
        table_axes(axes, note, index < 2)
        image = axes.imshow(floats(one["cells"], size, size), origin="lower", aspect="auto", cmap="viridis",
                            norm=LogNorm(1e-5, 1e-1), extent=(*found["roughness"], *found["view"]))
        axes.yaxis.set_major_formatter("{x:.0f}°")
    made.colorbar(image, ax=cells, location="bottom", shrink=0.5, aspect=50, label=found["note"])
    return png(made)


def entries(found):
    """The numbers that a table holds: how smooth they are, for between nodes they are interpolated."""
    size, channels = found["size"], found["channels"]
    made, cells = figure(1400, 60 + 330 * -(-len(channels) // 4), columns=4, rows=-(-len(channels) // 4))
    entitle(made, found["title"])
    views = np.arange(0, 91, 15)
    for axes, channel in zip(cells.flat, channels):
        table_axes(axes, f"{channel['layer']} {channel['channel']}\nlargest step {channel['step']:.3f}",
                   axes in cells[:, 0])
        image = axes.imshow(floats(channel["values"], size, size), origin="lower", cmap="viridis",
                            extent=(0, 1, 0, 1), aspect="auto")
        # Nodes are even in the square root of 1 - cos
        axes.set_yticks(np.sqrt(1 - np.cos(np.radians(views))), [f"{view}°" for view in views])
        made.colorbar(image, ax=axes, aspect=30)
    for axes in cells.flat[len(channels):]:
        axes.set_axis_off()
    if len(channels) % 4:
        cells.flat[len(channels)].text(
            0, 1, "the inverse matrix of a lobe in the mirror frame:\n\n"
            "        q00   0   q02\n         0    1    0\n  alpha (q20   0   q22)\n\n"
            "albedo: the integral of f cos\nschlick: that times Schlick's weight\n\n"
            "A step is between neighbouring nodes.", va="top", color=SOFT)
    return png(made)


def pyramid(found):
    """A light's image and the finer levels of what is seen of it, at one size, in order."""
    levels = found["levels"][:9]
    rows = -(-len(levels) // 3)
    height = int(320 * found["size"][1] / found["size"][0]) + 50
    made, cells = figure(1050, 60 + rows * height, columns=3, rows=rows, squeeze=False)
    entitle(made, found["title"])
    for index, axes in enumerate(cells.flat):
        axes.set_axis_off()
        if index < len(levels):
            level = levels[index]
            width, height = level["size"]
            pixels = np.frombuffer(base64.b64decode(level["srgb"]), np.uint8).reshape(height, width, 3)
            axes.imshow(pixels, interpolation="antialiased" if index == 0 else "nearest")
            title = f"level {index - 1}: {width} x {height}\nseen from {level['height']:.2f}" if index \
                else f"the image: {width} x {height}\n"
            axes.set_title(title, loc="left")
    return png(made)


def report(found):
    """The page of `arealight bench`."""
    import page
    return page.page(found)


def drawn_by_name(kind):
    """What draws a kind."""
    return globals()[kind]


KINDS = ("stability", "lights", "lobes", "errors", "entries", "pyramid", "report")


def main():
    """Draws what the command line names."""
    if len(sys.argv) != 5 or sys.argv[1] not in KINDS or sys.argv[3] != "-o":
        sys.exit(f"usage: plots.py {'|'.join(KINDS)} FOUND.json -o FILE")
    with open(sys.argv[2]) as file:
        drawn = drawn_by_name(sys.argv[1])(json.load(file))
    with open(sys.argv[4], "wb") as file:
        file.write(drawn if isinstance(drawn, bytes) else drawn.encode())


if __name__ == "__main__":
    main()
