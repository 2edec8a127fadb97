"""C4.2: golf by shot on unknown holes: rules, single clubs and the dynamic program. Thesis: §4.6.1, Figure 4.4."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.golf.golf import CLUBS, Golf
from lifelore.experiments.chapter4.golf_runs import (
    EXACT,
    LEARNT,
    WOOD,
    draw_group,
    errors_of,
    exact_library,
    library_of,
    play_holes,
)
from lifelore.experiments.chapter4.reuse_rules import RULES_SHOWN
from lifelore.interaction.selection.belief_program import best_plan, value_of_rule

GREEDY = "greedy"


def check(settings: Mapping) -> None:
    if settings["yards"][0] > settings["yards"][1]:
        raise InputError(f"yards must rise, got {settings['yards']}")


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
    """Mean misses of single clubs, and of the best club for each hole, with the second shot's luck."""
    distance, luck = draw_group(settings, seed, group)
    golf = Golf()
    missed = [np.abs(errors_of(np.full(len(luck), j), distance, luck[:, 1])) for j in range(golf.n_clubs)]
    best = golf.mean_at(distance).argmax(axis=1)
    return {
        "club": [round(float(m.mean()), 5) for m in missed],
        "best": round(float(np.abs(errors_of(best, distance, luck[:, 1])).mean()), 5),
    }


def program_gaps(horizon: int) -> dict[str, dict]:
    """By rule: yards missed a round in expectation, and how many more than under the dynamic program (Eq. 4.3).

    "dynamic program" is the optimum itself; "hole known" plays the best club for the hole from the first shot.
    """
    library, mean = exact_library(), Golf().mean
    plan = best_plan(library, horizon)
    values = {"hole known": horizon * float(mean.max(axis=1).mean())}
    values |= {name: value_of_rule(library, rule, horizon) for name, rule in RULES_SHOWN.items()}
    values |= {f"only the {club}": horizon * float(mean[:, j].mean()) for j, club in enumerate(CLUBS)}
    best = {"yards": round(-plan.value, 6), "gap": 0.0, "first_club": CLUBS[plan.first]}
    others = {name: {"yards": round(-v, 6), "gap": round(plan.value - v, 6)} for name, v in values.items()}
    return {"dynamic program": best, **others}
