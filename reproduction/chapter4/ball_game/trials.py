"""Trials of §4.8.5.1: BEAT, EXP-3 and constant speeds with every population of players, in one game a cell.

A trial is five episodes of a player whose type is drawn from her population; all methods meet the same players and
the same noise. Claims C4.12, C4.13 and C4.15 read the same trials.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, BallGame, LossScale
from lifelore.interaction.library.policy_library import PolicyLibrary
from reproduction.chapter4.ball_game import play
from reproduction.chapter4.ball_game.games import N_TYPES, Game, choices
from reproduction.chapter4.ball_game.learners import BeatLearner, PrintedExp3, exp3_by_episode
from reproduction.chapter4.ball_game.play import Floats, Players, play_all

EPISODES = 5
STEPS = 100
"""Steps of the first episode whose named types are recorded."""
SHARED = ("games", "normalisations", "runs", "grid_runs", "training")
"""Settings that `run_cell` and `cells` read."""
POPULATIONS = tuple(p for size in range(1, N_TYPES + 1) for p in combinations(range(N_TYPES), size))
"""The 63 sets of types, smaller ones first."""
STATIC, HINDSIGHT, ORACLE = "static", "static in hindsight", "best speed of each type"
EXP3, EXP3_EPISODE = "EXP-3", "EXP-3, an episode a pull"
BEAT, BEAT_STEP, BEAT_TOLD, BEAT_OURS = "BEAT", "BEAT, ε = 1/n", "BEAT, told the population", "BEAT, ε = 0"
BEATS = {BEAT: "by episode", BEAT_STEP: "1/n", BEAT_TOLD: "by episode", BEAT_OURS: 0.0}
"""ε of each BEAT: 0.5 less 0.1 an episode as in the thesis's experiments, 1/n as in its text, and ours."""
OPEN = {
    "ε": {"1/n": {BEAT: BEAT_STEP}},
    "prior": {"types of the population": {BEAT: BEAT_TOLD}},
    "EXP-3's pull": {"an episode": {EXP3: EXP3_EPISODE}},
    "static speed": {"best in hindsight": {STATIC: HINDSIGHT}},
}
"""Choices that the default game tries one at a time: their value, and the method that takes another's place."""

Numbers = Callable[[Mapping, Mapping[str, str]], dict[str, Estimate]]
"""``numbers(result, instead)``: estimates from a cell's result, with some methods in place of others."""


class Known(NamedTuple):
    """Knowledge from training that the learners of a game use.

    worst : float
        Largest loss seen, which pays EXP-3 nothing.
    horizon : int
        Steps of all episodes of a player, on average.
    """

    game: BallGame
    library: PolicyLibrary
    scale: LossScale
    worst: float
    horizon: int


@cache
def known_of(words: str, normalisation: str, training: int, seed: int) -> Known:
    """Train on a game: `training` episodes of each type at each speed."""
    game = Game.parsed(words).game
    trained = play.train(game, training, seed)
    scale = trained.scale(normalisation)
    worst = float(scale.loss(trained.steps, trained.hits).max())
    horizon = round(EPISODES * float(trained.steps.mean()))
    return Known(game, trained.library(scale), scale, worst, horizon)


def cells(settings: Mapping) -> list[dict]:
    """A game and a normalisation each; the default, which has `runs` a population and all variants, first."""
    found = product(settings["games"], settings["normalisations"])
    return [
        {"game": game, "normalisation": own, "runs": settings["grid_runs" if place else "runs"], "all": not place}
        for place, (game, own) in enumerate(found)
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Losses of a run's episodes by method, means over the populations of a size, and the types that BEAT named.

    Returns
    -------
    dict
        ``losses``: method → (sizes of the population, runs, episodes). ``half`` and ``ratio``: variant of BEAT →
        players named each type half-way through the first episode by true type (n_types, n_types), and mean size
        named over true size (n_types, STEPS). ``half_of_first``: half of the median length of the first episode.
    """
    known = known_of(cell["game"], cell["normalisation"], settings["training"], seed)
    name = f"trials {cell['game']}, {cell['normalisation']}"
    players = players_of(cell["runs"], stream(seed, name, "players"))
    by_speed = play.losses_by_speed(known.game, players, known.scale)
    found, halves, ratios, half = _constant_speeds(known, players, by_speed), {}, {}, 0.0
    n = len(players.kinds)
    for method in BEATS if cell["all"] else (BEAT,):
        prior = _population_prior(n) if method == BEAT_TOLD else None
        random = stream(seed, name, method)
        learner = BeatLearner(known.library, n, prior=prior, epsilon=BEATS[method], seed=random)
        played = play_all(known.game, players, learner, known.scale)
        found[method], lengths = known.scale.loss(*played), played.steps[:, 0]
        halves[method] = confusion(players.kinds, learner.named_halfway(lengths)).tolist()
        ratios[method] = _ratios(players.kinds, learner.named).round(4).tolist()
        half = half or float(np.median(lengths)) / 2
    exp3 = PrintedExp3(n, known.game.n_speeds, known.worst, known.horizon, stream(seed, name, EXP3))
    found[EXP3] = known.scale.loss(*play_all(known.game, players, exp3, known.scale))
    found[EXP3_EPISODE] = exp3_by_episode(by_speed, known.worst, stream(seed, name, EXP3_EPISODE))
    losses = {method: by_size(lost).round(5).tolist() for method, lost in found.items()}
    return {**cell, "losses": losses, "half": halves, "ratio": ratios, "half_of_first": half}


def players_of(runs: int, generator: np.random.Generator) -> Players:
    """`runs` players of each population, one population after another, its types as often as they can be."""
    kinds = [generator.permutation(np.resize(population, runs)) for population in POPULATIONS]
    return Players.drawn(np.concatenate(kinds), EPISODES, generator)


def by_size(lost: Floats) -> Floats:
    """Losses (n_players, episodes) as means over populations of a size, (sizes, runs, episodes)."""
    of_population = lost.reshape(len(POPULATIONS), -1, lost.shape[1])
    sizes = np.array([len(population) for population in POPULATIONS])
    return np.array([of_population[sizes == size].mean(axis=0) for size in range(1, N_TYPES + 1)])


def _constant_speeds(known: Known, players: Players, by_speed: Floats) -> dict[str, Floats]:
    """The population's best speed in training, its best as it turns out, and each type's best."""
    runs, value = len(players.kinds) // len(POPULATIONS), known.library.performance.mean
    expected = [value[list(population)].mean(axis=0).argmax() for population in POPULATIONS]
    turned_out = by_speed.reshape(len(POPULATIONS), -1, known.game.n_speeds).mean(axis=1).argmin(axis=1)
    speeds = {
        STATIC: np.repeat(expected, runs),
        HINDSIGHT: np.repeat(turned_out, runs),
        ORACLE: value.argmax(axis=1)[players.kinds],
    }
    return {method: by_speed[np.arange(len(by_speed)), :, speed] for method, speed in speeds.items()}


def _population_prior(n: int) -> Floats:
    """For each player the uniform prior over the types of her population, (n, n_types)."""
    prior = np.array([[kind in population for kind in range(N_TYPES)] for population in POPULATIONS], float)
    return (prior / prior.sum(axis=1, keepdims=True)).repeat(n // len(POPULATIONS), axis=0)


def confusion(true: NDArray, named: NDArray) -> NDArray[np.int64]:
    """How many players of each true type (rows) were taken for each type (columns)."""
    counts = np.zeros((N_TYPES, N_TYPES), int)
    np.add.at(counts, (true, named), 1)
    return counts


def _ratios(kinds: NDArray[np.int64], named: Sequence[NDArray[np.int8]]) -> Floats:
    """Size named over true size, the mean over players of a type, step by step: (n_types, STEPS)."""
    steps = np.array([named[min(step, len(named) - 1)] for step in range(STEPS)])
    sizes = np.array(SIZES, float)
    return np.array([sizes[steps[:, kinds == kind]].mean(axis=1) / sizes[kind] for kind in range(N_TYPES)])


def readings_by(numbers: Numbers) -> Callable[[Mapping, Sequence[Mapping]], Iterator[tuple[dict, dict]]]:
    """The function ``readings`` of a claim: those of its `numbers` in every game and choice."""
    return lambda settings, results: readings_of(results, numbers)


def readings_of(results: Sequence[Mapping], numbers: Numbers) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Every game and normalisation, then the default with each choice of `OPEN` made otherwise."""
    default = dict.fromkeys(OPEN, "default")
    for result in results:
        yield choices(result["game"], result["normalisation"]) | default, numbers(result, {})
    first = results[0]
    for choice, values in OPEN.items():
        for value, instead in values.items():
            reading = choices(first["game"], first["normalisation"]) | default | {choice: value}
            yield reading, numbers(first, instead)
