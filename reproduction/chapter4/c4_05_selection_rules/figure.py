"""Ways to select among 68 policies: regret and entropy by episode, and when regret ends (Figure 4.10)."""

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import GREY, INK, LIGHT, VERMILION, Axes, Figure, house_style, new_figure
from reproduction.chapter4.reuse.looks import SOLID, draw_regret, lines_of, look_of
from reproduction.chapter4.surveillance.runs import DEFAULT_WORLD

PANELS = {"headline": "Learnt models, half the tasks unseen", "exact": "Exact models, at targets"}
FORMS = {False: "standard forms", True: "as printed, and κ 30"}


def draw(result: Mapping) -> Figure:
    rows, settings = result["rows"], result["settings"]
    default = [row for row in rows if "curve" in row]
    with house_style():
        figure = new_figure(11.6, 11.8)
        *tops, bottom = figure.subplots(3, 2, height_ratios=[1.1, 1.1, 1.2])
        for top, (case, words) in zip(tops, PANELS.items(), strict=True):
            for axes, (as_printed, forms) in zip(top, FORMS.items(), strict=True):
                own = [row for row in default if row["case"] == case]
                draw_regret(axes, [row for row in own if _is_other(row) == as_printed], f"{words}: {forms}")
            top[0].set_ylabel("expected regret")
        entropy = {row["method"]: {"mean": row["entropy"]} for row in default if row["case"] == "exact"}
        title = "Entropy of the belief, exact models (nats)"
        after, looks = range(settings["episodes"] + 1), lines_of(entropy, linewidth=1.5)
        draw_curves(bottom[0], after, entropy, looks=looks, title=title, xlabel="after episode", legend=False)
        bottom[0].set(xlim=(0, None), ylim=(0, None))
        bottom[0].grid(axis="y", color=LIGHT)
        _draw_grid(bottom[1], [row for row in rows if row["case"] == "exact"], list(entropy), settings["episodes"])
        shown = (axes.get_legend_handles_labels() for axes in tops[0])
        handles, labels = (list(chain(*both)) for both in zip(*shown, strict=True))
        figure.legend(handles, labels, loc="outside lower center", ncols=7)
        n = settings["tasks"] * settings["groups"]
        words = f"Surveillance, layout X, 68 types and policies, {n} tasks: mean regret, band 95 %"
        figure.suptitle(words, x=0.01, ha="left")
    return figure


def _is_other(row: Mapping) -> bool:
    """Whether a row's rule is a form as printed or with another κ."""
    return look_of(row["method"])[1] != SOLID


def _draw_grid(axes: Axes, rows: Sequence[Mapping], methods: Sequence[str], episodes: int) -> None:
    """A line a method: in each reserve the median episode after which regret ended, and the share stuck."""
    worlds = list(dict.fromkeys(tuple(row[key] for key in DEFAULT_WORLD) for row in rows))
    shifts = dict(zip(worlds, np.linspace(-0.28, 0.28, len(worlds)), strict=True))  # equal points stay apart
    right = episodes + 2.5
    for k, method in enumerate(methods):
        colour, own = look_of(method)[0], [row for row in rows if row["method"] == method]
        for row in own:
            world, ended = tuple(row[key] for key in DEFAULT_WORLD), row["ended_median"]["value"]
            if world == tuple(DEFAULT_WORLD.values()):
                axes.plot([ended], [k], "D", ms=6, color=colour, mec=INK, mew=0.8, zorder=4)
            else:
                axes.plot([ended], [k + shifts[world]], "o", ms=4, color=colour, mec="white", mew=0.4, zorder=3)
        stuck = np.mean([row["stuck"]["value"] for row in own])
        shade = VERMILION if stuck > 0.05 else GREY
        axes.text(right, k, f"{100 * stuck:.0f} %", va="center", fontsize=8, color=shade)
    axes.text(right, -1, "stuck", va="center", fontsize=8, color=GREY)
    axes.axvline(15, color=GREY, lw=0.8, ls=(0, (3, 2)))
    axes.set_yticks(range(len(methods)), methods)
    axes.set(
        title=f"Episode after which regret ended, in {len(worlds)} reserves",
        xlabel="median over tasks; diamond: layout X, Chebyshev, deviation 20",
        xlim=(0, episodes + 2),
        ylim=(len(methods) - 0.5, -1.5),
    )
    axes.grid(axis="x", color=LIGHT)
