"""C4.11: losses of every ball size at every speed, in several games. Thesis: §4.8.5.2, Figure 4.15."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import LossScale
from lifelore.experiments.chapter4.ball_game_play import FixedSpeeds, Players, play_all
from lifelore.experiments.chapter4.ball_game_settings import Setting
from lifelore.experiments.chapter4.ball_game_settings import check_games as check

__all__ = ["cells", "check", "run_cell"]


def cells(settings: Mapping) -> list[dict]:
    """A cell for each game; every normalisation uses the same episodes."""
    return [{"game": list(game)} for game in settings["games"]]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Steps and collisions of every size at every speed, (n_types, n_speeds, episodes) as lists."""
    game = Setting(*cell["game"]).game
    kinds = np.arange(game.n_types).repeat(settings["episodes"])
    players = Players.drawn(kinds, 1, stream(seed, "C4.11", "players"))
    every = [
        play_all(game, players, FixedSpeeds(np.full(len(kinds), z)), LossScale()) for z in range(game.n_speeds)
    ]
    shape = (game.n_speeds, game.n_types, settings["episodes"])
    steps, hits = (
        np.array([played[i] for played in every]).reshape(shape).swapaxes(0, 1).tolist() for i in (0, 1)
    )
    return {"game": list(cell["game"]), "steps": steps, "hits": hits}
