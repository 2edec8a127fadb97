"""Golf played by rules that know four training holes, for C4.1 and C4.2.

Rules know the performance and the categories of each club on each training hole, exactly or learnt from so many
shots a pair. They never know the distance of the hole, the clubs' yardage, or an error in yards.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.golf.golf import CATEGORIES, CLUBS, DEVIATIONS, YARDS, Golf, category_of
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.selection import Greedy
from lifelore.interaction.signals.category_signal import CategorySignal
from reproduction.chapter4.reuse.many_tasks import play_rule

Array = NDArray[np.float64]
WOOD, IRON = CLUBS.index("3-wood"), CLUBS.index("3-iron")


class Round(NamedTuple):
    """Shots at some holes.

    clubs : (n_holes, n_shots) int64
    error : (n_holes, n_shots) float64, yards beyond the hole
    entropy : (n_holes, n_shots + 1) float64, before each shot and after the last
    """

    clubs: NDArray[np.int64]
    error: Array
    entropy: Array


def exact_library() -> PolicyLibrary:
    """The golfer who knows its models exactly: categories as they are, performance as its mean and deviation."""
    golf = Golf()
    signal = CategorySignal(golf.category_probs)
    return PolicyLibrary(GaussianOutcomes(golf.mean, golf.deviation), signal, policies=CLUBS)


def learnt_library(generator: np.random.Generator, samples: int, pseudo_count: float) -> PolicyLibrary:
    """The golfer who has played each club `samples` times on each training hole (§4.4.1)."""
    golf = Golf()
    pairs = np.ones((len(golf.holes), golf.n_clubs, samples))
    errors = golf.sample_errors(
        generator, pairs * np.array(golf.holes)[:, None, None], np.arange(golf.n_clubs)[:, None]
    )
    signal = CategorySignal.from_samples(category_of(errors), len(CATEGORIES), pseudo_count)
    return PolicyLibrary(GaussianOutcomes.from_samples(-np.abs(errors)), signal, policies=CLUBS)


def play_greedily(
    library: PolicyLibrary, distance: Array, luck: Array, generator: np.random.Generator, first: int | None = None
) -> Round:
    """Greedy selection at holes of `distance` (n_holes,) with `luck` (n_holes, n_shots), standard normal.

    `first`, if given, is the club of the first shot; `generator` chooses among equally good clubs.
    """
    n_holes, n_shots = luck.shape
    error = np.empty((n_holes, n_shots))

    def signals(shot: int, clubs: NDArray[np.int64]) -> NDArray[np.int64]:
        error[:, shot] = errors_of(clubs, distance, luck[:, shot])
        return category_of(error[:, shot])

    played = play_rule(Greedy(), library, signals, n_holes, n_shots, generator, first)
    return Round(played.policies, error, played.entropy)


def errors_of(clubs: NDArray[np.int64], distance: Array, luck: Array) -> Array:
    """Yards beyond the hole of one shot each; all (n_holes,)."""
    return np.array(YARDS)[clubs] + np.array(DEVIATIONS)[clubs] * luck - distance


def draw_group(settings: Mapping, seed: int, group: int) -> tuple[Array, Array]:
    """Distances (n_holes,) and luck (n_holes, n_shots) of one group of holes."""
    generator = stream(seed, "holes", group)
    distance = Golf().draw_holes(generator, settings["holes"], *sorted(settings["yards"]))
    return distance, generator.standard_normal((settings["holes"], settings["shots"]))
