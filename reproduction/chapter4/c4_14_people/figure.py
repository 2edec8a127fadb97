"""Figures 4.18 to 4.20 from people where they have played, else from scripted players, who are named as such."""

from collections.abc import Mapping

from lifelore.figures.style import GREY, Axes
from reproduction.chapter4.ball_game.looks import METHODS, WORDS, size_lines
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

TITLES = {"person": "people", "scripted": "scripted players; no person has played"}


@panels(10.6, 3.8, 1, 3)
def draw(result: Mapping, left: Axes, middle: Axes, right: Axes) -> None:
    """The three figures side by side."""
    row = result["rows"][0]  # people come first
    sizes = [one["size"] for one in row["named"]]
    _draw_losses(left, row, sizes)
    for name, key in (("static", "static"), ("BEAT", "beat")):
        values = [one[key] for one in row["diversity"]]
        middle.plot(range(1, len(values) + 1), values, color=METHODS[name], label=WORDS[name], marker="o", ms=4)
    middle.set(title="Figure 4.19", xlabel="population diversity (types)", ylabel="mean loss of a round")
    middle.set_ylim(0, None)
    middle.set_xticks(range(1, len(row["diversity"]) + 1))
    middle.legend()
    named = {f"b = {one['size']}": {"mean": one["ratio"]} for one in row["named"]}
    draw_curves(right, None, named, looks=size_lines(sizes), title="Figure 4.20", legend=False)
    right.axhline(1, color=GREY, linestyle=(0, (4, 2)), linewidth=1)
    right.set(xlabel="move of a round with BEAT", ylabel="most likely size / true size", ylim=(0, None))
    left.figure.legend(
        *right.get_legend_handles_labels(), title="size of the ball", ncols=6, loc="outside lower center"
    )
    left.figure.suptitle(f"{row['sessions']} {TITLES[row['player']]}", fontsize=10)


def _draw_losses(axes: Axes, row: Mapping, sizes: list[int]) -> None:
    speeds = sorted({one["speed"] for one in row["losses"]})
    loss = {(one["size"], one["speed"]): one["loss"] for one in row["losses"]}
    series = {f"b = {size}": {"mean": [loss[size, speed] for speed in speeds]} for size in sizes}
    draw_curves(axes, speeds, series, looks=size_lines(sizes, marker="o", ms=4), title="Figure 4.18", legend=False)
    axes.set(xlabel="speed z", ylabel="mean loss of a round", xticks=speeds, ylim=(0, None))
