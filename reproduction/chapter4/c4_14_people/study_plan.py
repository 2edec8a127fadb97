"""Settings of a session of the study, and the order of its rounds: practice, training, and blinded test blocks."""

from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, BallGame, ball_game

PERSON, SCRIPTED = PLAYERS = ("person", "scripted")
PRACTICE, TRAINING, TEST = "practice", "training", "test"
BEAT, STATIC = METHODS = ("BEAT", "best static speed")
FRAMES_A_SECOND = 30
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
    >>> StudySettings(sizes=(2, 20, 60), speeds=(30, 50, 70), practice=1, test=1).rounds
    16
    """

    player: str = PERSON
    sizes: tuple[int, ...] = SIZES
    speeds: tuple[int, ...] = SPEEDS
    practice: int = 2
    training: int = 1
    test: int = 5
    frames_per_move: int = 5
    layout: str = "s-maze 160"

    def __post_init__(self) -> None:
        if self.player not in PLAYERS:
            raise InputError(f"player must be one of {', '.join(PLAYERS)}, got {self.player!r}")
        for name, known in (("sizes", SIZES), ("speeds", SPEEDS)):
            given = getattr(self, name)
            if not given or len(set(given)) != len(given) or not set(given) <= set(known):
                raise InputError(f"{name} must be distinct and among {', '.join(map(str, known))}, got {given}")
        limits = {"practice": (0, MOST_ROUNDS), "training": (1, MOST_ROUNDS), "test": (1, MOST_ROUNDS)}
        for name, (least, most) in (limits | {"frames_per_move": (1, FRAMES_A_SECOND)}).items():
            if not least <= getattr(self, name) <= most:
                raise InputError(f"{name} must lie in [{least}, {most}], got {getattr(self, name)}")
        _ = self.game

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> "StudySettings":
        """The settings of `document`."""
        lists: dict[str, Any] = {name: tuple(document[name]) for name in ("sizes", "speeds")}
        return cls(**document | lists)

    @property
    def document(self) -> dict[str, Any]:
        """The settings as JSON data."""
        return asdict(self)

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


class Round(NamedTuple):
    """A round before it is played.

    phase : {"practice", "training", "test"}
    size : int, ball size
    speed : int, optional, units a move; None in the test, where the method decides
    method : str, of a test round, one of `METHODS`, else empty
    block : int, number of the test block, from 0; else -1
    """

    phase: str
    size: int
    speed: int | None = None
    method: str = ""
    block: int = -1


def plan_rounds(settings: StudySettings, generator: np.random.Generator, first: int) -> tuple[Round, ...]:
    """All rounds of a session in order.

    Sizes, and pairs of a size and a speed, come in random order. Each size has a block of each method, and the
    method of the first block changes from size to size.

    Parameters
    ----------
    settings : StudySettings
    generator : numpy generator
    first : int
        Number of the method, of `METHODS`, that begins with the first size; alternate it between people.

    Examples
    --------
    >>> settings = StudySettings(sizes=(2, 60), speeds=(30,), practice=0, test=1)
    >>> plan = plan_rounds(settings, np.random.default_rng(0), first=1)
    >>> [round.method for round in plan if round.phase == "test"]
    ['best static speed', 'BEAT', 'BEAT', 'best static speed']
    """
    pairs = [(size, speed) for size in settings.sizes for speed in settings.speeds]
    drawn = generator.integers(len(pairs), size=settings.practice)
    practice = [Round(PRACTICE, *pairs[i]) for i in drawn]
    order = np.concatenate([generator.permutation(len(pairs)) for _ in range(settings.training)])
    training = [Round(TRAINING, *pairs[i]) for i in order]
    test = []
    for place, i in enumerate(generator.permutation(len(settings.sizes))):
        for turn in range(2):
            method = METHODS[(first + place + turn) % 2]
            test += [Round(TEST, settings.sizes[i], None, method, 2 * place + turn)] * settings.test
    return (*practice, *training, *test)
