"""What the factory claims C3.4 to C3.6 share of their settings, and what can be said against overridden ones."""

from collections.abc import Mapping

import numpy as np

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.domains.factory.contexts import ENCODINGS
from lifelore.domains.factory.layout import factory

OPEN = {
    "discount": 0.99,
    "max_steps": 2000,
    "learning_rate": 0.5,
    "ties": ["uniform", "prior"],
    "schedules": [[0.1, 1.0, 0.1], [1.0, 0.95, 0.01], [1.0, 0.98, 0.01]],
    "alpha0": [0.01, 0.1, 1.0],
    "encodings": list(ENCODINGS),
    "default": {"encoding": "global", "ties": "uniform", "schedule": [1.0, 0.98, 0.01], "alpha0": 0.1},
}
"""Choices that the thesis leaves open, and the stated default among them."""


def check_open(settings: Mapping) -> None:
    """Raise `InputError` where the choices left open cannot be run."""
    for key, known in (("ties", TIES), ("encodings", ENCODINGS)):
        unknown = [str(one) for one in settings[key] if one not in known]
        if unknown or not settings[key]:
            raise InputError(f"{key} must be among {', '.join(known)}, got {', '.join(unknown) or 'none'}")
    for key in ("learning_rate", "discount"):
        if not 0 <= settings[key] <= 1 or (key == "discount" and settings[key] == 1):
            raise InputError(f"{key} must lie in [0, 1], a discount below 1, got {settings[key]}")
    for schedule in settings["schedules"]:
        if np.shape(schedule) != (3,) or not all(isinstance(x, float) and 0 <= x <= 1 for x in schedule):
            raise InputError(
                f"schedules must each be three decimals in [0, 1], first ε, factor and floor, got {schedule}"
            )
    if not all(isinstance(x, float) and x > 0 for x in settings["alpha0"]):
        raise InputError(f"alpha0 must be decimals above 0, got {settings['alpha0']}")
    default = settings["default"]
    keys = {"encoding": "encodings", "ties": "ties", "schedule": "schedules", "alpha0": "alpha0"}
    if not all(default.get(key) in settings[choices] for key, choices in keys.items()):
        raise InputError(f"default must be a cell of the grid of {', '.join(keys)}, got {default}")


def check_sizes(settings: Mapping, *keys: str) -> None:
    """Raise `InputError` where one of the counts `keys` is below 1."""
    for key in keys:
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")


def check_components(numbers) -> None:
    """Raise `InputError` for numbers of components that no task of the factory can have, or too many to table."""
    most = min(factory().n_components, 6)
    if not numbers or not all(isinstance(k, int) and 1 <= k <= most for k in numbers):
        raise InputError(f"components must lie in [1, {most}], got {numbers}")
