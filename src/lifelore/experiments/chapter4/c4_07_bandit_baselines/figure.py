"""Policy reuse and its peers: regret by episode, summed regret, and what each was given (C4.7; Figure 4.11)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.experiments.chapter4.reuse_palette import look_of
from lifelore.experiments.chapter4.selection_curves import DEFAULT, draw_regret
from lifelore.figures.style import GREY, INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_peer_curves(result)


SHOWN = (
    "EI", "IDS", "sampling", "GP-UCB", "GP-UCB, tuned", "GP-UCB, true metric", "UCB1", "UCB1, tuned",
    "interval estimation", "eps-greedy on means",
)  # fmt: skip
_CASES = {"headline": "Learnt models, half the tasks unseen", "exact": "Exact models, at targets"}


def draw_peer_curves(result: Mapping) -> "Figure":
    """From C4.7's result: curves by case, then every method's sum beside what it was given."""
    rows, settings = result["rows"], result["settings"]
    default = [row for row in rows if "curve" in row]
    with house_style():
        figure = new_figure(11.6, 9.6)
        top, bottom = figure.subfigures(2, 1, height_ratios=[1, 1.08])  # pyright: ignore
        panels = top.subplots(1, 2, sharey=True)
        for axes, (case, words) in zip(panels, _CASES.items(), strict=True):
            shown = [row for row in default if row["case"] == case and row["method"] in SHOWN]
            draw_regret(axes, sorted(shown, key=lambda row: SHOWN.index(row["method"])))
            axes.set_title(words)
        panels[0].set_ylabel("expected regret")
        top.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
        n = settings["tasks"] * settings["groups"]
        top.suptitle(f"Surveillance, layout X, {n} tasks: mean regret", x=0.01, ha="left")
        _draw_sums(bottom.subplots(), default, [row for row in rows if "curve" not in row], settings)
    return figure


def _draw_sums(axes: "Axes", default: Sequence[Mapping], grid: Sequence[Mapping], settings: Mapping) -> None:
    """A line a method: sums with exact and learnt models, dots for the other reserves, and what it was given."""
    exact = sorted((r for r in default if r["case"] == "exact"), key=lambda r: r["cumulative"]["value"])
    most = max(row["cumulative"]["value"] for row in default)
    for k, row in enumerate(exact):
        colour, _ = look_of(row["method"])
        learnt = next(r for r in default if r["case"] == "headline" and r["method"] == row["method"])
        for place, one, shade in ((-0.19, row, 1.0), (0.19, learnt, 0.5)):
            value, ends = one["cumulative"]["value"], one["cumulative"]["ci95"]
            axes.barh(k + place, value, 0.36, color=colour, alpha=shade)
            if ends:
                axes.plot(ends, [k + place] * 2, color=INK, lw=1)
        others = [r["cumulative"]["value"] for r in grid if r["method"] == row["method"]]
        axes.plot(others, [k - 0.19] * len(others), "o", color="white", mec=GREY, ms=3.5, mew=0.8)
        tuned = ", ".join(f"{key.replace('_', ' ')} {value:g}" for key, value in row["tuned"].items())
        axes.text(1.04 * most, k, row["given"] + (f" ({tuned})" if tuned else ""), va="center", fontsize=7.5)
    axes.set_yticks(range(len(exact)), [row["method"] for row in exact])
    axes.set(xlim=(0, 2.35 * most), ylim=(len(exact) - 0.4, -1.2), xlabel=_xlabel(grid, settings))
    axes.set_xticks([t for t in range(0, 12_001, 2000) if t <= 1.02 * most])
    axes.text(1.04 * most, -0.85, "given beforehand", fontsize=8, color=GREY, va="center")
    axes.set_title(f"Regret summed over {settings['episodes']} episodes: exact (dark) and learnt models (pale)")
    axes.grid(axis="x", color=LIGHT)
    axes.xaxis.set_label_coords(0.21, -0.06)


def _xlabel(grid: Sequence[Mapping], settings: Mapping) -> str:
    n = len({tuple(row[key] for key in DEFAULT) for row in grid})
    return f"rings: {n} other reserves" if n else ""
