"""Ways to select among 68 policies: regret and entropy by episode, and when regret ends (C4.5; Figure 4.10)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter4.reuse_palette import look_of
from lifelore.figures.style import GREY, INK, LIGHT, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DEFAULT = {"layout": "X", "metric": "chebyshev", "noise": "deviation 20"}
_PANELS = {
    "headline": "Learnt models, half the tasks unseen",
    "exact": "Exact models, at targets",
}


def draw_selection_curves(result: Mapping) -> "Figure":
    """From C4.5's result: regret by episode, entropy, stuck tasks, and medians over the grid of reserves."""
    rows, settings = result["rows"], result["settings"]
    default = [row for row in rows if "curve" in row]
    methods = list(dict.fromkeys(row["method"] for row in default))
    with house_style():
        figure = new_figure(11.6, 8.6)
        top, bottom = figure.subplots(2, 2, height_ratios=[1.1, 1])
        for axes, (case, words) in zip(top, _PANELS.items(), strict=True):
            draw_regret(axes, [row for row in default if row["case"] == case])
            axes.set_title(words)
        top[0].set_ylabel("expected regret")
        _draw_entropy(bottom[0], [row for row in default if row["case"] == "exact"])
        _draw_grid(bottom[1], [row for row in rows if row["case"] == "exact"], methods, settings)
        handles, labels = top[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=7)
        n = settings["tasks"] * settings["groups"]
        figure.suptitle(
            f"Surveillance, layout X, 68 types and policies, {n} tasks: mean regret, band 95 %", x=0.01, ha="left"
        )
    return figure


def draw_regret(axes: "Axes", rows: Sequence[Mapping]) -> None:
    """Mean regret by episode of each row's method, on a scale that shows small and large."""
    for row in rows:
        colour, style = look_of(row["method"])
        mean, half = np.array(row["curve"]["mean"]), 1.96 * np.array(row["curve"]["error"])
        episodes = np.arange(1, len(mean) + 1)
        if style == "-":
            axes.fill_between(episodes, np.maximum(mean - half, 0), mean + half, color=colour, alpha=0.1, lw=0)
        axes.plot(episodes, mean, color=colour, ls=style, lw=1.5, label=row["method"])
    axes.set_yscale("symlog", linthresh=10, linscale=1)
    axes.set_yticks([0, 5, 10, 50, 100, 200], ["0", "5", "10", "50", "100", "200"])
    axes.minorticks_off()
    axes.set(xlabel="episode", ylim=(0, 330), xlim=(1, None))
    axes.grid(axis="y", color=LIGHT)


def _draw_entropy(axes: "Axes", rows: Sequence[Mapping]) -> None:
    for row in rows:
        colour, style = look_of(row["method"])
        axes.plot(np.arange(len(row["entropy"])), row["entropy"], color=colour, ls=style, lw=1.5)
    axes.set(title="Entropy of the belief, exact models (nats)", xlabel="after episode", ylim=(0, None))
    axes.set_xlim(0, None)
    axes.grid(axis="y", color=LIGHT)


def _draw_grid(axes: "Axes", rows: Sequence[Mapping], methods: Sequence[str], settings: Mapping) -> None:
    """A line a method: in each reserve the median episode after which regret ended, and the share stuck."""
    worst = settings["episodes"] + 1
    for k, method in enumerate(methods):
        of_method = [row for row in rows if row["method"] == method]
        colour, _ = look_of(method)
        for row in of_method:
            default = all(row[key] == value for key, value in DEFAULT.items())
            jitter = 0.0 if default else 0.28 * (((hash_of(row) % 97) / 48) - 1)
            axes.plot(
                [row["ended_median"]["value"]], [k + jitter], "D" if default else "o", ms=6 if default else 4,
                color=colour, mec=INK if default else "white", mew=0.8 if default else 0.4,
                zorder=4 if default else 3,
            )  # fmt: skip
        stuck = np.mean([row["stuck"]["value"] for row in of_method])
        axes.text(
            worst + 1.5,
            k,
            f"{100 * stuck:.0f} %",
            va="center",
            fontsize=8,
            color=VERMILION if stuck > 0.05 else GREY,
        )
    axes.text(worst + 1.5, -1, "stuck", va="center", fontsize=8, color=GREY)
    axes.axvline(15, color=GREY, lw=0.8, ls=(0, (3, 2)))
    axes.set_yticks(range(len(methods)), methods)
    n = len({tuple(row[key] for key in DEFAULT) for row in rows})
    axes.set(
        title=f"Episode after which regret ended, in {n} reserves",
        xlabel="median over tasks; diamond: layout X, Chebyshev, deviation 20",
        xlim=(0, worst + 1),
        ylim=(len(methods) - 0.5, -1.5),
    )
    axes.grid(axis="x", color=LIGHT)


def hash_of(row: Mapping) -> int:
    """A number that depends on the reserve alone: points that coincide part a little."""
    return sum((k + 1) * ord(letter) for key in DEFAULT for k, letter in enumerate(row[key]))
