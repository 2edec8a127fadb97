"""Object numbers from the label field of a file: 0 nothing, 1 the table, 2 and above objects.

Two conventions exist, and a file does not say which it uses:

- ``plain``: the label is the id.
- ``parts``: 1–9 are parts of the table, 20–29 parts of the first object, 30–39 of the second, and so on;
  the id is ``label // 10``, and 1 for 1–9 (the modified Object Segmentation Database).

``auto`` takes ``parts`` when some label lies in 20–29, none in 10–19, and at least half of the tens in use
from 20 on hold their round number (20, 30, …: an object's parts are counted from 0); otherwise ``plain``.
A plain file that numbers its objects 2, 3, 4 … without a gap is therefore never merged: before it reaches
20 it holds 10–19. One with gaps can be (2, 20: the first becomes the table), and must be read as ``plain``.
Labels 10–19 mean nothing under ``parts`` and are refused. Negative labels and NaN mean nothing (0) in both.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED

RULES = ("auto", "plain", "parts")
PARTS_NOTICE = (
    "were taken as parts of objects (1-9 the table, 20-29 object 2, 30-39 object 3, …);"
    " --labels plain leaves them as they are"
)
"""Message for a user who left the rule to `auto`."""
MAX_OBJECTS = 1000
"""Largest number of objects; a field with more labels has another meaning."""


def ids_from_labels(labels: NDArray, rule: str = "auto") -> NDArray[np.int64]:
    """Ids of labels by `rule`.

    Parameters
    ----------
    labels : (n,) integers or floats
        Floats must be whole.
    rule : {"auto", "plain", "parts"}

    Returns
    -------
    (n,) int64, ≥ 0

    Raises
    ------
    InputError
        An unknown rule, a label that is no whole number, or more than `MAX_OBJECTS` objects.

    Examples
    --------
    >>> ids_from_labels(np.array([0, 1, 2, 20, 21, 30])).tolist()
    [0, 1, 1, 2, 2, 3]
    >>> ids_from_labels(np.array([0, 1, 2, 3])).tolist()
    [0, 1, 2, 3]
    """
    check_rule(rule)
    whole = _whole(labels)
    used = _used(whole)
    objects = np.count_nonzero(used > TABLE)
    if objects > MAX_OBJECTS:
        raise InputError(
            f"the label field names {objects} objects where at most {MAX_OBJECTS} are possible; "
            "leave the field out to have the cloud segmented"
        )
    if rule == "parts" or (rule == "auto" and is_in_parts(used)):
        return _merged(whole, used)
    return whole


def check_rule(rule: str) -> None:
    """Raise InputError for an unknown rule."""
    if rule not in RULES:
        raise InputError(f"labels must be one of {', '.join(RULES)}, got {rule!r}")


def is_in_parts(used: NDArray[np.int64]) -> bool:
    """Whether the labels in use follow the convention of parts; see the module for the rule."""
    tens = np.unique(used[used >= 20] // 10)
    if not (tens == 2).any() or ((used >= 10) & (used <= 19)).any():
        return False
    return 2 * np.isin(10 * tens, used).sum() >= len(tens)


def _used(labels: NDArray[np.int64]) -> NDArray[np.int64]:
    """The labels that occur, ascending; counted where they are small, which spares a cloud's sorting."""
    if labels.max(initial=0) < len(labels):
        return np.flatnonzero(np.bincount(labels))
    return np.unique(labels)


def _whole(labels: NDArray) -> NDArray[np.int64]:
    if labels.dtype.kind == "f":
        labels = np.where(np.isnan(labels), UNLABELLED, labels)
        if (np.abs(labels) > 2**53).any() or (labels != np.rint(labels)).any():
            raise InputError("labels must be whole numbers, got fractions or numbers beyond 2^53")
    elif labels.dtype.kind not in "iub":
        raise InputError(f"labels must be numbers, got {labels.dtype}")
    elif labels.dtype == np.uint64 and (labels > np.uint64(2**53)).any():
        raise InputError("labels must be whole numbers up to 2^53")
    return np.maximum(labels.astype(np.int64), UNLABELLED)


def _merged(labels: NDArray[np.int64], used: NDArray[np.int64]) -> NDArray[np.int64]:
    if ((used >= 10) & (used <= 19)).any():
        raise InputError("labels 10 to 19 belong to nothing under labels=parts; read the file with labels=plain")
    return np.where((labels > 0) & (labels < 20), TABLE, labels // 10)
