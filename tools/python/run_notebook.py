#!/usr/bin/env python3
"""Runs the cells of a notebook in order, without Jupyter, and keeps the pictures that they show.

    run_notebook.py NOTEBOOK            runs it; fails where a cell raises, or shows nothing of what it showed
    run_notebook.py NOTEBOOK --update   writes what its cells print and show into it

Needed are matplotlib and the module `arealight`.
"""

import argparse
import base64
import contextlib
import io
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def run(source, names):
    """What a cell prints, and its pictures as PNG."""
    printed, pictures = io.StringIO(), []

    def show():
        for number in plt.get_fignums():
            png = io.BytesIO()
            plt.figure(number).savefig(png, format="png", dpi=80, metadata={"Software": None})
            pictures.append(png.getvalue())
        plt.close("all")

    plt.show = show
    with contextlib.redirect_stdout(printed):
        exec(compile(source, "<cell>", "exec"), names)
    return printed.getvalue(), pictures


def outputs(printed, pictures):
    """As notebooks hold them."""
    texts = [{"output_type": "stream", "name": "stdout", "text": printed.splitlines(keepends=True)}] if printed else []
    shown = [
        {"output_type": "display_data", "data": {"image/png": base64.b64encode(png).decode()}, "metadata": {}}
        for png in pictures
    ]
    return texts + shown


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("notebook")
    parser.add_argument("--update", action="store_true", help="write what cells print and show")
    arguments = parser.parse_args()
    with open(arguments.notebook, encoding="utf-8") as file:
        notebook = json.load(file)
    names, count, ran = {"__name__": "__main__"}, 0, 0
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        ran += 1
        printed, pictures = run("".join(cell["source"]), names)
        if any(len(png) < 4000 for png in pictures):
            sys.exit(f"cell {ran} shows an empty picture")
        kinds = [output["output_type"] for output in outputs(printed, pictures)]
        if not arguments.update and kinds != [output["output_type"] for output in cell["outputs"]]:
            sys.exit(f"cell {ran} shows {kinds}; run again with --update")
        cell["execution_count"], cell["outputs"] = ran, outputs(printed, pictures)
        count += len(pictures)
    if arguments.update:
        with open(arguments.notebook, "w", encoding="utf-8") as file:
            json.dump(notebook, file, indent=1, ensure_ascii=False)
            file.write("\n")
    print(f"{arguments.notebook}: {ran} cells, {count} pictures: good")


if __name__ == "__main__":
    main()
