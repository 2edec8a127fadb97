"""The result of a round that was played, and its form as a row of an export."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.play_study.ball_round import COLUMNS, BallRound
from lifelore.agent.play_study.study_plan import Round
from lifelore.domains.ball_game.ball_game import LossScale

FIELDS = ("number", "phase", "block", "method", "size", "speed", "sigma", "moves", "collisions", "reached", "loss")
"""Fields of a row of an export."""


@dataclass(frozen=True, eq=False)
class RoundResult:
    """A round that was played.

    Parameters
    ----------
    number : int
        Of the round in the session, from 0.
    planned : Round
    speed : int, optional
        Units a move, where it was constant.
    sigma : float
        Deviation of the push sideways, in units.
    moves : (n_moves, 7) int64
        See `ball_round.COLUMNS`.
    reached : bool
        Whether the ball came into the goal.
    """

    number: int
    planned: Round
    speed: int | None
    sigma: float
    moves: NDArray[np.int64]
    reached: bool

    @classmethod
    def of(cls, number: int, planned: Round, speed: int | None, played: BallRound) -> "RoundResult":
        """The result of a round that is over."""
        return cls(number, planned, speed, played.sigma, played.table, played.reached)

    @property
    def hits(self) -> int:
        """Number of moves with a collision."""
        return int(self.column("hit").sum())

    @property
    def loss(self) -> float:
        """Moves / 400 + collisions / 20."""
        return float(LossScale().loss(len(self.moves), self.hits))

    def column(self, name: str) -> NDArray[np.int64]:
        """A column of the moves, (n_moves,)."""
        return self.moves[:, COLUMNS.index(name)]

    @property
    def row(self) -> dict[str, Any]:
        """The result without its moves, by `FIELDS`."""
        planned = self.planned
        values = (
            self.number, planned.phase, planned.block, planned.method, planned.size, self.speed,
            round(self.sigma, 4), len(self.moves), self.hits, self.reached, round(self.loss, 6),
        )  # fmt: skip
        return dict(zip(FIELDS, values, strict=True))
