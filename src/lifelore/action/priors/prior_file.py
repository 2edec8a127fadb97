"""Saves and loads an `ActionPrior` as an npz file of two arrays and a JSON text, without pickle.

    contexts   (n,) int64, distinct and ascending
    counts     (n, n_actions) int64, Σ w U as multiples of 2^-20, at least 0, no row all 0
    about      uint8, UTF-8 JSON: format, version, n_actions, alpha0, key, and `about` for readers

Loading gives the same bits, and equal priors give equal bytes. Other programs can read the file with
``numpy.load`` and divide the counts by 2^20.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.atomic_write import read_file, write_file
from lifelore.core.packed_arrays import PackedFormat

FORMAT = PackedFormat("lifelore action prior", 1, "action prior", "save_prior", 2**32)


def save_prior(prior: ActionPrior, path: str | Path, about: Mapping[str, Any] | None = None) -> None:
    """Write a prior; `about` describes it for readers (features, actions, tasks) as JSON values.

    Raises
    ------
    InputError
        `about` holds a value that is not JSON, or α⁰ is a function of the context.
    StoreError
        The file cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> prior = ActionPrior(2)
    >>> prior.update([7], [[True, False]])
    >>> with TemporaryDirectory() as folder:
    ...     save_prior(prior, f"{folder}/prior.npz", {"world": "office"})
    ...     load_prior(f"{folder}/prior.npz")
    <ActionPrior: 2 actions, 1 contexts, 1 counts, alpha0=0.1>
    """
    write_file(path, prior_bytes(prior, about), "the prior")


def load_prior(path: str | Path) -> ActionPrior:
    """The prior that `save_prior` wrote, equal to the bit.

    Raises
    ------
    InputError
        The file is missing or damaged, has another format, or comes from a newer version.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     save_prior(ActionPrior(3, alpha0=0.5), f"{folder}/prior.npz")
    ...     load_prior(f"{folder}/prior.npz")
    <ActionPrior: 3 actions, 0 contexts, 0 counts, alpha0=0.5>
    """
    return prior_from_bytes(read_file(path, "the prior"), str(path))


def prior_bytes(prior: ActionPrior, about: Mapping[str, Any] | None = None) -> bytes:
    """The prior as the bytes of an npz file."""
    header = {
        "n_actions": prior.n_actions,
        "alpha0": prior.uniform_alpha0,
        "key": prior.key,
        "about": dict(about or {}),
    }
    contexts, counts = prior.fixed_point_counts()
    return FORMAT.pack(header, {"contexts": contexts, "counts": counts})


def prior_from_bytes(content: bytes, where: str = "the prior") -> ActionPrior:
    """The prior of `prior_bytes`; error messages name `where`."""
    header, arrays = FORMAT.unpack(content, where)
    try:
        contexts, counts = arrays["contexts"], arrays["counts"]
        n_actions, alpha0, key = header["n_actions"], header["alpha0"], header["key"]
        if type(n_actions) is not int or type(alpha0) is not float or type(key) is not str:
            raise ValueError("n_actions, alpha0 and key must be a whole number, a number and a text")
        _check(contexts, counts, n_actions)
        return ActionPrior.from_fixed_point_counts(contexts, counts, alpha0, key)
    except (KeyError, ValueError) as error:
        raise FORMAT.damaged(where, error) from None


def _check(contexts: NDArray[Any], counts: NDArray[Any], n_actions: int) -> None:
    if contexts.dtype != np.int64 or counts.dtype != np.int64 or contexts.ndim != 1:
        raise ValueError(f"contexts and counts must be int64, got {contexts.dtype} and {counts.dtype}")
    if counts.shape != (len(contexts), n_actions):
        raise ValueError(f"counts must have shape ({len(contexts)}, {n_actions}), got {counts.shape}")
    if not (contexts[1:] > contexts[:-1]).all():
        raise ValueError("contexts must be distinct and ascending")
    largest = (2**63 - 1) // (n_actions + 1)
    if len(contexts) and not (-largest <= contexts[0] and contexts[-1] <= largest):
        raise ValueError(f"contexts must be of magnitude at most {largest}")
    if not ((counts >= 0).all() and counts.any(axis=1).all()):
        raise ValueError("counts must be at least 0, with a positive one in each row")
