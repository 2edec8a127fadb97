"""Figures 4.18–4.20 from people where they have played, else from scripted players, who are named as such."""

from collections.abc import Mapping

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREY, LIGHT, VERMILION, Axes, Figure, house_style, new_figure
from reproduction.chapter4.reuse.looks import size_lines

TITLES = {"person": "people", "scripted": "scripted players, people untested"}
METHODS = {"BEAT": "beat", "best static speed of the population": "static"}


def draw(result: Mapping) -> Figure:
    """Figures 4.18, 4.19 and 4.20 side by side."""
    row = result["rows"][0]  # people come first
    sizes = [one["size"] for one in row["named"]]
    with house_style():
        figure = new_figure(11.4, 4.3)
        left, middle, right = figure.subplots(1, 3)
        _draw_losses(left, row, sizes)
        diversity = [one["types"] for one in row["diversity"]]
        series = {name: {"mean": [one[key] for one in row["diversity"]]} for name, key in METHODS.items()}
        looks = {
            name: {"color": colour, "marker": "o", "markersize": 3}
            for name, colour in zip(METHODS, (BLUE, VERMILION), strict=True)
        }
        draw_curves(middle, diversity, series, looks=looks, title="4.19: loss by diversity")
        middle.set(xlabel="ball sizes in the population", ylabel="mean loss", xticks=diversity)
        named = {f"b = {one['size']}": {"mean": one["ratio"]} for one in row["named"]}
        draw_curves(
            right,
            None,
            named,
            looks=size_lines(sizes),
            title="4.20: recognised size",
            logarithmic="y",
            legend=False,
        )
        _plain_ticks(right, [0.5, 1, 2, 5])
        right.axhline(1, color=GREY, linestyle=(0, (1, 2)), linewidth=1)
        right.set(xlabel="move of a round with BEAT", ylabel="most likely / true size (mean)")
        figure.legend(*right.get_legend_handles_labels(), title="ball size", ncols=6, loc="outside lower center")
        for axes in (left, middle, right):
            axes.grid(axis="y", color=LIGHT)
        figure.suptitle(f"{row['sessions']} {TITLES[row['player']]}", fontsize=10)
    return figure


def _draw_losses(axes: Axes, row: Mapping, sizes: list[int]) -> None:
    speeds = sorted({one["speed"] for one in row["losses"]})
    by = {(one["size"], one["speed"]): one for one in row["losses"]}
    series = {
        f"b = {size}": {
            "mean": [by[size, speed]["loss"] for speed in speeds],
            "error": [by[size, speed]["interval"] or 0.0 for speed in speeds],
        }
        for size in sizes
    }
    draw_curves(
        axes, speeds, series, looks=size_lines(sizes), title="4.18: loss by speed", logarithmic="y", legend=False
    )
    _plain_ticks(axes, [0.1, 0.2, 0.5, 1, 2])
    axes.set(xlabel="speed (units a move)", ylabel="mean loss of a round, band 95 %", xticks=speeds)


def _plain_ticks(axes: Axes, ticks: list[float]) -> None:
    """Ticks of a logarithmic axis as plain numbers, those within its limits."""
    low, high = axes.get_ylim()
    shown = [tick for tick in ticks if low <= tick <= high]
    axes.set_yticks(shown, [f"{tick:g}" for tick in shown])
    axes.minorticks_off()
