"""Checks of a fleet's memory against its contributions, added up one by one."""

from collections import Counter
from pathlib import Path

from lifelore.core.protocols import Record
from lifelore.memory import Memory, open_memory


def task_numbers(memory: Memory, robot: str) -> list[int]:
    """Numbers of a robot's stored tasks, ascending."""
    return sorted(int(task["index" if "index" in task else "task"]) for task in memory.task_descriptions(robot))


def wrong_sums(memory: Memory) -> int:
    """Number of slots whose merged count differs from the sum of the single contributions."""
    sums: dict[tuple[str, str, int], Counter[int]] = {}
    for robot in memory.robots():
        for _, records in memory.history(robot):
            for record in records:
                if record.merge == "add":
                    own = sums.setdefault((record.kind, record.key, record.version), Counter())
                    # Plain whole numbers, which cannot overflow as a sum of 64 bits can.
                    for slot, value in zip(record.slots.tolist(), record.values.tolist(), strict=True):
                        own[slot] += value
    return sum(_differences(memory, name, own) for name, own in sums.items())


def _differences(memory: Memory, name: tuple[str, str, int], expected: Counter[int]) -> int:
    record = memory.recall(*name)
    found = dict(zip(record.slots.tolist(), record.values.tolist(), strict=True)) if record else {}
    return sum(found.get(slot) != expected.get(slot) for slot in found.keys() | expected.keys())


def added_again(shared: Path, parts: list[Path]) -> int:
    """Number of contributions that a second merge of the same parts adds or changes; 0 if merging is harmless."""
    with open_memory(shared) as memory:
        before = contents(memory)
        added = sum(count["added"] for count in memory.merge_many(parts))
        return added + (contents(memory) != before)


def contents(memory: Memory) -> list:
    """Everything that a memory holds, as plain data."""
    names = [(one["kind"], one["key"], one["version"]) for one in memory.show()["lore"]]
    tasks = {robot: [task for task, _ in memory.history(robot)] for robot in memory.robots()}
    return [tasks, [_plain(memory.recall(*name)) for name in names]]


def _plain(record: Record | None) -> tuple | None:
    if record is None:
        return None
    return record.kind, record.key, record.version, record.slots.tolist(), record.values.tolist(), record.about
