"""One round of the ball game, move by move, and its result as a row. Thesis: §4.8.5.1."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import HEADINGS, MAX_STEPS, SIZES, SPEEDS, BallGame, LossScale, step
from reproduction.chapter4.ball_game.moves import N_OUTCOMES, move_context, move_outcome
from reproduction.chapter4.c4_14_people.study_plan import BEAT, Round

COLUMNS = ("x", "y", "heading", "speed", "hit", "signal", "named")
"""Columns of recorded moves: place after the move, numbers of the direction and speed, whether there was a
collision, the signal (`domains.ball_game.moves`), and the number of the most likely size then, -1 without BEAT."""


class BallRound:
    """A round that is being played.

    Parameters
    ----------
    game : BallGame
    planned : Round
    sigma : float
        Deviation of the push sideways, in units.
    generator : numpy generator
        Draws slips and pushes.

    Attributes
    ----------
    x, y : int
        Place of the ball's centre.
    moves : list of tuple
        See `COLUMNS`.
    reached : bool
        Whether the ball is in the goal.
    """

    def __init__(self, game: BallGame, planned: Round, sigma: float, generator: np.random.Generator) -> None:
        self.game, self.planned, self.sigma = game, planned, float(sigma)
        self.kind = SIZES.index(planned.size)
        self._generator = generator
        self.x, self.y = game.layout.start
        self.reached = False
        self.moves: list[tuple[int, ...]] = []

    @property
    def over(self) -> bool:
        """Whether the ball is in the goal, or the largest number of moves is reached."""
        return self.reached or len(self.moves) >= MAX_STEPS

    @property
    def hits(self) -> int:
        """Number of moves with a collision."""
        return sum(move[COLUMNS.index("hit")] for move in self.moves)

    @property
    def loss(self) -> float:
        """Moves / 400 + collisions / 20, so far."""
        return float(LossScale().loss(len(self.moves), self.hits))

    def move(self, heading: int, speed: int) -> int:
        """Make a move in a direction of `HEADINGS` at the speed of a number; its signal.

        Raises
        ------
        InputError
            The round is over, or there is no such direction.
        """
        if isinstance(heading, bool) or not isinstance(heading, int) or not 0 <= heading < len(HEADINGS):
            raise InputError(f"heading must lie in [0, {len(HEADINGS)}), got {heading!r}")
        if self.over:
            raise InputError("the round is over; begin the next round")
        field, distance = self.game.field, self.game.speeds[speed]
        u, v, w = self._generator.random(3)
        x, y, hit, reached = step(field, self.kind, self.x, self.y, heading, distance, self.sigma, u, v, w)
        context = move_context(field, self.x, self.y, heading, distance)
        outcome = move_outcome(field, self.x, self.y, heading, distance, x, y)
        signal = int(context * N_OUTCOMES + outcome)
        self.x, self.y, self.reached = int(x), int(y), bool(reached)
        self.moves.append((self.x, self.y, heading, int(speed), int(hit), signal, -1))
        return signal

    def name_size(self, kind: int) -> None:
        """Note the most likely size after the last move."""
        self.moves[-1] = (*self.moves[-1][:-1], int(kind))

    def row(self, number: int) -> dict[str, Any]:
        """The result as JSON data, with the number of the round in its session.

        `speed` is that of all moves in units a move, None with BEAT; `path` has the moves by `COLUMNS`.
        """
        planned = self.planned
        speed = None if planned.method == BEAT or not self.moves else SPEEDS[self.moves[0][3]]
        return {
            "number": number, **planned._asdict(), "speed": speed, "sigma": round(self.sigma, 4),
            "moves": len(self.moves), "collisions": self.hits, "reached": self.reached,
            "loss": round(self.loss, 6), "path": [list(move) for move in self.moves],
        }  # fmt: skip


def column(row: dict[str, Any], name: str) -> NDArray[np.int64]:
    """A column of the moves of a row, (n_moves,)."""
    return np.array(row["path"], np.int64).reshape(-1, len(COLUMNS))[:, COLUMNS.index(name)]
