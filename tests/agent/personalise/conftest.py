"""Memories in both back ends for tests of studies."""

from collections.abc import Callable, Iterator

import pytest

from lifelore.agent.personalise.identifiers import _Clock
from lifelore.memory import Memory, open_memory

Places = Callable[[str], str]


@pytest.fixture(params=["sqlite", "postgresql"])
def where(request: pytest.FixtureRequest, new_place: Places) -> str:
    """A fresh place in each back end."""
    return new_place(request.param)


@pytest.fixture
def memory(where: str) -> Iterator[Memory]:
    """An empty memory in each back end."""
    with open_memory(where) as opened:
        yield opened


@pytest.fixture
def file_memory(new_place: Places) -> Iterator[Memory]:
    """An empty memory in an SQLite file, where the back end makes no difference."""
    with open_memory(new_place("sqlite")) as opened:
        yield opened


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Nanoseconds since 1970, which go on by 10 ms at each look; set the first element to another time."""
    monkeypatch.setattr("lifelore.agent.personalise.identifiers._CLOCK", _Clock())
    now = [1_700_000_000 * 10**9]

    def look() -> int:
        now[0] += 10**7
        return now[0]

    monkeypatch.setattr("time.time_ns", look)
    return now
