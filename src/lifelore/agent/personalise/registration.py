"""A policy library as plain data, its registration as a study, and policies that are retired or added later.

`fitting` learns the library from a log instead.
"""

import base64
import binascii
import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lifelore.agent.personalise.study import (
    ACTIVE,
    PILOT,
    RETIRED,
    Study,
    check_study_name,
    newest_version,
    states_after,
)
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.return_signal import ReturnSignal
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name

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


def register(memory: Memory, name: str, library: PolicyLibrary, **choosing: Any) -> Study:
    """Store a library as the study of a name, in place of an earlier study of that name.

    Decisions for users stay; their beliefs follow the new library. A retired policy stays retired.

    Parameters
    ----------
    **choosing
        How it chooses, as fields of `Study`: control, incumbent, rule, explore, change, models.

    Raises
    ------
    InputError
        A name or setting breaks its rule, the signal of the library is not the outcome itself, or all policies are
        retired.
    """
    check_study_name(name)
    for word in (*library.types, *library.policies):
        check_name("name", word)
    if not isinstance(library.signal, ReturnSignal):
        raise InputError(
            "library of a study must have the outcome as its signal; register a library with other signals for "
            "adaptation"
        )
    earlier = newest_version(memory, name)
    states = states_after(library.policies, earlier.about["states"] if earlier else {})
    if ACTIVE not in states.values():
        raise InputError(
            "library must have a policy that is not retired, got none; use a retired policy again first"
        )
    # Computed once and stored with the library.
    getattr(library.performance, "spread", None)
    fitted = {"rows": 0, "users": 0, "found": False, "time": int(time.time())}
    by_key = bool(earlier and earlier.about["earlier"])
    study = Study(name, library, states, fitted=fitted, earlier=by_key, **choosing)
    return study.keep(memory)


def study_document(study: Study) -> dict[str, Any]:
    """A study as plain data: its settings, types, policies with their states, and mean outcomes."""
    return {
        "study": study.name,
        **described(study.library),
        "states": dict(sorted(study.states.items())),
        **study.choosing,
        "fitted": study.fitted,
    }


def retire(memory: Memory, study: Study, policy: str) -> Study:
    """Give a policy to nobody from now on; what it achieved stays evidence.

    Raises
    ------
    NotFoundError
        There is no such policy.
    InputError
        It is the incumbent, or the last one.
    """
    if policy not in study.states:
        raise NotFoundError(f"no policy '{policy}'; there are {', '.join(sorted(study.states))}")
    if policy == study.incumbent:
        raise InputError(f"'{policy}' is the incumbent that the control group gets; fit with another one first")
    if study.active == [policy]:
        raise InputError(f"'{policy}' is the last policy in use; add another one first")
    return study.with_state(policy, RETIRED).keep(memory)


def add(memory: Memory, study: Study, policy: str) -> Study:
    """Bring a policy in: a retired one as it was, a new one to the control group until a fit knows it.

    Raises
    ------
    InputError
        It is there already; or it is new and there is no control group that draws at random.
    """
    check_name("policy", policy)
    state = study.states.get(policy)
    if state in (ACTIVE, PILOT):
        raise InputError(f"'{policy}' is there already ({state})")
    if policy in study.library.policies:
        return study.with_state(policy, ACTIVE).keep(memory)
    if not study.control or study.incumbent is not None:
        raise InputError(
            f"'{policy}' has no outcome yet, and there is no control group that gets policies at random: fit from "
            "a log that has it, or with --control and no incumbent"
        )
    return study.with_state(policy, PILOT).keep(memory)


def listed_policies(study: Study, words: Sequence[str]) -> list[str]:
    """Names of policies from words such as ``a,b``; a word that is itself the name of a policy is not cut.

    Raises
    ------
    NotFoundError
        There is no such policy.
    InputError
        There is no word.
    """
    names = [name for word in words for name in ([word] if word in study.states else word.split(","))]
    return checked_available(study, [name.strip() if name not in study.states else name for name in names])


def checked_available(study: Study, available: Sequence[str]) -> list[str]:
    """The available policies that somebody can get, sorted; retired ones are left out.

    Raises
    ------
    NotFoundError
        There is no such policy.
    InputError
        No policy is left.
    """
    for policy in available:
        if policy not in study.states:
            raise NotFoundError(
                f"available must name policies of the study, got '{policy}'; there are "
                f"{', '.join(sorted(study.states))}"
            )
    usable = sorted({policy for policy in available if study.states[policy] in (ACTIVE, PILOT)})
    if not usable:
        raise InputError(
            f"available must name a policy in use, got {', '.join(available) or 'none'}; in use are "
            f"{', '.join([*study.active, *study.pilots])}"
        )
    return usable
