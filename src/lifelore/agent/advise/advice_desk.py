"""Advice desks in memory: experts' walks in a named world, and the steps of the agents that they advise.

    advice_desk/NAME            the desk as packed JSON: world, experts, goals, settings; about: id, bytes
    advice_steps/NAME/AGENT     slots: number of the step; values: class · 2⁴⁰ + state · 8 + action + 1,
                                with the number of the class that the agent shows, from 1; 0: none

A desk gives the same advice after a restart: it takes in the stored steps of an agent again. Steps are numbered,
so that a step that comes twice counts once.
"""

import hashlib
import json
import re
import threading
import time
import zlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lifelore.agent.advise.advise import AdviceSession, AdviseSettings
from lifelore.agent.advise.step_lines import StepLine, read_steps
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.protocols import Record
from lifelore.memory import Memory
from lifelore.memory.byte_words import bytes_of, words_of

DESK, STEPS, VERSION = "advice_desk", "advice_steps", 1
_ACTIONS, _CLASS = 8, 1 << 40
ATTEMPTS = 100
SMALLEST_CELL, LARGEST_CELL = 0.05, 10.0
"""Metres; smaller cells make a world that does not fit main memory."""


class AdviceDesk:
    """A desk of a memory, open for the steps of any number of agents.

    Parameters
    ----------
    memory : Memory
    name : str
    maps : mapping of str to str
        Files of the maps that a desk can name.

    Raises
    ------
    NotFoundError
        There is no such desk, or its map is not served any more.
    """

    def __init__(self, memory: Memory, name: str, maps: Mapping[str, str]) -> None:
        record = memory.recall(DESK, check_desk_name(name), VERSION)
        if record is None:
            known = ", ".join(key for key, version, _ in memory.keys(DESK) if version == VERSION)
            raise NotFoundError(f"no advice desk '{name}'; known: {known or 'none'}; register its experts first")
        content = bytes_of(record.values, record.about["bytes"])
        self.name, self.id, self._memory = name, record.about["id"], memory
        self.session = _session(json.loads(zlib.decompress(content)), maps)
        self._known: dict[str, int] = {}
        self._latest: dict[str, dict[str, Any] | None] = {}
        self._lock = threading.Lock()

    def answer(self, agent: str, number: int, steps: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        """Take in steps of an agent, and advise in the state after the last of them.

        Parameters
        ----------
        number : int
            Number of the first of the steps, from 0.
        steps : sequence of {"state", "action", "class"}
            As the lines of `step_lines`; the last may have the action None. ``class`` may be left out, and counts
            with method ``classes`` alone.

        Returns
        -------
        dict
            ``agent``; ``step``, number of steps so far; ``taken``: False where the steps were stored before;
            ``advise``, ``theta``, ``p_normal``, ``gain`` and ``classes`` after the last stored step, see `advise`.

        Raises
        ------
        InputError
            A step breaks its rule, or steps before `number` are missing; nothing is stored.
        """
        lines = ({"agent": agent, **step} for step in steps)
        read = list(read_steps(lines, self.session.world, "steps", self.session.classes))
        if not read:
            raise InputError("steps must hold at least one step, got none")
        with self._lock:
            for _ in range(ATTEMPTS):
                self._replay(agent)
                known = self._known[agent]
                if number + len(read) <= known:
                    return {"agent": agent, "step": known, "taken": False, **(self._latest[agent] or {})}
                if number != known:
                    raise InputError(
                        f"step must be {known}, the number of steps so far, got {number}; send from there"
                    )
                if self._store(agent, number, read):
                    self._take(agent, read)
                    return {
                        "agent": agent,
                        "step": self._known[agent],
                        "taken": True,
                        **(self._latest[agent] or {}),
                    }
                self._known.pop(agent)
        raise StoreError(
            f"memory {self._memory.location}: too many programs step for one agent at once; try again"
        )

    def _take(self, agent: str, steps: Sequence[StepLine]) -> None:
        for step in steps:
            self._latest[agent] = self.session.answer(step)
        self._known[agent] = self._known.get(agent, 0) + len(steps)

    def _replay(self, agent: str) -> None:
        """Take in the stored steps of an agent who has not been seen since the desk was opened."""
        if agent in self._known:
            return
        self.session.forget(agent)
        self._known[agent], self._latest[agent] = 0, None
        record = self._memory.recall(STEPS, self._key(agent), VERSION)
        if record is not None and record.slots.size and record.about["id"] == self.id:
            self._take(agent, [self._step_of(agent, value) for value in record.values.tolist()])

    def _store(self, agent: str, number: int, steps: Sequence[StepLine]) -> bool:
        values = np.array([self._value_of(step) for step in steps], np.int64)
        about = {"desk": self.name, "agent": agent, "id": self.id}
        record = Record(STEPS, self._key(agent), VERSION, "newest", number + np.arange(len(values)), values, about)
        robot = f"advise {self.name}: {_digest(agent)}"
        return self._memory.contribute(
            robot, [record], process=self.id, seq=number, task={"desk": self.name, "steps": len(steps)}
        )

    def _value_of(self, step: StepLine) -> int:
        shown = 0 if step.shown is None else self.session.classes.index(step.shown) + 1
        return shown * _CLASS + step.state * _ACTIONS + step.action + 1

    def _step_of(self, agent: str, value: int) -> StepLine:
        shown, move = divmod(value, _CLASS)
        state, action = divmod(move, _ACTIONS)
        return StepLine(agent, state, action - 1, self.session.classes[shown - 1] if shown else None)

    def _key(self, agent: str) -> str:
        # Steps under an earlier desk of this name are none of this one.
        return f"{self.name}/{self.id}/{_digest(agent)}"


def register_desk(memory: Memory, name: str, document: Mapping[str, Any], maps: Mapping[str, str]) -> AdviceDesk:
    """Store a desk in place of an earlier one of its name; the same desk again changes nothing.

    Parameters
    ----------
    document : mapping
        ``world``, a map's name in `maps`, or the name and seed of a world (``advice:3``); ``experts``, steps
        {"agent", "state", "action"}, with method ``classes`` also "class"; ``goals``, states, optional; the other
        fields of `AdviseSettings`, optional.

    Raises
    ------
    InputError, NotFoundError
        A field breaks its rule; nothing is stored.
    """
    check_desk_name(name)
    _session(document, maps)
    content = zlib.compress(json.dumps(document, sort_keys=True).encode())
    digest = hashlib.sha256(content).hexdigest()[:32]
    earlier = memory.recall(DESK, name, VERSION, slots=(0, 0))
    if earlier is None or earlier.about["digest"] != digest:
        values = words_of(content)
        about = {"bytes": len(content), "digest": digest, "id": f"{digest[:8]}-{time.time_ns()}"}
        record = Record(DESK, name, VERSION, "newest", np.arange(len(values)), values, about)
        robot = f"advise {name}"
        seq = memory.tasks(robot)
        while not memory.contribute(robot, [record], process="desk", seq=seq, task={"desk": name}):
            seq += 1
    return AdviceDesk(memory, name, maps)


def check_desk_name(name: str) -> str:
    """`name` itself, if it can name a desk."""
    if not re.fullmatch(r"[^/]{1,60}", name) or not name.isprintable():
        raise InputError(f"name must be 1 to 60 printable characters without '/', got {name[:80]!r}")
    return name


def _session(document: Mapping[str, Any], maps: Mapping[str, str]) -> AdviceSession:
    options = {
        name: value for name, value in document.items() if name not in ("experts", "goals") and value is not None
    }
    cell = options.get("cell")
    if cell is not None and not SMALLEST_CELL <= cell <= LARGEST_CELL:
        raise InputError(f"cell must lie in [{SMALLEST_CELL}, {LARGEST_CELL}] metres, got {cell:g}")
    options["world"] = _world(options["world"], maps)
    goals = [{"state": state} for state in document.get("goals") or ()] or None
    return AdviceSession(AdviseSettings(experts=document["experts"], goals=goals, **options))


def _world(name: str, maps: Mapping[str, str]) -> str:
    if name in maps:
        return maps[name]
    # A name with other characters could be a path.
    if not re.fullmatch(r"[a-z_]{1,40}(:\d{1,9})?", name):
        served = ", ".join(sorted(maps)) or "none"
        raise NotFoundError(f"world must be a map that is served, or NAME:SEED such as advice:3; maps: {served}")
    return name


def _digest(agent: str) -> str:
    return hashlib.sha256(agent.encode("utf-8", "replace")).hexdigest()[:16]
