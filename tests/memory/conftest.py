"""Memories in both back ends; the places for them come from the tests' own `new_place`."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from lifelore.memory import Memory, open_memory

Places = Callable[[str], str]


@pytest.fixture(params=["sqlite", "postgresql"])
def back_end(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def where(back_end: str, new_place: Places) -> str:
    """A fresh place in each back end."""
    return new_place(back_end)


@pytest.fixture
def memory(where: str) -> Iterator[Memory]:
    """An empty memory in each back end."""
    with open_memory(where) as opened:
        yield opened


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A path for a SQLite memory."""
    return tmp_path / "lifelore.db"
