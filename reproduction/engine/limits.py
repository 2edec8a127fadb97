"""Limits of a claim's settings: a rule for all, and the table ``[limits]`` of ``claim.toml`` for what differs.

A whole number is at least 1, other numbers, also in lists, are at least 0, a list is not empty. A limit such as
``share = { above = 0, most = 1 }`` or ``ties = { among = ["uniform", "prior"] }`` holds for a value, or for every
value of a list at any depth. No limit names another setting, so that one setting can be changed alone.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from lifelore.core.errors import InputError

BOUNDS = {
    "least": ("at least", lambda x, bound: x >= bound),
    "most": ("at most", lambda x, bound: x <= bound),
    "above": ("above", lambda x, bound: x > bound),
    "below": ("below", lambda x, bound: x < bound),
}
KEYS = {*BOUNDS, "among"}


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
    for key, value in settings.items():
        if value == []:
            raise InputError(f"{key} must hold at least one value, got []")
        limit = limits.get(key, {"least": 1 if isinstance(value, int) else 0})
        for item in _items(value):
            _check(key, item, limit)


def _check(key: str, item: Any, limit: Mapping[str, Any]) -> None:
    if "among" in limit and item not in limit["among"]:
        raise InputError(f"{key} must be among {', '.join(map(str, limit['among']))}, got {item}")
    if isinstance(item, (int, float)) and not isinstance(item, bool):
        for rule, bound in limit.items():
            if rule in BOUNDS and not BOUNDS[rule][1](item, bound):
                raise InputError(f"{key} must be {BOUNDS[rule][0]} {bound}, got {item}")


def _items(value: Any) -> Iterator[Any]:
    """The value itself, or the items of a list at any depth; nothing of a table."""
    if isinstance(value, list):
        for item in value:
            yield from _items(item)
    elif not isinstance(value, Mapping):
        yield value
