"""Lessons in memory: open, store demonstrations and their prior, export and forget.

    factory_lesson/LESSON                 about: components, seed, time
    factory_demonstration/LESSON/NUMBER   slots: the steps; values: state · 6 + action; about: the result
    action_prior                          counts of all demonstrations by what the robot sees; lessons add up

LESSON is an anonymous identifier, drawn at random. All records of a lesson are contributions of one robot, so that
forgetting it takes its share out of the prior. Thesis: §3.4.8.
"""

import secrets
import time
from typing import Any

import numpy as np

from lifelore.action.demonstrations.demonstrations import Demonstration, demonstration_lines
from lifelore.agent.factory_lesson.lesson import FactoryLesson
from lifelore.agent.factory_lesson.lesson_prior import competence_of, prior_of
from lifelore.agent.factory_lesson.lesson_task import lesson_task
from lifelore.core.errors import NotFoundError
from lifelore.core.protocols import Record
from lifelore.domains.factory.factory import ACTION_NAMES
from lifelore.memory import Memory

LESSON, SHOWN, VERSION = "factory_lesson", "factory_demonstration", 1
_ONE = np.zeros(1, np.int64)


def robot_of(lesson: str) -> str:
    """The name under which memory has all that is stored of a lesson."""
    return f"teach: {lesson}"


def open_new_lesson(memory: Memory, components: int = 2, seed: int = 0) -> FactoryLesson:
    """Begin a lesson and store it; InputError where the number of components breaks its rule."""
    name = secrets.token_hex(8)
    lesson = FactoryLesson(name, components, seed=seed)
    about = {"components": components, "seed": seed, "time": int(time.time())}
    _contribute(memory, name, [Record(LESSON, name, VERSION, "newest", _ONE, _ONE, about)], 0, {"teach": "lesson"})
    return lesson


def open_lesson(memory: Memory, name: str) -> FactoryLesson:
    """The lesson of a name, as its stored demonstrations leave it; NotFoundError where there is none."""
    record = memory.recall(LESSON, name, VERSION) if 0 < len(name) <= 100 and name.isalnum() else None
    if record is None:
        raise NotFoundError(f"no lesson '{name[:40]}'; begin a lesson, or check the identifier")
    about = record.about
    return FactoryLesson(name, about["components"], seed=about["seed"], shown=stored_demonstrations(memory, name))


def stored_demonstrations(memory: Memory, name: str) -> list[Demonstration]:
    """The stored demonstrations of a lesson, in order."""
    found = []
    for _, records in memory.history(robot_of(name)):
        for record in records:
            if record.kind == SHOWN:
                states, actions = np.divmod(record.values, len(ACTION_NAMES))
                found.append(Demonstration(str(record.about["number"]), name, states, actions))
    return found


def store_demonstration(memory: Memory, lesson: FactoryLesson, shown: Demonstration) -> bool:
    """Store a demonstration and its share of the prior; False where it is stored already."""
    number = int(shown.task)
    competence = round(competence_of(shown, lesson.task_of(number)), 6)
    about = {"number": number, "steps": len(shown.actions), "competence": competence, "time": int(time.time())}
    values = shown.states * len(ACTION_NAMES) + shown.actions
    key = f"{lesson.name}/{number:04}"
    records = [Record(SHOWN, key, VERSION, "newest", np.arange(len(values)), values, about)]
    prior = prior_of([shown], lesson.task_of)
    if len(prior):
        records.append(prior.to_record({"what": "demonstrations in the modified factory"}))
    return _contribute(memory, lesson.name, records, number + 1, {"teach": "demonstration", **about})


def demonstrations_in(memory: Memory) -> dict[str, int]:
    """Number of ``demonstrations`` and of ``lessons`` with at least one that the memory holds."""
    keys = [key for key, _, _ in memory.keys(SHOWN)]
    return {"demonstrations": len(keys), "lessons": len({key.split("/")[0] for key in keys})}


def export_lesson(memory: Memory, name: str) -> str:
    """The demonstrations of a lesson as JSON lines, see `action.demonstrations.demonstrations`."""
    lesson = open_lesson(memory, name)
    named = []
    for one in lesson.shown:
        factory = lesson_task(lesson.seed, name, lesson.components, "shown", int(one.task)).task.factory
        named.append(one._replace(task=f"modified factory {factory.fingerprint[:8]}/{one.task}"))
    return "".join(f"{line}\n" for line in demonstration_lines(named))


def forget_lesson(memory: Memory, name: str) -> int:
    """Delete all that is stored of a lesson, for ever; the number of contributions removed."""
    open_lesson(memory, name)
    return memory.forget(robot_of(name))


def _contribute(memory: Memory, name: str, records: list[Record], seq: int, task: dict[str, Any]) -> bool:
    return memory.contribute(robot_of(name), records, process="teach", seq=seq, task=task)
