"""Choices that the thesis leaves open, as cells of a grid: mappings of the same keys, one of them the default.

Two of the keys are read by learners without a prior too: ``schedule`` and ``max_steps``.
"""

from collections.abc import Mapping, Sequence

READ_WITHOUT_PRIOR = ("schedule", "max_steps")


def default_of(settings: Mapping, keys: Sequence[str]) -> dict:
    """The stated default: a cell of the grid."""
    return {key: settings["default"][key] for key in keys}


def plain_how(how: Mapping, keys: Sequence[str]) -> dict:
    """A cell of the grid as learners without a prior meet it: all other choices None."""
    return {key: how[key] if key in READ_WITHOUT_PRIOR else None for key in keys}


def how_key(how: Mapping, keys: Sequence[str]) -> tuple:
    """A cell of the grid as something that can be looked up."""
    return tuple(tuple(how[key]) if isinstance(how[key], list) else how[key] for key in keys)


def runs_by_cell(
    results: Sequence[Mapping], who: Sequence[str], keys: Sequence[str]
) -> dict[tuple, list[Mapping]]:
    """What stands under ``found`` of all results, run by run, by the names of `who` and the cell of the grid."""
    runs: dict[tuple, list[Mapping]] = {}
    for result in results:
        for numbers in result["found"]:
            cell = (*(numbers.get(name) for name in who), how_key(numbers, keys))
            runs.setdefault(cell, []).append(numbers)
    return runs


def is_default_but_for_schedule(how: Mapping, settings: Mapping, keys: Sequence[str]) -> bool:
    """Whether a cell is the default under any schedule, or what learners without a prior meet there."""
    default = {**default_of(settings, keys), "schedule": how["schedule"]}
    return how_key(how, keys) in (how_key(default, keys), how_key(plain_how(default, keys), keys))
