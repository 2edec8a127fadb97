"""Many simulated players of the ball game at once."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform
from lifelore.domains.ball_game.ball_game import MAX_STEPS, BallGame, step
from lifelore.domains.ball_game.simulated_player import choose_heading


class Balls(NamedTuple):
    """Many players, one row each; kernels change the arrays in place.

    kind : (n,) int64, number of the size
    x, y : (n,) int64, place
    sigma : (n,) float64
    random : (n, 2) uint64, state of the random numbers
    steps, hits : (n,) int64, of this episode
    playing : (n,) bool
    """

    kind: NDArray[np.int64]
    x: NDArray[np.int64]
    y: NDArray[np.int64]
    sigma: NDArray[np.float64]
    random: NDArray[np.uint64]
    steps: NDArray[np.int64]
    hits: NDArray[np.int64]
    playing: NDArray[np.bool_]


def new_balls(game: BallGame, kinds: ArrayLike, sigma: ArrayLike, random: NDArray[np.uint64]) -> Balls:
    """Players at the start of an episode.

    Parameters
    ----------
    game : BallGame
    kinds : (n,) int
    sigma : (n,) float
    random : (n, 2) uint64
        As `random_states` draws them; copied.
    """
    kinds = np.asarray(kinds, np.int64)
    n, (x, y), (steps, hits) = len(kinds), game.layout.start, np.zeros((2, len(kinds)), np.int64)
    sigmas, states = np.array(np.broadcast_to(sigma, n), np.float64), np.array(random, np.uint64)
    x, y = np.full(n, x, np.int64), np.full(n, y, np.int64)
    return Balls(kinds, x, y, sigmas, states, steps, hits, np.ones(n, bool))


def random_states(generator: np.random.Generator, shape: int | tuple[int, ...]) -> NDArray[np.uint64]:
    """Kernel states ``(*shape, 2)``, never all zero."""
    shape = (shape,) if isinstance(shape, int) else shape
    states = generator.integers(0, 2**64, size=(*shape, 2), dtype=np.uint64)
    states[..., 0] |= np.uint64(1)
    return states


@kernel
def advance(field, balls, speed, heading, before):
    """One step of everybody who is playing.

    Parameters
    ----------
    field : Field
    balls : Balls
        Changed in place; `playing` becomes false at the goal or after `MAX_STEPS`.
    speed : (n,) int64
        Number of the speed in force for each.
    heading : (n,) int64
        Written: what each commanded; -1 for those who do not play.
    before : (n, 2) int64
        Written: where each was.
    """
    for i in range(len(speed)):
        heading[i] = -1
        if not balls.playing[i]:
            continue
        kind, x, y = balls.kind[i], balls.x[i], balls.y[i]
        before[i, 0], before[i, 1] = x, y
        heading[i] = choose_heading(field, kind, x, y, field.speeds[speed[i]])
        u, v, w = next_uniform(balls.random[i]), next_uniform(balls.random[i]), next_uniform(balls.random[i])
        x, y, hit, reached = step(field, kind, x, y, heading[i], field.speeds[speed[i]], balls.sigma[i], u, v, w)
        balls.x[i], balls.y[i] = x, y
        balls.steps[i] += 1
        balls.hits[i] += hit
        balls.playing[i] = not (reached or balls.steps[i] >= MAX_STEPS)
