"""C4.12: BEAT, EXP-3 and constant speeds, by the diversity of the population. Thesis: §4.8.5.2, Figure 4.16."""

from collections.abc import Mapping
from math import comb

import numpy as np

from lifelore.core.streams import stream
from reproduction.chapter4.ball_game.games import N_TYPES, Setting
from reproduction.chapter4.ball_game.games import check_games as check
from reproduction.chapter4.ball_game.methods import crowd_of, known_of, run_methods

__all__ = ["cells", "check", "run_cell"]
DIVERSITIES = range(1, N_TYPES + 1)


def cells(settings: Mapping) -> list[dict]:
    """One a game and diversity; the first game gets `runs` a population and at least `least` a diversity."""
    found = []
    for place, game in enumerate(settings["games"]):
        for diversity in DIVERSITIES:
            least = -(-settings["least"] // comb(N_TYPES, diversity))
            runs = settings["grid_runs"] if place else max(settings["runs"], least)
            found.append({"game": list(game), "diversity": diversity, "runs": runs})
    return found


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean loss of each run's five episodes by method, for all populations of one size."""
    setting = Setting(*cell["game"])
    known = known_of(setting, settings["training"], settings["tuning"], seed)
    name = f"C4.12 {setting.words} {cell['diversity']}"
    crowd = crowd_of(cell["diversity"], known.game.n_types, cell["runs"], stream(seed, name, "players"))
    found = run_methods(known, crowd, seed, name)
    losses = {method: np.round(lost.mean(axis=1), 5).tolist() for method, lost in found.items()}
    best = np.array(known.game.speeds)[known.value.argmax(axis=1)].tolist()
    return {**cell, "populations": len(crowd.members), "losses": losses, "gamma": known.gamma, "best": best}
