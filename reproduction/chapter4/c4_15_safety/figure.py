"""Loss by episode, loss by type against the best static speed, how soon types are named; then all games."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, LIGHT, Axes, Figure, house_style, new_figure
from reproduction.chapter4.ball_game.methods import BEAT, BEAT_PRINTED, STATIC
from reproduction.chapter4.c4_15_safety.measure import asked_of_every_game, sentence
from reproduction.chapter4.reuse.looks import (
    GAMES_IN_WORDS,
    draw_ratio_grid,
    legend_below,
    lines_of,
    size_lines,
)
from reproduction.engine.predicate import Condition

SHOWN = ("EXP-3 as printed", "EXP-3 tuned", STATIC, BEAT_PRINTED, BEAT, "best speed of each type")

MAPS = {BEAT_PRINTED: "BEAT, ε as printed", BEAT: "BEAT, ε = 0"}
"""Methods whose losses are mapped by type and episode, as shares of those of the best static speed."""


def draw(result: Mapping) -> Figure:
    losses = {row["method"]: np.array(row["loss"]) for row in result["rows"] if "method" in row}
    episodes = range(1, losses[BEAT].shape[1] + 1)
    with house_style():
        games = [row for row in result["rows"] if "met" in row]
        figure = new_figure(13.6, 5.5 + 0.25 * len(games))
        figure.get_layout_engine().set(w_pad=0.12)  # pyright: ignore[reportOptionalMemberAccess, reportCallIssue]
        places = figure.add_gridspec(2, 4, height_ratios=[3.9, 1.0 + 0.25 * len(games)])
        by_episode, *by_type, naming = (figure.add_subplot(places[0, column]) for column in range(4))
        series = {method: {"mean": losses[method].mean(axis=0)} for method in SHOWN}
        draw_curves(by_episode, None, series, looks=lines_of(SHOWN, marker="o", ms=3), legend=False)
        by_episode.set(
            title="efficiency: loss by episode", xlabel="episode", ylabel="mean loss, six types", xticks=episodes
        )
        legend_below(by_episode, 0.75)
        for axes, (method, words) in zip(by_type, MAPS.items(), strict=True):
            ratios = losses[method] / losses[STATIC]
            draw_ratio_grid(axes, ratios, [f"b = {b}" for b in SIZES], [str(episode) for episode in episodes])
            axes.set(xlabel="episode", title=f"safety: loss / best static's,\n{words}")
        _draw_naming(naming, result["rows"][-1])
        _draw_games(figure.add_subplot(places[1, :]), games)
        figure.supxlabel(GAMES_IN_WORDS, fontsize=8, color=GREY)
    return figure


def _draw_games(axes: Axes, games: Sequence[Mapping]) -> None:
    """Each game's numbers as shares of their bounds, bold where the condition is met; the sentence first."""
    headlines = [one.condition for one in sentence()]
    told = {c.measure for c in headlines}
    asked = [*headlines, *(c for c in asked_of_every_game() if c.measure not in told)]
    shares = [[_of_bound(row[c.measure]["value"], c) for c in asked] for row in games]
    met = [[(row["met"] | row["sentence"])[c.measure] for c in asked] for row in games]
    look = {"neutral": 1.0, "spread": 1.35, "good": "low", "ratio": True, "words": "{:.2f}".format}
    names = [c.name.replace(", ", ",\n") for c in asked]
    draw_heat_grid(axes, shares, met, [row["words"] for row in games], names, **look)
    words = "every game: the number divided by its bound, at most 1 asked (bold: met)"
    axes.set_title(f"{words}; the first {len(headlines)} with ε as printed", loc="right")


def _of_bound(value: float, condition: Condition) -> float:
    """How far a number is from its bound: below 1 where it is on the side asked for."""
    bound = float(condition.bound)  # pyright: ignore[reportArgumentType]
    share = value / bound if condition.op.startswith("<") else bound / value if value > 0 else np.inf
    return max(share, 0.01)


def _draw_naming(axes: Axes, row: Mapping) -> None:
    looks = size_lines(SIZES, linewidth=2.8)
    series = {name: {"mean": shares} for name, shares in zip(looks, row["named_printed"], strict=True)}
    draw_curves(axes, row["steps"], series, looks=looks, logarithmic="x", legend=False)
    axes.set(
        title="speed of naming the type,\nε as printed", xlabel="steps played", ylabel="share named right for good"
    )
    axes.axvline(row["length_printed"], color=GREY, linewidth=1)
    axes.annotate(
        "end of the\nfirst episode", (row["length_printed"], 1.05), xytext=(-4, 0), textcoords="offset points",
        fontsize=7, color=GREY, ha="right", va="bottom",
    )  # fmt: skip
    axes.set_ylim(0, 1.18)
    axes.set_xticks([1, 10, 100, 500], ["1", "10", "100", "500"])
    axes.minorticks_off()
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
