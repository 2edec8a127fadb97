"""BEAT, EXP-3 and constant speeds on crowds of ball game players, and the types that BEAT names.

Thesis: §4.8.5.1.
"""

from collections.abc import Iterator
from functools import cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import BallGame, LossScale
from lifelore.domains.ball_game.simulated_player import Balls
from lifelore.experiments.chapter4.ball_game_learners import (
    BeatLearner,
    PrintedExp3,
    exp3_by_episode,
    tuned_gamma,
)
from lifelore.experiments.chapter4.ball_game_play import (
    Floats,
    Ints,
    Learner,
    Moves,
    Players,
    Trained,
    losses_by_speed,
    play_all,
    populations,
    train,
)
from lifelore.experiments.chapter4.ball_game_settings import Setting

EPISODES = 5
GAMMAS = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0]
BEATS: dict[str, dict] = {
    "BEAT": {},
    "BEAT, ε as printed": {"epsilon": "by episode"},
    "BEAT, ε = 1/n": {"epsilon": "1/n"},
    "BEAT, told the population": {"told": True},
}
"""Variants of BEAT; by default ε is 0 and the prior is uniform over all six types."""
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
    trained: Trained
    scale: LossScale
    value: Floats
    worst: float
    horizon: int
    gamma: float


@cache
def known_of(setting: Setting, training: int, tuning: int, seed: int) -> Known:
    """Train on a game: `training` episodes a pair, and `tuning` players a type for EXP-3's γ."""
    game = setting.game
    trained = train(game, training, seed)
    scale = trained.scale(setting.normalisation)
    worst = float(scale.loss(trained.steps, trained.hits).max())
    generator = stream(seed, "ball game", "tuning", setting.words)
    players = Players.drawn(np.arange(game.n_types).repeat(tuning), EPISODES, generator)
    gamma = tuned_gamma(losses_by_speed(game, players, scale), GAMMAS, worst, generator)
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
    members = tuple(p for p in populations(n_types) if len(p) == diversity)
    each = -(-runs // diversity)
    kinds = np.concatenate([np.repeat(p, each) for p in members])
    population = np.arange(len(members)).repeat(each * diversity)
    return Crowd(Players.drawn(kinds, EPISODES, generator), population, members)


def run_methods(known: Known, crowd: Crowd, seed: int, name: str) -> dict[str, Floats]:
    """Losses of every player's episodes, (n, EPISODES), by method; all face the same noise."""
    losses = losses_by_speed(known.game, crowd.players, known.scale)
    found = dict(_without_learning(known, crowd, losses))
    for method, learner in _learners(known, crowd, seed, name):
        found[method] = known.scale.loss(*play_all(known.game, crowd.players, learner, known.scale))
    generator = stream(seed, name, TUNED_EXP3)
    found[TUNED_EXP3] = exp3_by_episode(losses, known.gamma, known.worst, generator)
    return found


def _without_learning(known: Known, crowd: Crowd, losses: Floats) -> Iterator[tuple[str, Floats]]:
    """Constant speeds: the population's best in training, or as it turns out, and each type's best."""
    every = np.arange(len(losses))
    expected = np.array([known.value[list(p)].mean(axis=0).argmax() for p in crowd.members])
    yield STATIC, losses[every, :, expected[crowd.population]]
    mean = losses.mean(axis=1)
    turned_out = [mean[crowd.population == i].mean(axis=0).argmin() for i in range(len(crowd.members))]
    yield HINDSIGHT, losses[every, :, np.array(turned_out)[crowd.population]]
    yield ORACLE, losses[every, :, known.value.argmax(axis=1)[crowd.players.kinds]]


def _learners(known: Known, crowd: Crowd, seed: int, name: str) -> Iterator[tuple[str, Learner]]:
    n = len(crowd.population)
    for method, variant in BEATS.items():
        prior = _population_prior(crowd, known.game.n_types) if variant.get("told") else None
        yield method, beat_learner(known, n, stream(seed, name, method), variant, prior)
    generator = stream(seed, name, PRINTED_EXP3)
    yield PRINTED_EXP3, PrintedExp3(n, known.game.n_speeds, known.worst, known.horizon, generator)


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
    """Watches BEAT and records the most likely type of every player, step by step of her first episode."""

    STEPS: ClassVar[int] = 150
    """Steps of the first episode that are recorded; players who need longer stay in the last."""

    def __init__(self, learner: BeatLearner) -> None:
        self._learner = learner
        self.first: list[Ints] = []
        self.wrong_until = np.zeros(len(learner.users.log_belief), np.int64)
        """Steps played, over all episodes, until the named type last changed from wrong to right."""
        self._played = np.zeros_like(self.wrong_until)

    def __call__(self, balls: Balls, speed: Ints, moves: Moves) -> None:
        named = self._learner.users.log_belief.argmax(axis=1)
        self._played[moves.rows] += 1
        wrong = named != balls.kind
        self.wrong_until[wrong] = self._played[wrong]
        if (self._played <= self.STEPS).any() and len(self.first) < self.STEPS:
            self.first.append(named)
