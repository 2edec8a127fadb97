"""The surveillance reserve: where, around four hills, are the poachers, and to which place does the drone fly?

A type is the target that the poachers are at, a policy the target that the drone surveys, and one episode is one
deployment. A survey pays, and this is also its signal, by the distance d to the poachers:

    200 − 30 d + ψ   from a hilltop if d ≤ 15,
    200 − 20 d + ψ   from another target if d ≤ 3,
    ψ                else,

with ψ ~ N(10, 20). The thesis prints no coordinates, does not say which 16 cells lie around each hill, what
distance it means and whether 20 is a deviation or a variance: all of these are choices here. From a hilltop far
away a survey pays less than nothing, so that it costs the most and tells the most.

Thesis: §4.6.4, Figure 4.9.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError

SIDE = 26
HILLS = ((6, 6), (6, 19), (19, 6), (19, 19))
"""Row and column of the hilltops: as far from the borders as from one another's surroundings."""
REACH = 4
"""How far from its hilltop a target lies at most, in rows or columns."""
BASE = (SIDE - 1, 0)
"""The base station's corner."""
PEAK = 200.0
HILL_FALL, HILL_RANGE = 30.0, 15.0
FALL, RANGE = 20.0, 3.0
NOISE_MEAN = 10.0
NOISES = {"deviation 20": 20.0, "variance 20": 20.0**0.5}
"""Standard deviation of ψ by the reading of the printed 20."""


def _cells(keep) -> tuple[tuple[int, int], ...]:
    span = range(-REACH, REACH + 1)
    return tuple((i, j) for i in span for j in span if (i, j) != (0, 0) and keep(abs(i), abs(j)))


LAYOUTS = {
    "X": _cells(lambda i, j: i == j),
    "diamond": _cells(lambda i, j: i + j == 4),
    "ring": _cells(lambda i, j: max(i, j) == 2),
    "checkerboard": _cells(lambda i, j: i <= 2 and j <= 3 and (i + j) % 2 == 0),
}
"""The 16 targets around a hilltop, as steps in rows and columns: arms along both diagonals, the ring of cells four
moves away, the ring two cells away, or every second cell of a block of 5 × 7."""
METRICS = ("chebyshev", "euclidean")


@dataclass(frozen=True)
class Surveillance:
    """The surveillance domain of §4.6.4: the reserve as numbers.

    Parameters
    ----------
    layout : {"X", "diamond", "ring", "checkerboard"}
        Which 16 cells around each hilltop are targets.
    metric : {"chebyshev", "euclidean"}
        Distance: the larger of rows and columns apart (a diagonal neighbour is at 1), or as the crow flies.
    deviation : float
        Standard deviation of the noise, ≥ 0; `NOISES` has both readings of the thesis's.

    Raises
    ------
    InputError
        A deviation that breaks its rule.
    NotFoundError
        An unknown layout or metric.

    Examples
    --------
    >>> world = Surveillance()
    >>> world.mean.shape, world.mean[1, [0, 1]].tolist()  # poachers at the end of an arm: from its top, and there
    ((68, 68), [90.0, 210.0])
    """

    layout: str = "X"
    metric: str = "chebyshev"
    deviation: float = 20.0

    def __post_init__(self) -> None:
        for key, known in (("layout", tuple(LAYOUTS)), ("metric", METRICS)):
            if getattr(self, key) not in known:
                raise NotFoundError(f"{key} must be one of {', '.join(known)}, got {getattr(self, key)!r}")
        if not (np.isfinite(self.deviation) and self.deviation >= 0):
            raise InputError(f"deviation must be finite and at least 0, got {self.deviation}")

    @cached_property
    def targets(self) -> NDArray[np.int64]:
        """Row and column of each target, (68, 2): by hill, its top first."""
        around = np.array([(0, 0), *LAYOUTS[self.layout]])
        return (np.array(HILLS)[:, None, :] + around).reshape(-1, 2)

    @cached_property
    def is_hilltop(self) -> NDArray[np.bool_]:
        """Whether each target is the top of a hill, (68,)."""
        return np.arange(len(self.targets)) % (len(self.targets) // len(HILLS)) == 0

    @property
    def n_targets(self) -> int:
        """68: as many types as policies."""
        return len(self.targets)

    @cached_property
    def mean(self) -> NDArray[np.float64]:
        """Expected pay by type and policy, (68, 68); each type's own target pays most, and alone."""
        return self.mean_at(self.targets)

    @cached_property
    def cells_near_hills(self) -> NDArray[np.int64]:
        """Row and column of every cell within `REACH` of a hilltop, targets or not, (324, 2)."""
        span = np.arange(-REACH, REACH + 1)
        block = np.stack(np.meshgrid(span, span, indexing="ij"), axis=-1).reshape(-1, 2)
        return (np.array(HILLS)[:, None, :] + block).reshape(-1, 2)

    def distance(self, cells: ArrayLike) -> NDArray[np.float64]:
        """From each of `cells` (..., 2) to each target, (..., 68)."""
        return self._length(np.asarray(cells, float)[..., None, :] - self.targets)

    def mean_at(self, cells: ArrayLike) -> NDArray[np.float64]:
        """Expected pay of each policy with the poachers at each of `cells` (..., 2), (..., 68)."""
        return _expected_pay(self.distance(cells), self.is_hilltop)

    def sample(self, generator: np.random.Generator, cells: ArrayLike, policy: ArrayLike) -> NDArray[np.float64]:
        """Pay of one deployment with the poachers at `cells` (..., 2) under each `policy` (...), broadcast."""
        distance = self._length(np.asarray(cells, float) - self.targets[np.asarray(policy)])
        mean = _expected_pay(distance, self.is_hilltop[np.asarray(policy)])
        return mean + self.deviation * generator.standard_normal(np.shape(mean))

    def training_samples(self, generator: np.random.Generator, n: int) -> NDArray[np.float64]:
        """Pays of `n` deployments for every pair, (68, 68, n): the offline phase of §4.4.1."""
        noise = generator.standard_normal((*self.mean.shape, n))
        return self.mean[..., None] + self.deviation * noise

    def draw_cells(self, generator: np.random.Generator, n: int, seen: bool = True) -> NDArray[np.int64]:
        """Where the poachers are in `n` tasks, (n, 2): at a target, or at any cell near a hill."""
        places = self.targets if seen else self.cells_near_hills
        return places[generator.integers(len(places), size=n)]

    def _length(self, steps: NDArray) -> NDArray[np.float64]:
        """Of steps in rows and columns, (..., 2) to (...)."""
        apart = np.abs(steps)
        return apart.max(axis=-1) if self.metric == "chebyshev" else np.hypot(apart[..., 0], apart[..., 1])


def _expected_pay(distance: NDArray[np.float64], from_hilltop: NDArray[np.bool_]) -> NDArray[np.float64]:
    hilltop = np.where(distance <= HILL_RANGE, PEAK - HILL_FALL * distance, 0.0)
    other = np.where(distance <= RANGE, PEAK - FALL * distance, 0.0)
    return np.where(from_hilltop, hilltop, other) + NOISE_MEAN
