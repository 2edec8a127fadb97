"""The ball game: a ball is steered past obstacles to a goal, at a speed that somebody else chooses.

A player, whose type is the size b of the ball, commands one of four directions at every step; the ball moves by
the speed in force, with probability b/2 % another way. Then it is pushed sideways by a rounded normal number
whose deviation σ is drawn for the episode. A step in which it would go into an obstacle counts as a collision;
what becomes of such a move the thesis does not say: the ball slides up to the obstacle, or, in a variant of the
game, the move is not made and the ball stays (`BLOCKED`). Places are whole numbers. The game is over when the
ball's centre comes into the goal; the loss is the normalised time plus the normalised number of collisions.
Thesis: §4.8.5.1.

`step` is the one definition: the batched kernel (`advance`) and the environment both call it.
"""

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError
from lifelore.domains.ball_game.layouts import SIDE, Layout, layout_of, obstacle_points
from lifelore.domains.ball_game.paths import CARE, CELL, cost_to_go

SIZES = (2, 5, 10, 20, 40, 60)
"""Ball sizes b: the types."""
SPEEDS = (30, 40, 50, 60, 70)
"""Units a step: the action sets."""
HEADINGS = ("north", "south", "east", "west")
MOVES = np.array([[0, -1], [0, 1], [1, 0], [-1, 0]], np.int64)
"""(dx, dy) of each heading; y grows southwards."""
SIGMA_RANGE = (0.3, 8.0)
MAX_STEPS = 400
BLOCKED = ("slides", "stays")
"""What becomes of a ball whose move, or push, would touch an obstacle: it goes as far as it can, or nowhere."""


class Field(NamedTuple):
    """What kernels need to know of a game.

    clearance : (SIDE + 1, SIDE + 1) float32
        Distance from each place to the nearest obstacle or border, [y, x].
    cost : (n_types, n, n) float32
        What the way from each cell of `CELL` units costs the player, by ball size; infinite where there is none.
    radius, slip : (n_types,) float64
        Radius of the ball, and the probability that it goes another way.
    speeds : (n_speeds,) int64
    goal : (4,) int64
        Left, top, right, bottom.
    start : (2,) int64
    stays : bool
        Whether a move that would touch an obstacle is not made, see `BLOCKED`.
    """

    clearance: NDArray[np.float32]
    cost: NDArray[np.float32]
    radius: NDArray[np.float64]
    slip: NDArray[np.float64]
    speeds: NDArray[np.int64]
    goal: NDArray[np.int64]
    start: NDArray[np.int64]
    stays: bool


@dataclass(frozen=True)
class BallGame:
    """A layout with its ball sizes and speeds.

    Parameters
    ----------
    layout : Layout
    radius_share : float
        Radius of the ball as a share of its size b: 0.5, or 1 where b is read as the radius.
    care : float
        How much the player keeps away from walls, see `cost_to_go`.
    blocked : str
        What becomes of a ball whose way is blocked, see `BLOCKED`.
    field : Field
    """

    layout: Layout
    radius_share: float
    care: float
    blocked: str
    field: Field

    sizes, speeds = SIZES, SPEEDS
    n_types, n_speeds = len(SIZES), len(SPEEDS)


@dataclass(frozen=True)
class LossScale:
    """What a loss is divided by: ``steps / time + collisions / hits``.

    The thesis says "normalised" and no more. 400 steps and 20 collisions by default; `from_episodes` takes the
    largest seen in training.
    """

    time: float = 400.0
    hits: float = 20.0

    def __post_init__(self) -> None:
        if not (0 < self.time < np.inf and 0 < self.hits < np.inf):
            raise InputError(f"time and hits must be positive and finite, got {self.time} and {self.hits}")

    @classmethod
    def from_episodes(cls, steps: ArrayLike, collisions: ArrayLike) -> "LossScale":
        """By the global maxima of episodes played."""
        return cls(float(np.max(steps)), float(max(np.max(collisions), 1)))

    def loss(self, steps: ArrayLike, collisions: ArrayLike) -> NDArray[np.float64]:
        """Loss of episodes."""
        return np.asarray(steps, np.float64) / self.time + np.asarray(collisions, np.float64) / self.hits


@cache
def ball_game(
    layout: str | Layout = "s-maze 160",
    radius_share: float = 0.5,
    care: float = CARE,
    blocked: str = "slides",
) -> BallGame:
    """A game, its distances and ways worked out once.

    Raises
    ------
    InputError
        A share or care out of range, `blocked` unknown, or a ball that cannot get from the start to the goal.
    """
    from scipy.ndimage import distance_transform_edt

    if not 0 < radius_share <= 1:
        raise InputError(f"radius_share must lie in (0, 1], got {radius_share}")
    if not 0 <= care < np.inf:
        raise InputError(f"care must be finite and at least 0, got {care}")
    if blocked not in BLOCKED:
        raise InputError(f"blocked must be one of {', '.join(BLOCKED)}, got {blocked!r}")
    layout = layout if isinstance(layout, Layout) else layout_of(layout)
    clearance = np.asarray(distance_transform_edt(~obstacle_points(layout)), np.float32)
    radius = radius_share * np.asarray(SIZES, np.float64)
    cost = np.stack([cost_to_go(clearance, float(r), layout.goal, care) for r in radius])
    x, y = layout.start
    for size, r, way in zip(SIZES, radius, cost, strict=True):
        if clearance[y, x] <= r or not np.isfinite(way[_cell(y), _cell(x)]):
            raise InputError(
                f"a ball of size {size} and radius {r:g} cannot get from the start to the goal of "
                f"'{layout.name}'; use a wider layout or a smaller radius_share"
            )
    field = Field(
        clearance, cost, radius, np.asarray(SIZES, np.float64) / 200.0,
        np.asarray(SPEEDS, np.int64), np.asarray(layout.goal, np.int64), np.asarray(layout.start, np.int64),
        blocked == "stays",
    )  # fmt: skip
    return BallGame(layout, float(radius_share), float(care), blocked, field)


def _cell(place: int) -> int:
    return (place + CELL // 2) // CELL


@kernel
def slide(clearance, radius, x, y, dx, dy, distance):
    """How far a ball can go along an axis without touching anything, at most `distance`."""
    moved, free = 0, True
    while free and moved < distance:
        # No place nearer than the clearance less the radius can touch. Unsigned, because Numba checks every signed
        # index for counting from the end.
        room = int(np.ceil(clearance[np.uint64(y + dy * moved), np.uint64(x + dx * moved)] - radius)) - 1
        free = clearance[y + dy * (moved + 1), x + dx * (moved + 1)] > radius
        if free:
            moved += min(max(room, 1), distance - moved)
    return moved


@kernel
def crosses(goal, x0, y0, x1, y1):
    """Whether a way along an axis touches the goal."""
    left, top, right, bottom = goal[0], goal[1], goal[2], goal[3]
    return max(x0, x1) >= left and min(x0, x1) <= right and max(y0, y1) >= top and min(y0, y1) <= bottom


@kernel
def travel(clearance, goal, stays, radius, x, y, dx, dy, distance):
    """Where a ball gets that is to go a distance along an axis, and whether something is in its way.

    A ball that stays where it is blocked still goes on where its centre comes into the goal first: the game is
    over there.

    Returns
    -------
    x, y : int
    touched : bool
    """
    moved = slide(clearance, radius, x, y, dx, dy, distance)
    touched, over = moved < distance, crosses(goal, x, y, x + dx * moved, y + dy * moved)
    if touched and stays and not over:
        moved = 0
    return x + dx * moved, y + dy * moved, touched


@kernel
def step(field, kind, x, y, heading, distance, sigma, u, v, w):
    """One move.

    Parameters
    ----------
    field : Field
    kind : int
        Number of the ball's size.
    x, y : int
        Place of its centre.
    heading : int
        Commanded, see `HEADINGS`.
    distance : int
        The speed in force.
    sigma : float
        Deviation of the push sideways.
    u, v, w : float
        Uniform numbers in [0, 1): whether and where it slips, and two for the push.

    Returns
    -------
    x, y : int
    hit : bool
        Whether something was in its way.
    reached : bool
        Whether it came to the goal.
    """
    clearance, _, radii, slips, _, goal, _, stays = field
    slip, radius = slips[kind], radii[kind]
    if u < slip:
        heading = (heading + 1 + min(int(3.0 * u / slip), 2)) % 4
    dx, dy = MOVES[heading, 0], MOVES[heading, 1]
    x1, y1, blocked = travel(clearance, goal, stays, radius, x, y, dx, dy, distance)
    push = int(np.rint(sigma * np.sqrt(-2.0 * np.log(1.0 - v)) * np.cos(2.0 * np.pi * w)))
    sign = 1 if push > 0 else -1
    x2, y2, pressed = travel(clearance, goal, stays, radius, x1, y1, dy * sign, dx * sign, abs(push))
    reached = crosses(goal, x, y, x1, y1) | crosses(goal, x1, y1, x2, y2)
    return x2, y2, blocked | pressed, reached


def draw_sigma(generator: np.random.Generator, size: int | tuple[int, ...] | None = None):
    """Deviation of the push for episodes, uniform over the thesis's range [0.3, 8]."""
    return generator.uniform(*SIGMA_RANGE, size=size)


def check_place(game: BallGame, kind: int, x: int, y: int) -> None:
    """Whether a ball of a size fits at a place.

    Raises
    ------
    InputError
        It does not.
    """
    inside = 0 <= x <= SIDE and 0 <= y <= SIDE
    if not inside or game.field.clearance[y, x] <= game.field.radius[kind]:
        raise InputError(f"place must be free for a ball of size {game.sizes[kind]}, got ({x}, {y})")
