"""C4.6: how much regret varies over ten surveillance tasks, by rule and episode. Thesis: §4.6.4, Table 4.3."""

from collections.abc import Mapping
from itertools import product

from lifelore.core.errors import InputError
from lifelore.domains.surveillance.surveillance import NOISES
from reproduction.chapter4.reuse.rules import RULES_SHOWN
from reproduction.chapter4.surveillance.runs import DEFAULT_WORLD, run_method

AFTER = (5, 10, 20, 50)
DOUBTING = ("EI", "IDS", "sampling")
"""Rules that also run with a belief over types and the parameters of their models."""
METHODS = (*RULES_SHOWN, "BE, κ 30")


def check(settings: Mapping) -> None:
    if tuple(settings["after"]) != AFTER:
        raise InputError(f"after must be {list(AFTER)}, as printed, got {settings['after']}")


def cells(settings: Mapping) -> list[dict]:
    """Every rule with exact and with learnt models, and with exact ones under the other reading of the noise.

    Three rules also doubt their models.
    """
    noises = [("exact", noise) for noise in NOISES] + [("headline", DEFAULT_WORLD["noise"])]
    ways = [*product(noises, METHODS), *product([("uncertain, with unseen", DEFAULT_WORLD["noise"])], DOUBTING)]
    return [
        {"method": name, "case": case, **DEFAULT_WORLD, "noise": noise, "groups": settings["groups"]}
        for (case, noise), name in ways
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Regret after the printed episodes, task by task."""
    found = run_method(settings, cell, seed)
    return {key: found[key] for key in (*cell, "at", "against_mean", "realised")}
