"""A policy library as plain data: means and deviations by type and policy, or the bytes of its own file."""

import base64
import binascii
from collections.abc import Mapping
from typing import Any

import numpy as np

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.signals.category_signal import CategorySignal

LARGEST = 100_000
"""Largest number of pairs of a type and a policy; more would make the first decision slow."""


def library_of(document: Mapping[str, Any]) -> PolicyLibrary:
    """The library that a document describes.

    Parameters
    ----------
    document : mapping
        Either ``file``, the bytes of `PolicyLibrary.to_bytes` in base64, or these fields: names ``types`` and
        ``policies``; ``means`` (n_types, n_policies) and ``deviations``, a number or (n_types, n_policies);
        ``counts`` of the runs behind them, optional; ``prior`` (n_types,), optional; ``signals`` (n_types,
        n_policies, n_categories), optional: probabilities of observed categories, where the outcome itself is not
        the signal; ``categories``, their names.

    Raises
    ------
    InputError
        A field breaks its rule, or the file is damaged.
    """
    given = {name: value for name, value in document.items() if value is not None}
    if "file" in given:
        if len(given) > 1:
            raise InputError("library must have a file or other fields, got both; leave one out")
        library = PolicyLibrary.from_bytes(_decoded(given["file"]), "library")
    else:
        for name in ("means", "deviations"):
            if name not in given:
                raise InputError(f"library must have {name}, or a file; add it")
        library = _from_fields(given)
    if (size := library.n_types * library.n_policies) > LARGEST:
        raise InputError(f"library must have at most {LARGEST} pairs of a type and a policy, got {size}")
    return library


def described(library: PolicyLibrary) -> dict[str, Any]:
    """Names, prior and mean outcomes of a library as plain data."""
    return {
        "types": list(library.types),
        "policies": list(library.policies),
        "prior": library.prior.tolist(),
        "means": library.performance.mean.tolist(),
    }


def _from_fields(given: Mapping[str, Any]) -> PolicyLibrary:
    numbers = {
        name: _array(name, given[name]) for name in ("means", "deviations", "counts", "prior") if name in given
    }
    signal = None
    if "signals" in given:
        signal = CategorySignal(_array("signals", given["signals"]), given.get("categories"))
    return PolicyLibrary.from_means(
        numbers["means"], numbers["deviations"], given.get("types"), given.get("policies"),
        count=numbers.get("counts"), signal=signal, prior=numbers.get("prior"),
    )  # fmt: skip


def _array(name: str, rows: Any) -> np.ndarray:
    try:
        return np.array(rows, np.float64)
    except (ValueError, TypeError):
        raise InputError(f"{name} must be numbers in rows of one length; fill the gaps") from None


def _decoded(text: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        raise InputError(f"file must be the library's bytes in base64, got {text[:40]!r}") from None
