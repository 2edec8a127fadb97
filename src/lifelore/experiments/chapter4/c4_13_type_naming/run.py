"""C4.13: how fast BEAT names the right type, and which it confuses.

Thesis: §4.8.5.2, Figure 4.17.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.ball_game_settings import check_games
from lifelore.experiments.chapter4.type_naming import WAYS, run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_games(settings, ("players", "training", "tuning"))
    if settings["training"] < 2:
        raise InputError(f"training must be at least 2 episodes, got {settings['training']}")


def cells(settings: Mapping) -> list[dict]:
    """Every way of BEAT on the first game, the plain one on the others."""
    first, *others = settings["games"]
    found = [{"game": list(first), "way": way} for way in WAYS]
    return found + [{"game": list(game), "way": "BEAT"} for game in others]
