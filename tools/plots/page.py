"""The page of `arealight bench`: one HTML file that needs nothing else; without its script it shows as much."""

import json
import re
from html import escape
from urllib.parse import quote

import plots
from plots import FAINT, GOOD, NOISE, OURS, THEIRS, figure, log_axis, number, percent, side, svg

STYLE = plots.style(":root") + """
:root { color-scheme: light dark; --card: color-mix(in srgb, var(--paper), var(--ink) 4%); }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 62rem; padding: 1.5rem 1rem 4rem; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; } h2 { font-size: 1.25rem; margin: 2.4rem 0 .3rem; }
.soft, figcaption, summary, th, .facts span { color: var(--soft); }
.facts, .pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: .7rem; }
.pictures { grid-template-columns: repeat(auto-fit, minmax(17rem, 1fr)); }
.facts div, figure { background: var(--card); border-radius: 8px; padding: .6rem .8rem; margin: 0; }
.facts b { display: block; font-size: 1.25rem; } .facts span, figcaption { font-size: .85rem; }
img, svg { width: 100%; height: auto; display: block; border-radius: 4px; margin-bottom: .3rem; }
/* What goes on to the right has a shadow there */
.table { --dark: color-mix(in srgb, var(--ink), transparent 70%); overflow-x: auto; background:
  linear-gradient(to left, var(--paper) 1.5rem, transparent) right / 3rem 100% no-repeat local,
  linear-gradient(to left, var(--dark), transparent) right / 1rem 100% no-repeat; }
.table svg { min-width: 40rem; } #patch_1 path, #patch_2 path { fill: none !important; }
th, .words td { cursor: pointer; } .hidden { opacity: .4; }
table { border-collapse: collapse; font-size: .86rem; }
th, td { padding: .3rem .6rem; text-align: right; border-bottom: 1px solid var(--faint); white-space: nowrap; }
th:first-child, td:first-child, .words td, .words th { text-align: left; } .words td:last-child { white-space: normal; }
.scale { display: flex; align-items: center; gap: .5rem; font-size: .8rem; }
.scale div { flex: 0 1 18rem; height: .8rem; }
"""


# A click on a head sorts by its column; a method's row shows its dots under the pointer, and hides them by a click
SCRIPT = """
const cell = (row, at) => row.cells[at]?.textContent.replace("●", "").trim() ?? "";
const dots = [...document.querySelectorAll("g[id^='dot:']")], hidden = new Set();
const method = (dot) => dot.id.split(":")[2];
const show = (one) => dots.forEach((dot) => {
  dot.style.opacity = hidden.has(method(dot)) ? 0 : one && one !== method(dot) ? 0.1 : 1;
});
document.addEventListener("click", ({ target }) => {
  const head = target.closest("th"), row = target.closest(".words tr"), name = row && cell(row, 0);
  if (head) {
    const rows = [...head.closest("tbody").rows].slice(1), at = head.cellIndex;
    const turn = head.dataset.turn = head.dataset.turn === "1" ? -1 : 1;
    const value = (one) => parseFloat(cell(one, at));
    const number = (one) => isNaN(value(one)) ? Infinity : value(one);
    const order = (a, b) => number(a) - number(b) || cell(a, at).localeCompare(cell(b, at));
    rows.sort((a, b) => turn * order(a, b)).forEach((one) => one.parentNode.append(one));
  } else if (dots.some((dot) => method(dot) === name)) {
    row.classList.toggle("hidden") ? hidden.add(name) : hidden.delete(name);
    show();
  }
});
document.addEventListener("mouseover", ({ target }) => {
  const row = target.closest("tr"), name = row && cell(row, 0);
  show(dots.some((dot) => method(dot) === name && !hidden.has(name)) && name);
});
"""


def chart(made, title):
    """A figure that is scrolled where the page is narrow."""
    return f'<div class="table">{svg(made, title, alone=False)}</div>'


def table(rows, kind=""):
    """Cells, the first row of heads."""
    html = "".join(
        "<tr>" + "".join(f"<{tag}>{cell}</{tag}>" for cell in row) + "</tr>"
        for row, tag in zip(rows, ["th"] + ["td"] * len(rows)))
    return f'<div class="table"><table class="{kind}">{html}</table></div>'


def numbers(markdown):
    """The sections of tables that the command writes as Markdown."""
    sections = re.split(r"^### ", markdown, flags=re.M)[1:]
    html = []
    for section in sections:
        title, *lines = section.splitlines()
        rows = [[escape(cell.strip()) for cell in line.strip("|").split("|")]
                for line in lines if line.startswith("|") and not line.startswith("|---")]
        html.append(f"<details{' open' if section is sections[0] else ''}><summary>{escape(title)}</summary>"
                    f"{table(rows)}</details>")
    return "".join(html)


def pareto(found, only_ours):
    """Error against time: everything, or our quality levels from nearer with their Pareto front."""
    rows = [row for row in plots.first_rows(found) if row["levels"] or not only_ours]
    dots = [(row["name"], row["time"]["milliseconds"]["median"], row["errors"]["all"]["rmse"], side(row)) for row in rows]
    named = None
    if not only_ours:
        samples = [(str(one["count"]), one["milliseconds"], one["errors"]["rmse"], NOISE) for one in found["monte_carlo"]]
        named = {row["name"] for row in rows if not row["levels"]} | {"exact", "finest"} | {dot[0] for dot in samples}
        dots += samples
    made, axes = figure(860, 480)
    axes.set_xlabel("ms per light per megapixel")
    axes.set_ylabel("error: RMSE over mean")
    key = [(OURS, "our quality levels"), (THEIRS, "yardsticks: what others ship"), (NOISE, "Monte Carlo, by samples")]
    plots.colour_key(axes, key[:1] if only_ours else key)
    front, best = [], float("inf")
    for _, x, y, colour in sorted(dots, key=lambda dot: dot[1]):
        # Differences below a hundredth are none
        if colour == OURS and y < 0.99 * best:
            front.append((x, y))
        best = min(best, y) if colour == OURS else best
    axes.plot(*zip(*front), color=OURS, linestyle=":", lw=1.5, alpha=0.6)
    plots.scatter(axes, dots, named)
    for line, dot in zip(axes.lines[1:], dots):
        line.set_gid(f"dot:{only_ours}:{dot[0]}")
    return chart(made, "Error against time")


def parts(found):
    """The parts of each method's error: a line a method, a dot a part."""
    rows = plots.first_rows(found)
    made, axes = figure(860, 90 + 24 * len(rows))
    log_axis(axes.xaxis, [max(row["errors"][part] or 0, 1e-7) for row in rows for part in ("fit", "integral")],
             plots.tick_percent)
    axes.set_yticks(range(len(rows)), [row["name"] for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    kinds = [(OURS, "fit"), (GOOD, "table"), (THEIRS, "integral")]
    plots.colour_key(axes, kinds)
    for place, row in enumerate(rows):
        for colour, part in kinds:
            if row["errors"][part] is not None:
                axes.plot(max(row["errors"][part], 1e-7), place, color=colour, gid=f"dot:{part}:{row['name']}", **plots.DOT)
    return chart(made, "Fit, table and integral error of every method")


def effects(found):
    """A bar for what each effect adds by being in the set, one for a frame of lights that need it."""
    bars = found["effects"]
    made, axes = figure(860, 80 + 34 * len(bars))
    axes.set_yticks(range(len(bars)), [one["effect"].replace("_", " ") for one in bars])
    axes.set_ylim(len(bars) - 0.4, -0.6)
    axes.set_xlabel("time added to the default level's")
    axes.xaxis.set_major_formatter(lambda value, _: f"{100 * value:+.0f} %")
    plots.colour_key(axes, [(OURS, "in the set (of a lobe: what it adds)"), (THEIRS, "lights that need it")])
    for place, one in enumerate(bars):
        for key, colour, offset in (("on", OURS, -0.19 if one["used"] else 0), ("used", THEIRS, 0.19)):
            if one[key]:
                added = one[key]["median"] - 1
                axes.barh(place + offset, max(added, 0), 0.34, color=colour)
                axes.plot([quartile - 1 for quartile in one[key]["quartiles"]], [place + offset] * 2, color=plots.INK, lw=1.5)
                axes.annotate(f"{100 * added:+.0f} %", (max(added, one[key]["quartiles"][1] - 1, 0), place + offset), (6, 0),
                              textcoords="offset points", va="center", fontsize=10)
    axes.margins(x=0.1)
    axes.axvline(0, color=FAINT)
    return chart(made, "What each effect adds to the time of the default level")


def pictures(found):
    """What methods make of a scene, each above its difference from the reference."""
    shown = found["pictures"]
    low, high = map(percent, shown["scale"])
    html = [f'<div class="scale"><span>{low}</span><div style="background:{shown["gradient"]}"></div>'
            f'<span>{high} of the mean, logarithmic</span></div><div class="pictures">'
            f'<figure><img alt="reference" src="{shown["reference"]}"><figcaption><b>reference</b><br>Monte Carlo, '
            f'{shown["samples"]} samples</figcaption></figure>']
    for one in shown["shown"]:
        name, (least, most) = escape(one["name"]), map(percent, one["error"]["range"])
        holes = f", {one['error']['not_finite']} pixels not finite" if one["error"]["not_finite"] else ""
        html.append(f'<figure><img alt="{name}" src="{one["image"]}"><img alt="difference of {name}" src="{one["map"]}">'
                    f'<figcaption><b>{name}</b><br>error {percent(one["error"]["rmse"])} ({least} to {most}){holes}, '
                    f'{number(one["milliseconds"])} ms</figcaption></figure>')
    return "".join(html) + "</div>"


def head(found, default, rows):
    """What it is, and the numbers that matter most."""
    error = default["errors"]["all"]["rmse"]
    facts = [(found["device"], "the device"), (percent(error), "error of our default level, RMSE over mean"),
             (f"{number(default['time']['ratio']['median'])} x",
              "time of our default level over clipless with our table; both read lights alike")]
    theirs = rows.get("clipless, published quality")
    if theirs:
        facts.insert(2, (percent(theirs["errors"]["all"]["rmse"]),
                         "error of clipless (three.js) with a table of published quality"))
    if default["samples"]:
        facts.append((f"{default['samples']['error']:.0f}", "samples of Monte Carlo for the same error"))
    facts = "".join(f"<div><b>{escape(value)}</b><span>{escape(label)}</span></div>" for value, label in facts)
    return (f"<h1>What accuracy costs in time</h1><p class=\"soft\">Area lights by linearly transformed cosines: our "
            f"quality levels and what others ship, on one device. Again: <code>{escape(found['command'])}</code> "
            f"({found['seconds']:.0f} s).</p><div class=\"facts\">{facts}</div>"
            f"<p class=\"soft\">{escape(found['legend'])}</p>")


def against(default, rows):
    """Our default level beside the yardsticks and Monte Carlo, in words."""
    error, time = default["errors"]["all"]["rmse"], default["time"]["ratio"]["median"]
    says = ["Lower is closer to the truth, further left is faster."]
    for name in ("clipless", "clipless, published quality", "clip by cases, published quality"):
        if name in rows:
            theirs = rows[name]
            says.append(f"Against <em>{name}</em> our default level errs {number(theirs['errors']['all']['rmse'] / error)} "
                        f"times less, in {number(time / theirs['time']['ratio']['median'])} times its time.")
    if default["samples"]:
        same = default["samples"]["time"]
        says.append(f"Monte Carlo needs about {number(default['samples']['error'])} samples for the same error; "
                    + (f"in the same time it takes {number(same)}." if same >= 1 else "one sample takes longer."))
    return " ".join(says)


def page(found):
    """The whole page."""
    rows = {row["name"]: row for row in plots.first_rows(found)}
    default = rows.get("exact") or next(iter(rows.values()))
    methods = [["method", "what it is"]] + [
        [f'<span style="color:{side(row)}">●</span> {escape(row["name"])}', escape(row["description"])]
        for row in rows.values()]
    sections = [
        ("What is compared", "Yardsticks are named by their school. They run in kernels of ours, on the same work: the same "
         "G-buffer, lights, lobes and table, so the form factor alone differs. Those of <em>published quality</em> look up a "
         "table with one matrix for every reflectance, whose errors are those of the table published with Heitz et al. 2016 "
         "within 10 %. The charts show a row's dots under the pointer; a click hides them.", table(methods, "words")),
        ("Error against time", against(default, rows),
         pareto(found, False) + "<p>Our quality levels from nearer; dotted: the Pareto front.</p>" + pareto(found, True)),
        ("Where the error comes from", "The shape of the fitted lobe is most of our error. A yardstick's integral error is "
         "what its horizon costs. With a table of published quality, fit and table are one part.", parts(found)),
        ("What an effect adds", "On a frame in which no light needs it, and on one of lights that do. What is not in the set "
         "costs nothing.", effects(found)),
    ]
    if found.get("pictures"):
        shown = found["pictures"]
        sections.append(
            ("What it looks like", f"The scene '{escape(shown['scene'])}' under {shown['lights']} lights, without shadows, as "
             f"in every method. Below each picture is its difference from the reference (Monte Carlo of {shown['samples']} "
             "samples a pixel, whose noise shows in it) over the reference's mean, without the lights themselves. The errors "
             "in the captions are free of that noise: the reference is two independent halves, and what these differ by is "
             "subtracted; in brackets is what stays uncertain, by 95 %. Yardsticks have a table of published quality.",
             pictures(found)))
    data = quote(json.dumps({key: value for key, value in found.items() if key not in ("markdown", "pictures")}))
    sections.append(("All numbers", f'<a download="bench.json" href="data:application/json,{data}">As JSON.</a> '
                     "A click on a head sorts. Milliseconds are for a light and a megapixel. Equal samples: those of Monte Carlo with "
                     f"the same error, and with the same time. Seed {found['seed']}.", numbers(found["markdown"])))
    body = head(found, default, rows) + "".join(f"<h2>{title}</h2><p>{says}</p>{html}" for title, says, html in sections)
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
            f'content="width=device-width, initial-scale=1"><title>What accuracy costs: {escape(found["device"])}</title>'
            f"<style>{STYLE}</style></head><body>{body}<script>{SCRIPT}</script></body></html>\n")
