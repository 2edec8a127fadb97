"""C4.15: is BEAT safe, efficient and fast?

Safe: no worse than the best static speed, by type and episode. Efficient: what it loses above each type's best
speed. Fast: steps until the type it names is right and stays so. Thesis: §4.8.5.2.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.ball_game_settings import check_games
from lifelore.experiments.chapter4.c4_15_safety.safety_runs import run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_games(settings, ("players", "lots", "training", "tuning"))
    if settings["training"] < 2:
        raise InputError(f"training must be at least 2 episodes, got {settings['training']}")
    if settings["lag"] < 0:
        raise InputError(f"lag must be at least 0 steps, got {settings['lag']}")


def cells(settings: Mapping) -> list[dict]:
    """Lots of players of the first game."""
    return [{"game": list(settings["games"][0]), "lot": lot} for lot in range(settings["lots"])]
