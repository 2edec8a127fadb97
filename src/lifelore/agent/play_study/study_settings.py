"""Settings of a study session: ball sizes, speeds, number of rounds, pace, and who plays."""

from dataclasses import asdict, dataclass
from typing import Any

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, BallGame, ball_game

PERSON, SCRIPTED = "person", "scripted"
PLAYERS = (PERSON, SCRIPTED)
FRAMES_A_SECOND = 30
"""Frames that a page draws in a second."""
LENGTHS: dict[str, dict[str, Any]] = {
    "short": {"sizes": (2, 20, 60), "speeds": (30, 50, 70), "practice": 1, "training": 1, "test": 1},
    "medium": {"sizes": SIZES, "speeds": (30, 50, 70), "practice": 2, "training": 1, "test": 2},
    "thesis": {"sizes": SIZES, "speeds": SPEEDS, "practice": 2, "training": 1, "test": 5},
}
"""Settings by length: 16, 44 and 92 rounds, each of 8 to 20 seconds at the usual pace."""
MOST_ROUNDS = 10


@dataclass(frozen=True)
class StudySettings:
    """What a session consists of.

    Parameters
    ----------
    player : {"person", "scripted"}
        Results are shown apart.
    sizes, speeds : tuple of int
        Ball sizes b, which simulate a limitation, and speeds, in units a move; distinct, of the thesis's.
    practice : int
        Rounds before the training, 0 to 10.
    training : int
        Rounds of each size at each speed, 1 to 10.
    test : int
        Rounds of each size with each method, 1 to 10; they make a block.
    frames_per_move : int
        Frames of 1/30 s that a move takes, 1 to 30; fewer make the game faster. Results of different numbers are
        never joined.
    layout : str
        See `domains.ball_game.layouts`.

    Raises
    ------
    InputError
        A setting breaks its rule.
    NotFoundError
        There is no such layout.

    Examples
    --------
    >>> StudySettings.of_length("short").rounds
    16
    """

    player: str = PERSON
    sizes: tuple[int, ...] = SIZES
    speeds: tuple[int, ...] = SPEEDS
    practice: int = 2
    training: int = 1
    test: int = 2
    frames_per_move: int = 5
    layout: str = "s-maze 160"

    def __post_init__(self) -> None:
        if self.player not in PLAYERS:
            raise InputError(f"player must be one of {', '.join(PLAYERS)}, got {self.player!r}")
        for name, known in (("sizes", SIZES), ("speeds", SPEEDS)):
            given = getattr(self, name)
            if not given or len(set(given)) != len(given) or not set(given) <= set(known):
                raise InputError(f"{name} must be distinct and among {', '.join(map(str, known))}, got {given}")
        for name, least in (("practice", 0), ("training", 1), ("test", 1)):
            if not least <= getattr(self, name) <= MOST_ROUNDS:
                raise InputError(f"{name} must lie in [{least}, {MOST_ROUNDS}], got {getattr(self, name)}")
        if not 1 <= self.frames_per_move <= FRAMES_A_SECOND:
            raise InputError(f"frames_per_move must lie in [1, {FRAMES_A_SECOND}], got {self.frames_per_move}")
        _ = self.game

    @classmethod
    def of_length(
        cls, length: str, player: str = PERSON, frames_per_move: int = 5, layout: str = "s-maze 160"
    ) -> "StudySettings":
        """The settings of a length by name."""
        if length not in LENGTHS:
            raise NotFoundError(f"length must be one of {', '.join(LENGTHS)}, got {length!r}")
        return cls(player, frames_per_move=frames_per_move, layout=layout, **LENGTHS[length])

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> "StudySettings":
        """The settings of `document`."""
        lists = {name: tuple(document[name]) for name in ("sizes", "speeds")}
        return cls(**{**document, **lists})

    @property
    def document(self) -> dict[str, Any]:
        """The settings as JSON data."""
        return {**asdict(self), "sizes": list(self.sizes), "speeds": list(self.speeds)}

    @property
    def rounds(self) -> int:
        """Number of rounds of the session."""
        return self.practice + len(self.sizes) * (self.training * len(self.speeds) + 2 * self.test)

    @property
    def pace(self) -> str:
        """What two sessions must share so that their results are joined."""
        return f"{self.layout}, {self.frames_per_move} frames a move"

    @property
    def game(self) -> BallGame:
        """The game with all sizes and speeds of the thesis; their numbers are the same in all sessions."""
        return ball_game(self.layout)
