"""Models from training rounds: losses by size and speed, and counts of moves, which tell BEAT the sizes.

BEAT learns from the player's own training rounds and those of others, whose mean loss of a size at a speed counts
as one round of the player. The best static speed is that of the others alone. Thesis: §4.8.4, §4.8.5.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, LossScale
from lifelore.interaction.adaptation.beat import Beat
from lifelore.interaction.library.policy_library import PolicyLibrary
from reproduction.chapter4.ball_game.moves import N_SIGNALS, move_signal
from reproduction.chapter4.c4_14_people.ball_round import column
from reproduction.chapter4.c4_14_people.study_plan import TRAINING, StudySettings

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


class TrainingTotals(NamedTuple):
    """Sums over training rounds; sizes and speeds are all those of the thesis.

    rounds, steps, hits : (n_sizes, n_speeds) int64
    moves : (n_speeds, N_SIGNALS, n_sizes) int64, number of moves by signal
    """

    rounds: Ints
    steps: Ints
    hits: Ints
    moves: Ints

    @classmethod
    def of(cls, rows: Iterable[dict[str, Any]]) -> "TrainingTotals":
        """The totals of the training rounds among `rows`."""
        rounds, steps, hits = np.zeros((3, len(SIZES), len(SPEEDS)), np.int64)
        moves = np.zeros((len(SPEEDS), N_SIGNALS, len(SIZES)), np.int64)
        for row in rows:
            if row["phase"] == TRAINING:
                size, speed = SIZES.index(row["size"]), SPEEDS.index(row["speed"])
                rounds[size, speed] += 1
                steps[size, speed] += row["moves"]
                hits[size, speed] += row["collisions"]
                moves[speed, :, size] += np.bincount(column(row, "signal"), minlength=N_SIGNALS)
        return cls(rounds, steps, hits, moves)

    @property
    def mean_loss(self) -> Floats:
        """Mean loss by size and speed, (n_sizes, n_speeds); NaN without rounds."""
        n = np.where(self.rounds > 0, self.rounds, np.nan)
        return LossScale().loss(self.steps / n, self.hits / n)

    def covers(self, settings: StudySettings) -> bool:
        """Whether every size of a session was played at every speed of it."""
        return bool((self.rounds[pairs_of(settings)] > 0).all())


def pairs_of(settings: StudySettings) -> tuple[Ints, ...]:
    """Index of the sizes and speeds of a session in arrays of all."""
    rows = [SIZES.index(size) for size in settings.sizes]
    columns = [SPEEDS.index(speed) for speed in settings.speeds]
    return np.ix_(rows, columns)


def best_static_speed(totals: TrainingTotals, settings: StudySettings) -> int:
    """The speed, in units a move, of the least mean loss over the sizes of a session (α* of Eq. 4.8).

    `totals` must cover the session.
    """
    loss = totals.mean_loss[pairs_of(settings)].mean(axis=0)
    return settings.speeds[int(loss.argmin())]


def expected_values(own: TrainingTotals, others: TrainingTotals, settings: StudySettings) -> Floats:
    """V: minus the expected loss of a player by size and speed, (n_sizes, n_speeds) of the session.

    The others' mean counts as one round of the player. `others` must cover the session.
    """
    own_sum = LossScale().loss(own.steps, own.hits) + others.mean_loss
    return -(own_sum / (own.rounds + 1))[pairs_of(settings)]


def beat_for(own: TrainingTotals, others: TrainingTotals, settings: StudySettings, seed: int = 0) -> Beat:
    """BEAT for one player: its types are the sizes of the session, its action sets the speeds."""
    rows, columns = pairs_of(settings)
    counts = (own.moves + others.moves)[columns.ravel()][:, :, rows.ravel()]
    # Only the values decide; the deviation of a loss is never read.
    library = PolicyLibrary.from_means(expected_values(own, others, settings), 1.0, signal=move_signal(counts))
    return Beat(library, seed=seed)
