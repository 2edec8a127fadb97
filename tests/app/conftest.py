"""The command line asked in this process, started as a process of its own, and memories to ask it about."""

import json
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from lifelore.app.command_line import run
from lifelore.memory import open_memory

PROGRAM = Path(sys.executable).with_name("lifelore")
TINY = ("live", "--domain", "lattice", "--tasks", "2")
"""The smallest life: two tasks in the thesis's lattice."""
HUNG = 600
"""Seconds after which a process counts as hung; only a test that fails waits so long."""


@dataclass(frozen=True)
class Answer:
    """What the command line said, and how it ended."""

    status: int
    out: str
    err: str

    @property
    def document(self) -> Any:
        """All of stdout as one JSON document; NaN and infinity, which JSON has not, are refused."""
        return json.loads(self.out, parse_constant=_not_json)

    @property
    def refusal(self) -> str:
        """The one line of a user's mistake, after a look that there is nothing else."""
        assert (self.status, self.out) == (2, ""), self
        assert self.err.startswith("lifelore: "), self
        assert self.err.count("\n") == 1, self
        assert self.err.endswith("\n"), self
        assert "Traceback" not in self.err
        return self.err.strip()


def _not_json(word: str) -> None:
    raise AssertionError(f"{word} is no JSON")


@pytest.fixture(autouse=True)
def own_data_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Nothing here touches the memory of whoever runs the tests; the folder of the default memory."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)
    return tmp_path / "data" / "lifelore"


@pytest.fixture
def ask(capfd: pytest.CaptureFixture[str]) -> Callable[..., Answer]:
    """Ask the command line in this process."""

    def ask(*arguments: object) -> Answer:
        capfd.readouterr()
        status = run([str(argument) for argument in arguments])
        return Answer(status, *capfd.readouterr())

    return ask


@pytest.fixture
def start() -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start the installed program; whatever still runs at the end of the test is killed."""
    running: list[subprocess.Popen[str]] = []

    def start(*arguments: object, **options: Any) -> subprocess.Popen[str]:
        command = [str(PROGRAM), *(str(argument) for argument in arguments)]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL}
        running.append(subprocess.Popen(command, text=True, **(pipes | options)))
        return running[-1]

    yield start
    for process in running:
        process.kill()
        process.communicate()


@pytest.fixture
def answer() -> Callable[[subprocess.Popen[str]], Answer]:
    """Wait for a started process and hear it out."""

    def answer(process: subprocess.Popen[str]) -> Answer:
        out, err = process.communicate(timeout=HUNG)
        return Answer(process.returncode, out or "", err or "")

    return answer


@pytest.fixture
def wait_for_tasks() -> Callable[[subprocess.Popen[str], Path, int], None]:
    """Wait until a life's memory holds at least so many finished tasks of the robot `robot`."""

    def wait(life: subprocess.Popen[str], path: Path, tasks: int) -> None:
        give_up = time.monotonic() + HUNG
        while finished_tasks(path) < tasks:
            assert life.poll() is None, f"the life ended before {tasks} tasks were in {path}"
            assert time.monotonic() < give_up, f"no {tasks} tasks in {path} within {HUNG} s"
            time.sleep(0.03)

    return wait


def finished_tasks(path: Path) -> int:
    if not path.exists():
        return 0
    with open_memory(path) as memory:
        return memory.tasks("robot")


@pytest.fixture(scope="session")
def two_tasks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sound memory of two tasks; copy it rather than live in it."""
    path = tmp_path_factory.mktemp("template") / "known.db"
    assert run([*TINY, "--memory", str(path), "--out", str(path.parent / "out")]) == 0
    with open_memory(path) as memory:
        assert (memory.tasks("robot"), memory.check()) == (2, [])
    return path


@pytest.fixture
def known(two_tasks: Path, tmp_path: Path) -> Path:
    """A memory of two tasks, this test's own."""
    return Path(shutil.copy(two_tasks, tmp_path / "known.db"))
