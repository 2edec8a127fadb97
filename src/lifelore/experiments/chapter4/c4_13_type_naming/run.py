"""C4.13: how fast BEAT names the right type, and which types it confuses. Thesis: §4.8.5.2, Figure 4.17.

Players who have reached the goal keep their belief: an average over the others would be one over slow players.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.experiments.chapter4.ball_game_methods import BEATS, EPISODES, NamedTypes, beat_learner, known_of
from lifelore.experiments.chapter4.ball_game_play import Players, play_all
from lifelore.experiments.chapter4.ball_game_settings import Setting
from lifelore.experiments.chapter4.ball_game_settings import check_games as check

__all__ = ["cells", "check", "run_cell"]
WAYS: dict[str, dict] = {
    **{name: BEATS[name] for name in ("BEAT", "BEAT, ε as printed")},
    "BEAT with commands": {"commands": True},
}


def cells(settings: Mapping) -> list[dict]:
    """Every variant of BEAT on the first game, the plain one on the others."""
    first, *others = settings["games"]
    found = [{"game": list(first), "way": way} for way in WAYS]
    return found + [{"game": list(game), "way": "BEAT"} for game in others]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Shares named right by step and type, confusions half-way and at the ends, ratios of sizes, steps needed."""
    setting = Setting(*cell["game"])
    known = known_of(setting, settings["training"], settings["tuning"], seed)
    n_types = known.game.n_types
    kinds = np.arange(n_types).repeat(settings["players"])
    players = Players.drawn(kinds, EPISODES, stream(seed, "C4.13", setting.words))
    generator = stream(seed, "C4.13", setting.words, cell["way"])
    learner = beat_learner(known, len(kinds), generator, WAYS[cell["way"]])
    watch = NamedTypes(learner)
    first = Players(players.kinds, players.sigma[:, :1], players.random[:, :1])
    lengths = play_all(known.game, first, learner, known.scale, watch=watch).steps[:, 0]
    named = np.array(watch.first)
    after_first = learner.users.log_belief.argmax(axis=1)
    rest = Players(players.kinds, players.sigma[:, 1:], players.random[:, 1:])
    play_all(known.game, rest, learner, known.scale, watch=watch)
    last = learner.users.log_belief.argmax(axis=1)
    half = named[np.minimum(-(-lengths // 2), len(named)) - 1, np.arange(len(kinds))]
    sizes = np.array(known.game.sizes, float)
    right = (named == kinds).reshape(len(named), n_types, -1).mean(axis=2)
    ratio = (sizes[named] / sizes[kinds]).reshape(len(named), n_types, -1).mean(axis=2)
    return {
        **cell,
        "right": np.round(right.T, 4).tolist(),
        "ratio": np.round(ratio.T, 4).tolist(),
        "half": confusion(kinds, half, n_types),
        "first": confusion(kinds, after_first, n_types),
        "last": confusion(kinds, last, n_types),
        "at_40": confusion(kinds, named[min(40, len(named)) - 1], n_types),
        "needed": np.where(last == kinds, watch.wrong_until, -1).tolist(),
        "lengths": lengths.tolist(),
    }


def confusion(true: NDArray[np.int64], named: NDArray[np.int64], n_types: int) -> list[list[int]]:
    """How many players of each true type (rows) were taken for each type (columns)."""
    counts = np.zeros((n_types, n_types), int)
    np.add.at(counts, (true, named), 1)
    return counts.tolist()
