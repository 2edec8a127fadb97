"""What settings of a learning experiment must be, said in one line where they are not."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError


def check_counts(settings: Mapping, keys: Sequence[str], least: int = 1) -> None:
    """Each of `keys`, a number or a list of some, is at least `least`."""
    for key in keys:
        if not np.size(settings[key]) or np.min(settings[key]) < least:
            raise InputError(f"{key} must be at least {least}, got {settings[key]}")


def check_windows(settings: Mapping, keys: Sequence[str]) -> None:
    """Each of `keys` is a number of episodes that are run."""
    for key in keys:
        if settings[key] > settings["episodes"]:
            raise InputError(f"{key} must be at most episodes ({settings['episodes']}), got {settings[key]}")


def check_learning(settings: Mapping) -> None:
    """The learning rate, and the schedules of ε: first value, factor of each episode, and floor."""
    if not 0 <= settings["learning_rate"] <= 1:
        raise InputError(f"learning_rate must lie in [0, 1], got {settings['learning_rate']}")
    for schedule in settings["schedules"]:
        if np.shape(schedule) != (3,) or not all(isinstance(x, float) and 0 <= x <= 1 for x in schedule):
            raise InputError(
                f"schedules must each be three decimals in [0, 1], first ε, factor and floor, got {schedule}"
            )


def check_default(settings: Mapping, choices_of: Mapping[str, str]) -> None:
    """The default is a cell of the grid: what it has for each key is among the setting that lists the choices."""
    default = settings["default"]
    wrong = [key for key, choices in choices_of.items() if default.get(key) not in settings[choices]]
    if wrong:
        raise InputError(f"default must be a cell of the grid; its {', '.join(wrong)} is not, got {default}")


def check_among(settings: Mapping, key: str, known: Sequence[str]) -> None:
    """Everything in the list `key` is one of `known`."""
    unknown = [str(name) for name in settings[key] if name not in known]
    if unknown or not settings[key]:
        raise InputError(f"{key} must be among {', '.join(known)}, got {', '.join(unknown) or 'none'}")
