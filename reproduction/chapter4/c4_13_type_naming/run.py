"""C4.13: how fast BEAT names the right type, and which types it confuses. Thesis: §4.8.5.2, Figure 4.17.

Players who have reached the goal keep their belief: otherwise the average would be that of slow players.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from reproduction.chapter4.ball_game.games import Setting
from reproduction.chapter4.ball_game.games import check_games as check
from reproduction.chapter4.ball_game.methods import BEATS, EPISODES, NamedTypes, beat_learner, known_of
from reproduction.chapter4.ball_game.play import Players, play_all

__all__ = ["cells", "check", "run_cell"]
WAYS = {name: BEATS[name] for name in ("BEAT", "BEAT, ε as printed")} | {"BEAT with commands": {"commands": True}}


def cells(settings: Mapping) -> list[dict]:
    """Every variant of BEAT on the first game, the plain one on the others."""
    first, *others = settings["games"]
    found = [{"game": list(first), "way": way} for way in WAYS]
    return found + [{"game": list(game), "way": "BEAT"} for game in others]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Shares named right and ratios of sizes by step, confusions half-way and at the ends, steps needed."""
    setting = Setting(*cell["game"])
    known = known_of(setting, settings["training"], settings["tuning"], seed)
    n_types = known.game.n_types
    kinds = np.arange(n_types).repeat(settings["players"])
    players = Players.drawn(kinds, EPISODES, stream(seed, "C4.13", setting.words))
    generator = stream(seed, "C4.13", setting.words, cell["way"])
    learner = beat_learner(known, len(kinds), generator, WAYS[cell["way"]])
    watch = NamedTypes(learner)
    lengths = play_all(known.game, players.between(0, 1), learner, known.scale, watch=watch).steps[:, 0]
    named, after_first = np.array(watch.first), watch.named
    play_all(known.game, players.between(1), learner, known.scale, watch=watch)
    sizes = np.array(known.game.sizes, float)
    by_step = {"right": named == kinds, "ratio": sizes[named] / sizes[kinds]}
    means = {key: each.reshape(len(named), n_types, -1).mean(axis=2) for key, each in by_step.items()}
    ends = {
        "half": watch.halfway(lengths),
        "first": after_first,
        "last": watch.named,
        "at_40": named[min(40, len(named)) - 1],
    }
    return {
        **cell,
        **{key: np.round(mean.T, 4).tolist() for key, mean in means.items()},
        **{when: confusion(kinds, types, n_types) for when, types in ends.items()},
        "needed": watch.steps_needed(kinds).tolist(),
        "lengths": lengths.tolist(),
    }


def confusion(true: NDArray[np.int64], named: NDArray[np.int64], n_types: int) -> list[list[int]]:
    """How many players of each true type (rows) were taken for each type (columns)."""
    counts = np.zeros((n_types, n_types), int)
    np.add.at(counts, (true, named), 1)
    return counts.tolist()
