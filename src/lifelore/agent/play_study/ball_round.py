"""One round of the ball game, frame by frame: the ball waits for a direction, then moves until it is in the goal.

A move takes some frames, during which the ball glides from its place before the move to the place after it. The
direction and the speed of a move are those in force when it begins. Thesis: §4.8.5.1.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import HEADINGS, MAX_STEPS, BallGame, LossScale, step
from lifelore.domains.ball_game.moves import N_OUTCOMES, move_context, move_outcome

COLUMNS = ("x", "y", "heading", "speed", "hit", "signal", "named")
"""Columns of recorded moves: place after the move, numbers of the direction and speed, whether there was a
collision, the signal (`domains.ball_game.moves`), and the number of the most likely size then, -1 without BEAT."""


class BallRound:
    """A round that is being played.

    Parameters
    ----------
    game : BallGame
    kind : int
        Number of the ball's size.
    sigma : float
        Deviation of the push sideways, in units.
    generator : numpy generator
        Draws slips and pushes.

    Attributes
    ----------
    x, y : int
        Place of the ball's centre.
    heading : int
        Number of the direction in force; -1 before the first.
    moves : list of tuple
        See `COLUMNS`.
    reached : bool
        Whether the ball is in the goal.
    """

    def __init__(self, game: BallGame, kind: int, sigma: float, generator: np.random.Generator) -> None:
        self.game, self.kind, self.sigma = game, kind, float(sigma)
        self._generator = generator
        self.x, self.y = game.layout.start
        self.before = self.x, self.y
        self.heading, self.reached, self.touched = -1, False, False
        self.moves: list[tuple[int, ...]] = []

    @property
    def over(self) -> bool:
        """Whether the ball is in the goal, or the largest number of moves is reached."""
        return self.reached or len(self.moves) >= MAX_STEPS

    @property
    def hits(self) -> int:
        """Number of moves with a collision."""
        return sum(move[4] for move in self.moves)

    @property
    def loss(self) -> float:
        """Moves / 400 + collisions / 20, so far."""
        return float(LossScale().loss(len(self.moves), self.hits))

    @property
    def table(self) -> NDArray[np.int64]:
        """The moves, (n_moves, 7) int64, see `COLUMNS`."""
        return np.array(self.moves, np.int64).reshape(-1, len(COLUMNS))

    def steer(self, heading: int) -> None:
        """Set the direction of the next moves; InputError where there is none of this number."""
        if isinstance(heading, bool) or not isinstance(heading, int) or not 0 <= heading < len(HEADINGS):
            raise InputError(f"heading must lie in [0, {len(HEADINGS)}), got {heading!r}")
        self.heading = heading

    def move(self, speed: int) -> int:
        """Make a move at the speed of a number; its signal.

        Raises
        ------
        InputError
            The round is over, or has no direction yet.
        """
        if self.over or self.heading < 0:
            raise InputError("a move needs a direction and a round that is not over; steer first")
        field, distance = self.game.field, self.game.speeds[speed]
        u, v, w = self._generator.random(3)
        x, y, hit, reached = step(
            field, self.kind, self.x, self.y, self.heading, distance, self.sigma, u, v, w
        )  # fmt: skip
        context = move_context(field, self.x, self.y, self.heading, distance)
        outcome = move_outcome(field, self.x, self.y, self.heading, distance, x, y)
        signal = int(context * N_OUTCOMES + outcome)
        self.before, self.x, self.y = (self.x, self.y), int(x), int(y)
        self.reached, self.touched = bool(reached), bool(hit)
        self.moves.append((self.x, self.y, self.heading, int(speed), int(hit), signal, -1))
        return signal

    def name_size(self, kind: int) -> None:
        """Note the most likely size after the last move."""
        self.moves[-1] = (*self.moves[-1][:-1], int(kind))

    def place_at(self, share: float) -> tuple[float, float]:
        """Where the ball is drawn when a share, in [0, 1], of the last move has passed."""
        (x0, y0), x1, y1 = self.before, self.x, self.y
        return x0 + share * (x1 - x0), y0 + share * (y1 - y0)
