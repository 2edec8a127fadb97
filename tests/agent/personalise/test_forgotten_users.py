"""What is forgotten of a study leaves no byte in the file and its log, whoever else has the memory open."""

import hashlib
import struct
from pathlib import Path

import pytest

from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.agent.personalise.past import Line, add_lines
from lifelore.core.errors import NotFoundError
from lifelore.memory import open_memory

from .studies import study_of

USERS = 40
DECISIONS = 6


def mark(label: str, user: int) -> str:
    """A text that no other place has."""
    return hashlib.sha256(f"{label} {user}".encode()).hexdigest()


def live(memory, study) -> None:
    """All that a user's rows can carry, each with a mark, and decisions of the users among each other."""
    lines = [
        Line(mark("name", user), mark("past", user), 3.0, 1000 + user, "", mark("context", user))
        for user in range(USERS)
    ]
    add_lines(memory, study, lines)
    for number in range(DECISIONS):
        for user in range(USERS):
            request = f"{mark('request', user)} {number}"
            made = choose(memory, study, mark("name", user), context=mark("context", user), request=request)
            if number % 2:
                update(memory, study, made["decision"], outcome_of(user))


def outcome_of(user: int) -> float:
    return int(mark("outcome", user)[:8], 16) / 7


def traces(file: Path, user: int) -> dict[str, int]:
    """How often the marks of a user occur in the file and its side files; outcomes as their eight bytes."""
    sides = [side for side in file.parent.iterdir() if side.name.startswith(file.name)]
    content = b"".join(side.read_bytes() for side in sides)
    found = {label: content.count(mark(label, user).encode()) for label in ("name", "past", "context", "request")}
    return found | {"outcome": content.count(struct.pack(">d", outcome_of(user)))}


@pytest.fixture
def file(new_place) -> Path:
    return Path(new_place("sqlite"))


@pytest.fixture
def lived(file):
    """A file in which users came now and then, so that their rows lie all over it; the log is not yet moved."""
    with open_memory(file) as memory:
        live(memory, study_of(control=0.2).keep(memory))
    return file


def test_forgetting_a_user_leaves_no_byte(lived):
    with open_memory(lived) as other, open_memory(lived) as memory:
        study = study_of(control=0.2).keep(memory)
        assert other.studies.states() == {"s": "active"}
        before, neighbour = traces(lived, 7), traces(lived, 8)
        assert all(before.values())
        assert before["request"] >= DECISIONS
        assert forget(memory, study, mark("name", 7)) == DECISIONS + 1
        assert traces(lived, 7) == dict.fromkeys(before, 0)
        assert all(traces(lived, 8)[label] for label in neighbour)
        with pytest.raises(NotFoundError):
            forget(memory, study, mark("name", 7))
        assert memory.check() == []


def test_a_log_that_was_never_moved_is_emptied(file):
    with open_memory(file) as memory:
        study = study_of().keep(memory)
        live(memory, study)
        assert all(traces(file, 3).values())
        forget(memory, study, mark("name", 3))
        assert not any(traces(file, 3).values())
        assert all(traces(file, 4).values())


def test_deleting_a_study_leaves_no_byte_and_no_other_study_loses_one(lived):
    with open_memory(lived) as other, open_memory(lived) as memory:
        kept = study_of("kept").keep(memory)
        choose(memory, kept, mark("name", USERS))
        assert other.studies.states() == {"kept": "active", "s": "active"}
        assert memory.studies.delete("s")
        for user in range(USERS):
            assert not any(traces(lived, user).values()), user
        assert traces(lived, USERS)["name"] > 0
        assert (other.studies.states(), memory.studies.newest("s")) == ({"kept": "active"}, None)
        assert not memory.studies.delete("s")
