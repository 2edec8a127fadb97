"""Golf played by rules that know four training holes, for C4.1 and C4.2.

Rules know the performance and the categories of each club on each training hole, exactly or learnt from `samples`
shots a pair. They never know the distance of the hole, the clubs' yardage, or an error in yards.

Holes come in groups of the thesis's size. A group has holes and luck of its own, and where models are learnt a
library of its own; all rules and models play the same holes with the same luck.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.golf.golf import CATEGORIES, CLUBS, DEVIATIONS, YARDS, Golf, category_of
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.selection import SelectionRule
from lifelore.interaction.signals.category_signal import CategorySignal
from reproduction.chapter4.reuse.many_tasks import EXACT, UNCERTAIN, play_doubting, play_rule

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


def library_of(settings: Mapping, model: str, seed: int, group: int) -> PolicyLibrary:
    """A group's library; of the exact model the same for all."""
    if model == EXACT:
        return exact_library()
    generator = stream(seed, "training shots", group)
    return learnt_library(generator, settings["samples"], settings["pseudo_count"])


def play_holes(
    rule: SelectionRule,
    library: PolicyLibrary,
    distance: Array,
    luck: Array,
    seed: int,
    first: int | None = None,
    model: str = EXACT,
) -> Round:
    """Play holes at `distance` (n_holes,) with `luck` (n_holes, n_shots), standard normal.

    A golfer who doubts its models learns from the error in yards beside the category.
    """
    n_holes, n_shots = luck.shape
    error = np.empty((n_holes, n_shots))

    def signals(shot: int, clubs: NDArray[np.int64]) -> NDArray[np.int64]:
        error[:, shot] = errors_of(clubs, distance, luck[:, shot])
        return category_of(error[:, shot])

    def outcomes(shot: int, clubs: NDArray[np.int64]) -> Array:
        return -np.abs(error[:, shot])

    stream_of = (seed, "golfer", rule.name)
    if model == UNCERTAIN:
        played = play_doubting(rule, library, signals, n_holes, n_shots, stream_of, outcomes=outcomes, first=first)
    else:
        played = play_rule(rule, library, signals, n_holes, n_shots, stream(*stream_of), first)
    return Round(played.policies, error, played.entropy)


def errors_of(clubs: NDArray[np.int64], distance: Array, luck: Array) -> Array:
    """Yards beyond the hole of one shot each; all (n_holes,)."""
    return np.array(YARDS)[clubs] + np.array(DEVIATIONS)[clubs] * luck - distance


def draw_group(settings: Mapping, seed: int, group: int) -> tuple[Array, Array]:
    """Distances (n_holes,) and luck (n_holes, n_shots) of one group."""
    generator = stream(seed, "holes", group)
    distance = Golf().draw_holes(generator, settings["holes"], *settings["yards"])
    return distance, generator.standard_normal((settings["holes"], settings["shots"]))
