"""Twelve schedules by which the type of an opponent or user changes, among a few types of a world."""

from collections.abc import Callable, Hashable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
USED = 4
"""Types that an opponent uses, of all types of the world; no agent is told which."""
NOISE = 0.2
"""Probability that a noisy pattern is left for any of the used types."""


class Lived(NamedTuple):
    """An episode: what the agent gained, how it ended, and the policy of its last round or step."""

    gain: float
    outcome: Hashable
    policy: int


class Opponent:
    """An opponent of one run.

    Parameters
    ----------
    mean : (T, P) float
        What policies pay on average; an adaptive opponent takes the type on which the last policy pays least.
    kinds : sequence of hashable
        The outcomes that episodes of the world can have, the agent's worst first.
    schedule : str
        A name of `SCHEDULES`.
    generator : numpy generator
        Draws the used types, the pattern, and the changes.
    """

    def __init__(self, mean: Array, kinds: tuple[Hashable, ...], schedule: str, generator: np.random.Generator):
        self.used = generator.permutation(len(mean))[:USED]
        self.kinds, self._mean, self._generator = kinds, mean[self.used], generator
        self._next = SCHEDULES[schedule]
        self.by_outcome = generator.integers(len(self.used), size=len(kinds))
        self.by_both = generator.integers(len(self.used), size=(len(self.used), len(kinds)))
        self.place, self.episode = int(generator.integers(len(self.used))), 0

    @property
    def type(self) -> int:
        """The type of the next episode."""
        return int(self.used[self.place])

    def end_episode(self, lived: Lived) -> None:
        """Take the type of the next episode."""
        self.episode += 1
        self.place = self._next(self, lived)

    def anew(self) -> int:
        """Any of the used types."""
        return int(self._generator.integers(len(self.used)))

    def slips(self) -> bool:
        """Whether a noisy pattern is left now."""
        return bool(self._generator.random() < NOISE)

    def answer(self, policy: int) -> int:
        """The used type on which a policy pays least; the first of equals."""
        return int(self._mean[:, policy].argmin())

    def number_of(self, outcome: Hashable) -> int:
        """The number of an outcome, 0 the agent's worst."""
        return self.kinds.index(outcome)


def _every(n: int) -> Callable[[Opponent, Lived], int]:
    return lambda opponent, lived: opponent.anew() if opponent.episode % n == 0 else opponent.place


def _noisy(pattern: Callable[[Opponent, Lived], int]) -> Callable[[Opponent, Lived], int]:
    return lambda opponent, lived: opponent.anew() if opponent.slips() else pattern(opponent, lived)


PATTERNS: dict[str, Callable[[Opponent, Lived], int]] = {
    "by outcome": lambda opponent, lived: opponent.number_of(lived.outcome) % len(opponent.used),
    "moves on": lambda opponent, lived: (opponent.place + opponent.number_of(lived.outcome)) % len(opponent.used),
    "cycle": lambda opponent, lived: (opponent.place + 1) % len(opponent.used),
}
"""Patterns by name: the place of the next type.

Each outcome has its own type; or the opponent stays where the outcome is its best, and moves on by one or two
places else; or the types go round, whatever happens.
"""
STATIC, EVERY_TEN, EVERY_TWO, ADAPTIVE = "static", "every ten", "every two", "adaptive"
SCHEDULES: dict[str, Callable[[Opponent, Lived], int]] = {
    STATIC: lambda opponent, lived: opponent.place,
    EVERY_TEN: _every(10),
    EVERY_TWO: _every(2),
    ADAPTIVE: lambda opponent, lived: opponent.answer(lived.policy),
    **PATTERNS,
    **{f"{name}, noise": _noisy(pattern) for name, pattern in PATTERNS.items()},
    "any of outcome": lambda opponent, lived: int(opponent.by_outcome[opponent.number_of(lived.outcome)]),
    "any of both": lambda opponent, lived: int(
        opponent.by_both[opponent.place, opponent.number_of(lived.outcome)]
    ),
}
"""By name: the place of the next type among the used types.

Types are static, drawn anew every ten or every two episodes, or the answer to the last policy; or they follow a
pattern, exactly or with noise; or a random function of the last outcome, or of the last type and outcome.
"""
GROUPS = {
    "known": [STATIC], "every_ten": [EVERY_TEN], "every_two": [EVERY_TWO], "adaptive": [ADAPTIVE],
    "exact": list(PATTERNS), "noise": [f"{name}, noise" for name in PATTERNS],
    "unknown": ["any of outcome", "any of both"],
}  # fmt: skip
"""Schedules by the word under which the claim measures them."""
