"""Registration of a policy library as a study, beside `reuse fit`, which learns the library from a log."""

import time
from typing import Any

from lifelore.agent.personalise.library_document import described
from lifelore.agent.personalise.study import (
    ACTIVE,
    Study,
    check_study_name,
    newest_version,
    states_after,
)
from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.signals.return_signal import ReturnSignal
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name


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
