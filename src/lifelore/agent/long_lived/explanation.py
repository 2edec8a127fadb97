"""Why the agent acted as it did: a task as a document, and the document in words."""

from typing import Any

import numpy as np

from lifelore.agent.long_lived.task_family import TaskFamily
from lifelore.agent.long_lived.task_log import Decision, TaskLog

UNKNOWN = "an unknown type"
SHOWN_TYPES = 3
"""Types that an explanation names, the most probable ones."""


def task_document(lived: TaskLog, family: TaskFamily, best: float) -> dict[str, Any]:
    """A lived task as JSON data, with the decisions of its first and last episode.

    ``best_return`` and ``hidden_type`` are for scoring; the agent knows neither.
    """
    known = [type_words(name) for name in lived.types]
    names = [*known, UNKNOWN]
    return {
        "task": lived.drawn.number,
        "context": lived.drawn.context,
        "hidden_type": lived.drawn.hidden_type,
        "best_return": round(best, 4),
        "returns": [round(value, 4) for value in lived.returns],
        "prior": _by_name(lived.prior, known),
        "alarm": lived.alarm,
        "alarm_score": round(lived.alarm_score, 3),
        "learnt": type_words(lived.learnt),
        "new_type": lived.learnt not in _members(lived.types),
        "first_episode": [_decision(one, family, names) for one in lived.decisions[0]],
        "last_episode": [_decision(one, family, names) for one in lived.decisions[-1]],
    }


def type_words(name: str) -> str:
    """A type's name in memory in words: ``"ann.0+ann.4+bo.2"`` is "type 0+4 of ann, 2 of bo".

    A type has the number of the task in which the robot first met it.
    """
    numbers: dict[str, list[str]] = {}
    for member in name.split("+"):
        robot, _, number = member.rpartition(".")
        numbers.setdefault(robot, []).append(number)
    return "type " + ", ".join(f"{'+'.join(found)} of {robot}" for robot, found in numbers.items())


def _members(types: list[str]) -> set[str]:
    """Names of the types that are joined in some."""
    return {name for joined in types for name in joined.split("+")}


def _decision(one: Decision, family: TaskFamily, names: list[str]) -> dict[str, Any]:
    others = np.delete(one.expected, one.behaviour)
    return {
        "scene": one.scene,
        "act": family.acts[one.act],
        "as_for": names[one.behaviour],
        "belief": _by_name(one.belief, names),
        "expected": round(float(one.expected[one.behaviour]), 3),
        "next_best": round(float(others.max()), 3) if len(others) else None,
        "reward": round(one.reward, 4),
        "effects": [f"{family.cause_name(cause)}: {family.effect_name(cause, e)}" for cause, e in one.effects],
    }


def _by_name(values: np.ndarray, names: list[str]) -> dict[str, float]:
    order = np.argsort(-values, kind="stable")[:SHOWN_TYPES].tolist()
    return {names[i]: round(float(values[i]), 3) for i in order}


def explained(document: dict[str, Any]) -> list[str]:
    """A task document in words, line by line."""
    lines = [f"task {document['task']}, context {document['context']}"]
    if document["prior"]:
        lines.append(f"  in this context the agent expected {_shares(document['prior'])}")
    else:
        lines.append("  the agent knew no type yet")
    for title, key, value in (
        ("first episode", "first_episode", document["returns"][0]),
        ("last episode", "last_episode", document["returns"][-1]),
    ):
        lines.append(f"  {title}, return {value:.2f}:")
        for number, step in enumerate(document[key], 1):
            lines.append(f"    {number}. saw {step['scene']}; believed in {_shares(step['belief'])}")
            rival = "" if step["next_best"] is None else f", the next best {step['next_best']:.2f}"
            lines.append(
                f"       → {step['act']}, as for {step['as_for']} (expected {step['expected']:.2f}{rival}); "
                f"reward {step['reward']:.2f}"
            )
    fitted = "no known type fitted" if document["alarm"] else "known types were not ruled out"
    taught = "it became the new type" if document["new_type"] else "it taught most to"
    lines.append(f"  {fitted} (surprise {document['alarm_score']:.1f} deviations); {taught} {document['learnt']}")
    return lines


def _shares(belief: dict[str, float]) -> str:
    # Memory stores keys in alphabetical order, so types of equal shares go by name.
    likely = sorted(belief.items(), key=lambda one: (-one[1], one[0]))
    return ", ".join(f"{name} {100 * value:.0f} %" for name, value in likely if value >= 0.005)
