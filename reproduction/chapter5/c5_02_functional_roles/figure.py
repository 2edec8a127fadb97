"""Mean average precision of each role by method, with pictures of a few scenes."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import INK, LIGHT
from reproduction.chapter2.scenes.scene_example import examples_of
from reproduction.chapter5.c5_02_functional_roles.run import METHODS
from reproduction.figures.gallery import gallery_above
from reproduction.figures.palettes import METHOD_COLOURS


def draw(result: Mapping):
    table = [row for row in result["rows"] if "role" in row]
    colours = dict(zip(METHODS, METHOD_COLOURS, strict=False))
    figure, below = gallery_above(examples_of(result), 3.0, layers=("cloud", "networks"))
    axes = below.subplots()
    for (method, name), shift in zip(METHODS.items(), np.linspace(-0.3, 0.3, len(METHODS)), strict=True):
        places = shift + np.arange(1, len(table) + 1)
        axes.plot(places, [row[method] for row in table], "o", ms=4.5, color=colours[method], mew=0)
        overall = result["measured"][f"map_{method}"]
        axes.plot([shift], [overall["value"]], "s", ms=6.5, color=colours[method], mew=0, label=name)
        if overall["ci95"]:
            axes.plot([shift, shift], overall["ci95"], color=colours[method], lw=1.6)
    for place in range(len(table)):
        axes.axvline(place + 0.5, color=LIGHT if place else INK, lw=0.7)
    labels = [f"{row['role']}\n{row['queries']}" for row in table]
    axes.set_xticks(range(len(table) + 1), ["all", *labels], fontsize=7.5)
    axes.set(ylim=(0, 1.03), xlim=(-0.5, len(table) + 0.5), ylabel="mean average precision")
    axes.tick_params(axis="x", length=0)
    axes.grid(axis="y")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(METHODS), handletextpad=0.2)
    return figure
