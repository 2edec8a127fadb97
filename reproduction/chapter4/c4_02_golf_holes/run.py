"""C4.2: golf by shot on unknown holes: rules, single clubs and the dynamic program. Thesis: §4.6.1, Figure 4.4."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.golf.golf import CLUBS, Golf
from lifelore.interaction.selection.belief_program import best_plan, value_of_rule
from reproduction.chapter4.golf import rounds
from reproduction.chapter4.golf.rounds import WOOD
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN
from reproduction.chapter4.reuse.rules import RULES_SHOWN

GREEDY = "greedy"
DOUBTING = (GREEDY, "EI", "IDS", "sampling")
"""Rules that also run with a belief over types and the parameters of their models."""


def check(settings: Mapping) -> None:
    if settings["yards"][0] > settings["yards"][1]:
        raise InputError(f"yards must rise, got {settings['yards']}")


def cells(settings: Mapping) -> list[dict]:
    """Each rule on each kind of model, greedy also with the 3-wood first, single clubs, and the program."""
    ways = [(m, name, None) for m in (LEARNT, EXACT) for name in RULES_SHOWN]
    ways += [(m, GREEDY, WOOD) for m in (LEARNT, EXACT)]
    ways += [(UNCERTAIN, name, None) for name in DOUBTING] + [(UNCERTAIN, GREEDY, WOOD)]
    played = [{"part": "rule", "model": model, "rule": name, "first": first} for model, name, first in ways]
    return [*played, {"part": "clubs"}, {"part": "program"}]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Means of each group of holes: error by shot, entropy before each shot and after the last."""
    if cell["part"] == "program":
        return {**cell, "found": program_gaps(settings["horizon"])}
    play = _play_clubs if cell["part"] == "clubs" else _play_rule
    groups = [play(settings, cell, seed, group) for group in range(settings["groups"])]
    return {**cell, **{key: [group[key] for group in groups] for key in groups[0]}}


def _play_rule(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict:
    distance, luck = rounds.draw_group(settings, seed, group)
    library = rounds.library_of(settings, cell["model"], seed, group)
    rule = RULES_SHOWN[cell["rule"]]
    found = rounds.play_holes(rule, library, distance, luck, seed + group, cell["first"], cell["model"])
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


def program_gaps(horizon: int) -> dict[str, dict]:
    """By rule: yards missed a round in expectation, and how many more than under the dynamic program (Eq. 4.3).

    "dynamic program" is the optimum itself; "hole known" plays the best club for the hole from the first shot.
    """
    library, mean = rounds.exact_library(), Golf().mean
    plan = best_plan(library, horizon)
    values = {"hole known": horizon * float(mean.max(axis=1).mean())}
    values |= {name: value_of_rule(library, rule, horizon) for name, rule in RULES_SHOWN.items()}
    values |= {f"only the {club}": horizon * float(mean[:, j].mean()) for j, club in enumerate(CLUBS)}
    best = {"yards": round(-plan.value, 6), "gap": 0.0, "first_club": CLUBS[plan.first]}
    others = {name: {"yards": round(-v, 6), "gap": round(plan.value - v, 6)} for name, v in values.items()}
    return {"dynamic program": best, **others}
