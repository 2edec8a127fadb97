"""BEAT, EXP-3 and constant speeds on crowds of ball game players, and the types that BEAT names.

Thesis: §4.8.5.1.
"""

from functools import cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import BallGame, LossScale
from lifelore.domains.ball_game.simulated_player import Balls
from reproduction.chapter4.ball_game import play
from reproduction.chapter4.ball_game.games import Setting
from reproduction.chapter4.ball_game.learners import BeatLearner, PrintedExp3, exp3_by_episode, tuned_gamma
from reproduction.chapter4.ball_game.play import Floats, Ints, Learner, Moves, Players, play_all

EPISODES = 5
GAMMAS = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0]
BEAT, BEAT_PRINTED, BEAT_INFORMED = "BEAT", "BEAT, ε as printed", "BEAT, told the population"
BEATS: dict[str, dict] = {
    BEAT: {},
    BEAT_PRINTED: {"epsilon": "by episode"},
    "BEAT, ε = 1/n": {"epsilon": "1/n"},
    BEAT_INFORMED: {},
}
"""Variants of BEAT; by default ε is 0 and the prior is uniform over all six types, or those of the population."""
HINDSIGHT = "best speed in hindsight"
STATIC, ORACLE = "best static speed", "best speed of each type"
PRINTED_EXP3, TUNED_EXP3 = "EXP-3 as printed", "EXP-3 tuned"
METHODS = (STATIC, HINDSIGHT, ORACLE, *BEATS, PRINTED_EXP3, TUNED_EXP3)


class Known(NamedTuple):
    """Knowledge from training that the learners of one game use.

    worst : float
        Largest loss seen, which pays EXP-3 nothing.
    horizon : int
        Steps of all episodes of a player, on average.
    gamma : float
        Of the tuned EXP-3.
    """

    game: BallGame
    trained: play.Trained
    scale: LossScale
    value: Floats
    worst: float
    horizon: int
    gamma: float

    def losses(self, players: Players, learner: Learner, **options) -> Floats:
        """Losses (n, episodes) of the players' episodes; `options` of `play_all`."""
        return self.scale.loss(*play_all(self.game, players, learner, self.scale, **options))


@cache
def known_of(setting: Setting, training: int, tuning: int, seed: int) -> Known:
    """Train on a game: `training` episodes a pair, and `tuning` players a type for EXP-3's γ."""
    game = setting.game
    trained = play.train(game, training, seed)
    scale = trained.scale(setting.normalisation)
    worst = float(scale.loss(trained.steps, trained.hits).max())
    generator = stream(seed, "ball game", "tuning", setting.words)
    players = Players.drawn(np.arange(game.n_types).repeat(tuning), EPISODES, generator)
    gamma = tuned_gamma(play.losses_by_speed(game, players, scale), GAMMAS, worst, generator)
    horizon = round(EPISODES * float(trained.steps.mean()))
    return Known(game, trained, scale, trained.value(scale), worst, horizon, gamma)


class Crowd(NamedTuple):
    """Players of several populations of one size, one population after another.

    population : (n,) int64
        Number of each player's population.
    members : tuple of tuple of int
        Types of each population; every type is played as often.
    """

    players: Players
    population: NDArray[np.int64]
    members: tuple[tuple[int, ...], ...]


def crowd_of(diversity: int, n_types: int, runs: int, generator: np.random.Generator) -> Crowd:
    """At least `runs` players of each population of `diversity` types."""
    members = tuple(p for p in play.populations(n_types) if len(p) == diversity)
    each = -(-runs // diversity)
    kinds = np.concatenate([np.repeat(p, each) for p in members])
    population = np.arange(len(members)).repeat(each * diversity)
    return Crowd(Players.drawn(kinds, EPISODES, generator), population, members)


def run_methods(known: Known, crowd: Crowd, seed: int, name: str) -> dict[str, Floats]:
    """Losses of every player's episodes, (n, EPISODES), by method; all face the same noise."""
    losses, n = play.losses_by_speed(known.game, crowd.players, known.scale), len(crowd.population)
    found = _constant_speeds(known, crowd, losses)
    for method, variant in BEATS.items():
        prior = _population_prior(crowd, known.game.n_types) if method == BEAT_INFORMED else None
        learner = beat_learner(known, n, stream(seed, name, method), variant, prior)
        found[method] = known.losses(crowd.players, learner)
    generator = stream(seed, name, PRINTED_EXP3)
    exp3 = PrintedExp3(n, known.game.n_speeds, known.worst, known.horizon, generator)
    found[PRINTED_EXP3] = known.losses(crowd.players, exp3)
    found[TUNED_EXP3] = exp3_by_episode(losses, known.gamma, known.worst, stream(seed, name, TUNED_EXP3))
    return found


def _constant_speeds(known: Known, crowd: Crowd, losses: Floats) -> dict[str, Floats]:
    """The population's best speed in training, its best as it turns out, and each type's best."""
    expected = [known.value[list(p)].mean(axis=0).argmax() for p in crowd.members]
    mean = losses.mean(axis=1)
    turned_out = [mean[crowd.population == i].mean(axis=0).argmin() for i in range(len(crowd.members))]
    speeds = {
        STATIC: np.array(expected)[crowd.population],
        HINDSIGHT: np.array(turned_out)[crowd.population],
        ORACLE: known.value.argmax(axis=1)[crowd.players.kinds],
    }
    return {method: losses[np.arange(len(losses)), :, speed] for method, speed in speeds.items()}


def beat_learner(
    known: Known, n_players: int, generator: np.random.Generator, variant: dict, prior: Floats | None = None
) -> BeatLearner:
    """BEAT for players of a trained game; `variant` may set ``epsilon`` and ``commands`` (a second signal)."""
    return BeatLearner(
        known.value, known.trained.signal_table(), n_players, prior=prior, epsilon=variant.get("epsilon", 0.0),
        command_table=known.trained.command_table() if variant.get("commands") else None, seed=generator,
    )  # fmt: skip


def _population_prior(crowd: Crowd, n_types: int) -> Floats:
    """For each player the uniform prior over the types of her population, (n, n_types)."""
    prior = np.array([[t in p for t in range(n_types)] for p in crowd.members], float)
    return (prior / prior.sum(axis=1, keepdims=True))[crowd.population]


class NamedTypes:
    """Watches BEAT and records the most likely type of every player, step by step of her first episode.

    Attributes
    ----------
    first : list of (n,) int64
        The most likely types after each of the first `STEPS` steps.
    wrong_until : (n,) int64
        Steps played, over all episodes, until the named type last changed from wrong to right.
    """

    STEPS: ClassVar[int] = 150
    """Steps of the first episode that are recorded; players who need longer stay in the last."""

    def __init__(self, learner: BeatLearner) -> None:
        self._learner = learner
        self.first: list[Ints] = []
        self.wrong_until = np.zeros(len(learner.users.log_belief), np.int64)
        self._played = np.zeros_like(self.wrong_until)

    @property
    def named(self) -> Ints:
        """The type of each player that is most likely now, (n,)."""
        return self._learner.users.log_belief.argmax(axis=1)

    def halfway(self, lengths: Ints) -> Ints:
        """The most likely type of each player half-way through her first episode of `lengths` steps, (n,)."""
        return np.array(self.first)[np.minimum(-(-lengths // 2), len(self.first)) - 1, np.arange(len(lengths))]

    def steps_needed(self, kinds: Ints) -> Ints:
        """`wrong_until`, and -1 of players who are named wrong now."""
        return np.where(self.named == kinds, self.wrong_until, -1)

    def __call__(self, balls: Balls, speed: Ints, moves: Moves) -> None:
        named = self.named
        self._played[moves.rows] += 1
        wrong = named != balls.kind
        self.wrong_until[wrong] = self._played[wrong]
        if (self._played <= self.STEPS).any() and len(self.first) < self.STEPS:
            self.first.append(named)
