"""C4.11: losses of every ball size at every speed, in several games. Thesis: §4.8.5.2, Figure 4.15."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.streams import stream
from reproduction.chapter4.ball_game.games import Setting
from reproduction.chapter4.ball_game.games import check_games as check
from reproduction.chapter4.ball_game.play import Players, play_speeds

__all__ = ["cells", "check", "run_cell"]


def cells(settings: Mapping) -> list[dict]:
    """A cell for each game; every normalisation uses the same episodes."""
    return [{"game": list(game)} for game in settings["games"]]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Steps and collisions of every size at every speed, (n_types, n_speeds, episodes) as lists."""
    game = Setting(*cell["game"]).game
    kinds = np.arange(game.n_types).repeat(settings["episodes"])
    played = np.array(play_speeds(game, Players.drawn(kinds, 1, stream(seed, "C4.11", "players"))))
    by_speed = played.reshape(game.n_speeds, 2, game.n_types, settings["episodes"])
    steps, hits = by_speed.transpose(1, 2, 0, 3).tolist()
    return {"game": list(cell["game"]), "steps": steps, "hits": hits}
