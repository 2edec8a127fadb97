"""Golf by shot: mean error and entropy of the belief, beside single clubs and the optimum (C4.2; Figure 4.4)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from lifelore.experiments.chapter4.category_bars import CLUB_COLOURS
from lifelore.experiments.chapter4.reuse_palette import look_of
from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_golf_curves(result)


_CLUBS = ("3-wood", "3-iron", "6-iron", "9-iron")


def draw_golf_curves(result: Mapping) -> "Figure":
    """From C4.2's result: error by shot, entropy by shot, and each rule's gap to the dynamic program."""
    rows, settings = result["rows"], result["settings"]
    with house_style():
        figure = new_figure(11.2, 4.2)
        error, belief, gaps = figure.subplots(1, 3, width_ratios=[1.25, 0.9, 1])
        _draw_errors(error, rows, settings)
        _draw_entropies(belief, rows)
        _draw_gaps(gaps, [row for row in rows if row["part"] == "program"], settings)
        figure.suptitle(
            f"{settings['groups']:,} × {settings['holes']} unknown holes of {settings['yards'][0]:g} to "
            f"{settings['yards'][1]:g} yards",
            x=0.01, ha="left",
        )  # fmt: skip
    return figure


def _row(rows: list[Mapping], **wanted: Any) -> Mapping:
    return next(row for row in rows if all(row.get(k) == v for k, v in wanted.items()))


def _draw_errors(axes: "Axes", rows: list[Mapping], settings: Mapping) -> None:
    clubs = _row(rows, part="clubs")
    shots = np.arange(1, settings["shots"] + 1)
    axes.axhspan(10, 15, color=LIGHT, alpha=0.7, lw=0)
    axes.text(settings["shots"] + 0.3, 15.4, "10–15 yards", ha="right", va="bottom", fontsize=8, color=GREY)
    for name, colour, missed in zip(_CLUBS, CLUB_COLOURS, clubs["club"], strict=True):
        axes.axhline(missed, color=colour, lw=1, ls=(0, (1, 1.5)))
        axes.text(settings["shots"] + 0.4, missed, name, va="center", fontsize=8, color=colour)
    axes.axhline(clubs["best"], color=INK, lw=1, ls=(0, (4, 2)))
    axes.text(settings["shots"] + 0.4, clubs["best"], "best club", va="center", fontsize=8, color=INK)
    for model, colour in (("exact", ORANGE), ("learnt", BLUE)):
        for first, style in ((None, "-"), (0, (0, (3, 1.5)))):
            row = _row(rows, part="rule", model=model, rule="greedy", first=first)
            label = f"greedy, {model}" + (", 3-wood first" if first == 0 else "")
            axes.plot(shots, row["error"], color=colour, ls=style, marker="o", ms=3.5, label=label)
    axes.set(
        title="Mean error, yards", xlabel="shot", xticks=shots, ylim=(0, None), xlim=(0.7, settings["shots"] + 0.3)
    )
    axes.legend(
        loc="upper right", bbox_to_anchor=(1.0, 0.97), fontsize=7, frameon=True, edgecolor="none", framealpha=1
    )


def _draw_entropies(axes: "Axes", rows: list[Mapping]) -> None:
    for model, colour in (("exact", ORANGE), ("learnt", BLUE)):
        row = _row(rows, part="rule", model=model, rule="greedy", first=None)
        axes.plot(np.arange(len(row["entropy"])), row["entropy"], color=colour, marker="o", ms=3.5, label=model)
    axes.set(title="Entropy of the belief, nats", xlabel="after shot", ylim=(0, None))
    axes.legend(title="models", loc="upper right")


def _draw_gaps(axes: "Axes", found: list[Mapping], settings: Mapping) -> None:
    shown = [row for row in found if not row["way"].startswith(("only", "hole", "dynamic"))]
    shown = sorted(shown, key=lambda row: -row["gap"])
    known = -_of(found, "hole known")["gap"]
    for k, row in enumerate(shown):
        colour, _ = look_of(row["way"])
        axes.barh(k, row["gap"], color=colour, height=0.7)
        axes.text(row["gap"], k, f" {row['gap']:.2f}", va="center", fontsize=8)
    axes.set_yticks(range(len(shown)), [row["way"] for row in shown])
    best = _of(found, "dynamic program")["yards"]
    axes.set(
        title="Yards above the optimum",
        xlabel=f"summed over {settings['horizon']} shots at training holes;\noptimum {best:.1f}, "
        f"hole known {best - known:.1f}",
        xlim=(0, 1.2 * max(row["gap"] for row in shown) + 0.01),
    )  # fmt: skip


def _of(found: list[Mapping], way: str) -> Mapping:
    return next(row for row in found if row["way"] == way)
