"""C4.12: BEAT against EXP-3 and the best static speed, by the diversity of the population.

The best static speed is the population's in training (Eq. 4.8); BEAT and EXP-3 are not told the population. The
default game was chosen by what it shows (`ball_game_settings`); the grid says how far that goes.
Thesis: §4.8.5.2, Figure 4.16.
"""

from collections.abc import Mapping
from math import comb

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.ball_game_settings import N_TYPES, check_games
from lifelore.experiments.chapter4.diversity_runs import run_cell

__all__ = ["cells", "check", "run_cell"]
DIVERSITIES = range(1, N_TYPES + 1)


def check(settings: Mapping) -> None:
    check_games(settings, ("runs", "least", "grid_runs", "training", "tuning"))
    if settings["training"] < 2:
        raise InputError(f"training must be at least 2 episodes, got {settings['training']}")


def cells(settings: Mapping) -> list[dict]:
    """One a game and diversity; the first game gets `runs` a population and at least `least` a diversity."""
    found = []
    for place, game in enumerate(settings["games"]):
        for diversity in DIVERSITIES:
            least = -(-settings["least"] // comb(N_TYPES, diversity))
            runs = settings["grid_runs"] if place else max(settings["runs"], least)
            found.append({"game": list(game), "diversity": diversity, "runs": runs})
    return found
