"""When BEAT names the right type: what it believes of every player at every step. The runs behind claim C4.13.

Those who have reached the goal keep their belief: an average over those who still play would be one over the slow.
Thesis: §4.8.5.2.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.simulated_player import Balls
from lifelore.experiments.chapter4.ball_game_learners import BeatLearner
from lifelore.experiments.chapter4.ball_game_play import Ints, Moves, Players, play_all
from lifelore.experiments.chapter4.ball_game_settings import Setting
from lifelore.experiments.chapter4.diversity_runs import EPISODES, Known, known_of

WAYS: dict[str, dict] = {
    "BEAT": {},
    "BEAT, ε as printed": {"epsilon": "by episode"},
    "BEAT with commands": {"commands": True},
}
STEPS = 150
"""Steps of the first episode that are kept; those who need longer stay in the last."""


class NamedTypes:
    """Watches BEAT and keeps the most likely type of every player, step by step of her first episode."""

    def __init__(self, learner: BeatLearner) -> None:
        self._learner = learner
        self.first: list[Ints] = []
        self.wrong_until = np.zeros(len(learner.users.log_belief), np.int64)
        """Steps played, over all episodes, until the type named last changed from wrong to right."""
        self._played = np.zeros_like(self.wrong_until)

    def __call__(self, balls: Balls, speed: Ints, moves: Moves) -> None:
        named = self._learner.users.log_belief.argmax(axis=1)
        self._played[moves.rows] += 1
        wrong = named != balls.kind
        self.wrong_until[wrong] = self._played[wrong]
        if (self._played <= STEPS).any() and len(self.first) < STEPS:
            self.first.append(named)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Shares named right by step and type, confusions half-way and at the ends, ratios of sizes, steps needed."""
    setting = Setting(*cell["game"])
    known = known_of(setting, settings["training"], settings["tuning"], seed)
    n_types = known.game.n_types
    kinds = np.arange(n_types).repeat(settings["players"])
    players = Players.drawn(kinds, EPISODES, stream(seed, "C4.13", setting.words))
    learner = learner_of(known, len(kinds), cell["way"], stream(seed, "C4.13", setting.words, cell["way"]))
    watch = NamedTypes(learner)
    first = players_of_first(players)
    played = play_all(known.game, first, learner, known.scale, watch=watch)
    lengths = played.steps[:, 0]
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


def players_of_first(players: Players) -> Players:
    """The players in their first episode alone."""
    return Players(players.kinds, players.sigma[:, :1], players.random[:, :1])


def learner_of(known: Known, n: int, way: str, generator: np.random.Generator) -> BeatLearner:
    """BEAT in one of `WAYS`."""
    asked = WAYS[way]
    commands = known.trained.command_table() if asked.get("commands") else None
    table = known.trained.signal_table()
    return BeatLearner(
        known.value, table, n, epsilon=asked.get("epsilon", 0.0), command_table=commands, seed=generator
    )


def confusion(true: NDArray[np.int64], named: NDArray[np.int64], n_types: int) -> list[list[int]]:
    """How many players of each true type (rows) were taken for each type (columns)."""
    counts = np.zeros((n_types, n_types), int)
    np.add.at(counts, (true, named), 1)
    return counts.tolist()
