"""BEAT, EXP-3 and constant speeds in all populations of ball game players: the runs behind claim C4.12.

Thesis: §4.8.5.1.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import BallGame, LossScale
from lifelore.experiments.chapter4.ball_game_learners import (
    BeatLearner,
    PrintedExp3,
    exp3_by_episode,
    tuned_gamma,
)
from lifelore.experiments.chapter4.ball_game_play import (
    Floats,
    Learner,
    Players,
    Trained,
    losses_by_speed,
    play_all,
    populations,
    train,
)
from lifelore.experiments.chapter4.ball_game_settings import Setting
from lifelore.interaction.adaptation.beat import Exploration

EPISODES = 5
GAMMAS = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0]
BEATS: dict[str, dict] = {
    "BEAT": {},
    "BEAT, ε as printed": {"epsilon": "by episode"},
    "BEAT, ε = 1/n": {"epsilon": "1/n"},
    "BEAT, told the population": {"told": True},
}
"""Ways of BEAT: ε is 0 and the prior that of all six types unless said otherwise."""
HINDSIGHT = "best speed in hindsight"
STATIC, ORACLE = "best static speed", "best speed of each type"
PRINTED_EXP3, TUNED_EXP3 = "EXP-3 as printed", "EXP-3 tuned"
METHODS = (STATIC, HINDSIGHT, ORACLE, *BEATS, PRINTED_EXP3, TUNED_EXP3)


class Known(NamedTuple):
    """What training leaves for the learners of one game.

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
    n, table = len(crowd.population), known.trained.signal_table()
    for method, way in BEATS.items():
        prior = _told(crowd, known.game.n_types) if way.get("told") else None
        yield method, beat(known, n, stream(seed, name, method), way.get("epsilon", 0.0), prior, table)
    generator = stream(seed, name, PRINTED_EXP3)
    yield PRINTED_EXP3, PrintedExp3(n, known.game.n_speeds, known.worst, known.horizon, generator)


def beat(
    known: Known,
    n_players: int,
    generator: np.random.Generator,
    epsilon: Exploration = 0.0,
    prior: Floats | None = None,
    table: Floats | None = None,
) -> BeatLearner:
    """BEAT with what is known of a game."""
    table = known.trained.signal_table() if table is None else table
    return BeatLearner(known.value, table, n_players, prior=prior, epsilon=epsilon, seed=generator)


def _told(crowd: Crowd, n_types: int) -> Floats:
    """For each player the uniform prior over the types of her population, (n, n_types)."""
    prior = np.array([[t in p for t in range(n_types)] for p in crowd.members], float)
    return (prior / prior.sum(axis=1, keepdims=True))[crowd.population]


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
