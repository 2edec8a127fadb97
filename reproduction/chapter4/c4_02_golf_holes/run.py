"""C4.2: golf by shot on unknown holes: greedy selection and single clubs. Thesis: §4.6.1, Figure 4.4."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.golf.golf import CLUBS, Golf
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PURPLE, VERMILION, Axes
from reproduction.chapter4.golf import rounds
from reproduction.engine.records import having
from reproduction.figures.panels import panels

FIRST = {None: "greedy", rounds.WOOD: "club 1"}
"""The first club: the rule's choice, or club 1 as in the worked example."""


def cells(settings: Mapping) -> list[dict]:
    """Greedy selection with exact and with learnt models, freely and after club 1; and single clubs."""
    ways = product((None, *settings["samples"]), FIRST)
    return [*({"samples": n, "first": first} for n, first in ways), {"part": "clubs"}]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Means of each group of holes: error by shot, entropy before each shot and after the last."""
    play = _play_clubs if "part" in cell else _play
    groups = [play(settings, cell, seed, group) for group in range(settings["groups"])]
    return {**cell, **{key: [group[key] for group in groups] for key in groups[0]}}


def _play(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict:
    library = rounds.exact_library()
    if cell["samples"]:
        training = stream(seed, "training shots", cell["samples"], group)
        library = rounds.learnt_library(training, cell["samples"], settings["pseudo_count"])
    holes = rounds.draw_group(settings, seed, group)
    found = rounds.play_greedily(library, *holes, stream(seed, "golfer", group), cell["first"])
    return {
        "error": np.abs(found.error).mean(axis=0).round(5).tolist(),
        "entropy": found.entropy.mean(axis=0).round(6).tolist(),
    }


def _play_clubs(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict:
    """Mean misses of single clubs, and of the best club for each hole, with the second shot's luck."""
    distance, luck = rounds.draw_group(settings, seed, group)

    def miss(clubs: np.ndarray) -> float:
        return round(float(np.abs(rounds.errors_of(clubs, distance, luck[:, 1])).mean()), 5)

    golf = Golf()
    best = golf.mean_at(distance).argmax(axis=1)
    return {"club": [miss(np.full(len(luck), j)) for j in range(golf.n_clubs)], "best": miss(best)}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each kind of models with each first club; intervals are over groups of holes."""
    clubs = np.array(results[-1]["club"])
    single = clubs[:, clubs.mean(axis=0).argmin()]
    for result in results[:-1]:
        error, entropy = np.array(result["error"]), np.array(result["entropy"])
        models = f"{result['samples']} shots" if result["samples"] else "exact"
        yield (
            {"models": models, "first_club": FIRST[result["first"]]},
            {
                "error_shot_2": mean_estimate(error[:, 1]),
                "entropy_fall": mean_estimate(entropy[:, 0] - entropy[:, -1]),
                "gain_over_single_club": mean_estimate(single - error[:, 1]),
            },
        )


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The default's curves, and the misses of single clubs and of the best club."""
    greedy = having(results[:-1], samples=None, first=None)[0]
    kept = {"error": greedy["error"], "entropy": greedy["entropy"], **results[-1]}
    return [{key: np.mean(kept[key], axis=0).round(4).tolist() for key in ("error", "entropy", "club", "best")}]


CLUB_COLOURS = (BLUE, GREEN, ORANGE, PURPLE)


@panels(7.6, 3.9, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """Golf by shot: mean distance to the hole beside single clubs, and entropy of the belief (Figure 4.4).

    Distance on the left axis with a level for each club, entropy on the right axis.
    """
    (row,), settings = result["rows"], result["settings"]
    shots = range(1, settings["shots"] + 1)
    axes.axhspan(10, 15, color=LIGHT, alpha=0.7, lw=0)
    axes.text(shots[-1], 15.4, "10–15 yards", ha="right", va="bottom", fontsize=8, color=GREY)
    for name, colour, missed in zip(CLUBS, CLUB_COLOURS, row["club"], strict=True):
        axes.axhline(missed, color=colour, lw=1, ls=(0, (1, 1.5)), label=f"only the {name}")
    axes.axhline(row["best"], color=INK, lw=1, ls=(0, (4, 2)), label="best club for each hole")
    axes.plot(shots, row["error"], "o-", color=BLUE, label="greedy policy reuse")
    axes.set(xlabel="shot", ylabel="mean distance to the hole (yards)", ylim=(0, None))
    right = axes.twinx()
    right.plot(shots, row["entropy"][:-1], "s-", color=VERMILION, ms=4, label="entropy (right axis)")
    right.set(ylim=(0, None), ylabel="entropy of the belief before the shot (nats)")
    right.spines["right"].set_visible(True)
    axes.figure.legend(loc="outside right upper")
    axes.set_title(f"{settings['groups']} × {settings['holes']} unknown holes, exact models")
