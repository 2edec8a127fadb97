"""C4.2: a hundred unknown holes of 120 to 220 yards: error and belief by shot, beside single clubs.

What each was given: the rules four clubs on four training holes, exactly or from `samples` shots a pair, and
after each shot its category; a single club nothing; the best club the hole's distance. The dynamic program (Eq.
4.3, three shots) knows the models and that the hole is one of the four, and is the best that can be done then.

Headline: greedy selection with models learnt from samples; no hole played is a training hole.

Thesis: §4.6.1, Figure 4.4.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.golf.golf import Golf
from lifelore.experiments.chapter4.c4_02_golf_holes.golf_programs import program_gaps
from lifelore.experiments.chapter4.golf_runs import (
    EXACT,
    LEARNT,
    WOOD,
    draw_group,
    errors_of,
    library_of,
    play_holes,
)
from lifelore.experiments.chapter4.reuse_rules import RULES_SHOWN
from lifelore.experiments.engine.learning_settings import check_counts

GREEDY = "greedy"


def check(settings: Mapping) -> None:
    check_counts(settings, ("groups", "holes", "samples", "horizon"))
    check_counts(settings, ("shots",), 2)
    yards = settings["yards"]
    if np.shape(yards) != (2,) or not 0 < yards[0] <= yards[1]:
        raise InputError(f"yards must be two distances, rising, above 0, got {yards}")
    if settings["pseudo_count"] < 0:
        raise InputError(f"pseudo_count must be at least 0, got {settings['pseudo_count']}")


def cells(settings: Mapping) -> list[dict]:
    """Each rule on each kind of model, greedy also with the 3-wood first, single clubs, and the program."""
    played = [
        {"part": "rule", "model": m, "rule": name, "first": None} for m in (LEARNT, EXACT) for name in RULES_SHOWN
    ]
    forced = [{"part": "rule", "model": m, "rule": GREEDY, "first": WOOD} for m in (LEARNT, EXACT)]
    return [*played, *forced, {"part": "clubs"}, {"part": "program"}]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Means of each group of holes: error by shot, entropy before each shot and after the last."""
    if cell["part"] == "program":
        return {**cell, "found": program_gaps(settings["horizon"])}
    groups = [
        (_clubs_of if cell["part"] == "clubs" else _rule_of)(settings, cell, seed, group)
        for group in range(settings["groups"])
    ]
    keys = groups[0].keys()
    return {**cell, **{key: [group[key] for group in groups] for key in keys}}


def _rule_of(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict:
    distance, luck = draw_group(settings, seed, group)
    library = library_of(settings, cell["model"], seed, group)
    found = play_holes(RULES_SHOWN[cell["rule"]], library, distance, luck, seed + group, cell["first"])
    return {
        "error": np.abs(found.error).mean(axis=0).round(5).tolist(),
        "entropy": found.entropy.mean(axis=0).round(6).tolist(),
    }


def _clubs_of(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict:
    """What single clubs miss by at the second shot's luck, and the best club for the hole in retrospect."""
    distance, luck = draw_group(settings, seed, group)
    golf = Golf()
    missed = [np.abs(errors_of(np.full(len(luck), j), distance, luck[:, 1])) for j in range(golf.n_clubs)]
    best = golf.mean_at(distance).argmax(axis=1)
    return {
        "club": [round(float(m.mean()), 5) for m in missed],
        "best": round(float(np.abs(errors_of(best, distance, luck[:, 1])).mean()), 5),
    }
