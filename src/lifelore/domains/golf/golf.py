"""Golf without knowing how far the hole is: four clubs, one canonical stroke each, seven words for a shot.

A type is a training hole, a policy a club, one episode one shot from the tee. A ball lands at a normal distance
(Table 4.1). The performance is minus the distance between ball and hole; the signal is only the category, one of
seven, of the distance by which the shot fell short or went long.

Thesis: §4.6.1, Table 4.1, Figure 4.3.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtr

from lifelore.core.errors import InputError

CLUBS = ("3-wood", "3-iron", "6-iron", "9-iron")
YARDS = (215.0, 180.0, 150.0, 115.0)
DEVIATIONS = (8.0, 7.2, 6.0, 4.4)
HOLES = (110.0, 150.0, 170.0, 220.0)
EDGES = (-50.0, -20.0, -5.0, 5.0, 20.0, 50.0)
"""Where one category ends and the next begins, in yards beyond the hole; an error on an edge is the nearer."""
CATEGORIES = ("short by > 50", "short by 20–50", "short by 5–20", "within 5", "over by 5–20", "over by 20–50",
              "over by > 50")  # fmt: skip
SHOTS = 3
"""How many shots the task allows, fewer than there are clubs."""


@dataclass(frozen=True)
class Golf:
    """The golf domain of §4.6.1: clubs and training holes as numbers.

    Parameters
    ----------
    yards, deviations : (n_clubs,) float
        Mean and standard deviation of where a ball lands, yards from the tee.
    holes : (n_holes,) float
        Distances of the training holes, yards.

    Raises
    ------
    InputError
        No club or hole, clubs without a deviation of their own, or a deviation that is not positive.

    Examples
    --------
    >>> golf = Golf()
    >>> golf.mean.round(1)[:, 2].tolist()  # the 6-iron on the four holes
    [-40.0, -4.8, -20.0, -70.0]
    >>> golf.category_probs.shape
    (4, 4, 7)
    """

    yards: tuple[float, ...] = YARDS
    deviations: tuple[float, ...] = DEVIATIONS
    holes: tuple[float, ...] = HOLES

    def __post_init__(self) -> None:
        if not self.yards or not self.holes or len(self.yards) != len(self.deviations):
            raise InputError(
                "yards, deviations and holes must name at least one club and hole, and a deviation a club; got "
                f"{len(self.yards)} yards, {len(self.deviations)} deviations, {len(self.holes)} holes"
            )
        if not all(0 < d < np.inf for d in self.deviations):
            raise InputError(f"deviations must be positive, got {self.deviations}")

    @property
    def n_clubs(self) -> int:
        """Number of clubs."""
        return len(self.yards)

    @cached_property
    def mean(self) -> NDArray[np.float64]:
        """Expected performance of each club on each training hole, (n_holes, n_clubs) yards, at most 0."""
        return self.mean_at(self.holes)

    @cached_property
    def deviation(self) -> NDArray[np.float64]:
        """Standard deviation of the performance, (n_holes, n_clubs) yards."""
        return self.deviation_at(self.holes)

    @cached_property
    def category_probs(self) -> NDArray[np.float64]:
        """Probability of each category by hole and club, (n_holes, n_clubs, 7); rows sum to 1."""
        return self.category_probs_at(self.holes)

    def mean_at(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Expected performance on holes at `distance` (...), (..., n_clubs): minus a folded normal's mean."""
        short, deviation = self._short(distance)
        z = short / deviation
        density = np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi)
        return -(2 * deviation * density + short * (2 * ndtr(z) - 1))

    def deviation_at(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Standard deviation of the performance on holes at `distance` (...), (..., n_clubs)."""
        short, deviation = self._short(distance)
        return np.sqrt(np.maximum(short**2 + deviation**2 - self.mean_at(distance) ** 2, 0.0))

    def category_probs_at(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Probability of each category on holes at `distance` (...), (..., n_clubs, 7)."""
        short, deviation = self._short(distance)
        below = ndtr((short[..., None] + np.array(EDGES)) / deviation[..., None])
        above = ndtr(-(short[..., None] + np.array(EDGES)) / deviation[..., None])
        # Of the two tails the smaller is exact; differences of the larger lose it.
        between = np.where(below[..., 1:] < 0.5, np.diff(below, axis=-1), -np.diff(above, axis=-1))
        return np.concatenate([below[..., :1], between, above[..., -1:]], axis=-1)

    def sample_errors(
        self, generator: np.random.Generator, distance: ArrayLike, club: ArrayLike
    ) -> NDArray[np.float64]:
        """How far beyond the hole one shot lands, yards; `distance` (...) and `club` (...) broadcast."""
        distance, club = np.broadcast_arrays(np.asarray(distance, float), np.asarray(club))
        mean, deviation = np.array(self.yards)[club], np.array(self.deviations)[club]
        return mean + deviation * generator.standard_normal(mean.shape) - distance

    def draw_holes(
        self, generator: np.random.Generator, n: int, nearest: float = 120.0, farthest: float = 220.0
    ) -> NDArray[np.float64]:
        """Distances of `n` unknown holes, (n,) yards, uniform."""
        return generator.uniform(nearest, farthest, size=n)

    def _short(self, distance: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """By how much each club's mean falls short of the hole, and its deviation; (..., n_clubs) both."""
        short = np.asarray(distance, float)[..., None] - np.array(self.yards)
        return short, np.broadcast_to(np.array(self.deviations), short.shape)


def category_of(error: ArrayLike) -> NDArray[np.int64]:
    """The category, 0 (far too short) to 6 (far too long), of errors (...) in yards beyond the hole."""
    error = np.asarray(error, float)
    short = np.searchsorted(EDGES, error, side="right")
    # On an edge the nearer category: from above where the ball fell short, from below where it went long.
    return np.where(error > 0, np.searchsorted(EDGES, error, side="left"), short).astype(np.int64)
