"""Limits of a claim's settings as data: the table ``[limits]`` of ``claim.toml``, a line for each setting.

A limit holds for a number, or for every number of a list, at any depth:

- ``least = 1``, ``most = 6``, ``above = 0``, ``below = 1``: bounds; a text names another
  setting, ``most = "episodes"``
- ``among = ["uniform", "prior"]``: the only values, of a text or of a list of texts
- ``shape = [3]``: the shape of the value; with ``each = true`` of every item of the list
- ``default = {encoding = "encodings", …}``: the setting is a cell of the grid; what it has for each key is in the
  list of the setting named
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from lifelore.core.errors import InputError

BOUNDS = {
    "least": ("at least", lambda values, bound: (values >= bound).all()),
    "most": ("at most", lambda values, bound: (values <= bound).all()),
    "above": ("above", lambda values, bound: (values > bound).all()),
    "below": ("below", lambda values, bound: (values < bound).all()),
}
KEYS = {*BOUNDS, "among", "shape", "each", "default", "empty"}


def check_limits(settings: Mapping[str, Any], limits: Mapping[str, Mapping[str, Any]]) -> None:
    """Check settings against their limits.

    Raises
    ------
    InputError
        A setting breaks its limit, or a limit names a setting or rule that does not exist.
    """
    for key, limit in limits.items():
        if key not in settings or limit.keys() - KEYS:
            raise InputError(f"limits of '{key}' must name a setting and rules among {', '.join(sorted(KEYS))}")
        _check_shape(key, settings[key], limit)
        _check_bounds(key, settings, limit)
        if "among" in limit:
            _check_among(key, settings[key], limit["among"])
        if "default" in limit:
            _check_default(key, settings, limit["default"])


def _check_shape(key: str, value: Any, limit: Mapping[str, Any]) -> None:
    if "shape" not in limit:
        return
    items = value if limit.get("each") else [value]
    for item in items:
        try:
            found = np.shape(item)
        except ValueError:
            found = None  # rows of different lengths
        if found != tuple(limit["shape"]):
            words = " × ".join(map(str, limit["shape"]))
            raise InputError(f"{key} must be {words} numbers{' each' if limit.get('each') else ''}, got {item}")


def _check_bounds(key: str, settings: Mapping[str, Any], limit: Mapping[str, Any]) -> None:
    bounds = {rule: limit[rule] for rule in BOUNDS if rule in limit}
    if not bounds:
        return
    values = np.ravel(settings[key])
    if not values.size and not limit.get("empty"):
        raise InputError(f"{key} must hold at least one number, got {settings[key]}")
    for rule, bound in bounds.items():
        words, holds = BOUNDS[rule]
        limit_value = settings[bound] if isinstance(bound, str) else bound
        if not holds(values, limit_value):
            named = f"{bound} ({limit_value})" if isinstance(bound, str) else f"{bound}"
            raise InputError(f"{key} must be {words} {named}, got {settings[key]}")


def _check_among(key: str, value: Any, known: list) -> None:
    values = value if isinstance(value, list) else [value]
    unknown = [str(item) for item in values if item not in known]
    if unknown or not values:
        raise InputError(f"{key} must be among {', '.join(map(str, known))}, got {', '.join(unknown) or 'none'}")


def _check_default(key: str, settings: Mapping[str, Any], choices: Mapping[str, str]) -> None:
    cell = settings[key]
    wrong = [name for name, setting in choices.items() if cell.get(name) not in settings[setting]]
    if wrong:
        raise InputError(f"{key} must be a cell of the grid; its {', '.join(wrong)} is not, got {cell}")
