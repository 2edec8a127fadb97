"""The order of the rounds of a session: practice, training, and test blocks that the player cannot tell apart."""

from dataclasses import dataclass

import numpy as np

from lifelore.agent.play_study.study_settings import StudySettings

PRACTICE, TRAINING, TEST, FREE = "practice", "training", "test", "free"
BEAT, STATIC = "BEAT", "best static speed"
METHODS = (BEAT, STATIC)


@dataclass(frozen=True)
class Round:
    """A round before it is played.

    Parameters
    ----------
    phase : {"practice", "training", "test", "free"}
    size : int
        Ball size.
    speed : int, optional
        Units a move; None where BEAT chooses it at each move, and in a static block.
    method : str
        Of a test round, one of `METHODS`, else empty. A free round has BEAT.
    block : int
        Number of the test block, from 0; else -1.
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
            block = Round(TEST, settings.sizes[i], None, method, 2 * place + turn)
            test += [block] * settings.test
    return (*practice, *training, *test)
