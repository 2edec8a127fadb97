"""Registration of a policy library as a study, beside `reuse fit`, which learns the library from a log."""

import time
from dataclasses import dataclass
from typing import Any

from lifelore.agent.personalise.library_document import described
from lifelore.agent.personalise.study import (
    ACTIVE,
    LEARNT,
    Change,
    Study,
    check_study_name,
    newest_version,
    states_after,
)
from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import DEFAULT_RULE
from lifelore.interaction.signals.return_signal import ReturnSignal
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name


@dataclass(frozen=True)
class StudySettings:
    """How a registered library chooses; fields as in `Study`."""

    control: float = 0.1
    incumbent: str | None = None
    rule: str = DEFAULT_RULE
    explore: float = 0.0
    change: Change = LEARNT
    models: str = "uncertain"


def register(memory: Memory, name: str, library: PolicyLibrary, settings: StudySettings | None = None) -> Study:
    """Store a library as the study of a name, in place of an earlier study of that name.

    Decisions for users stay; their beliefs follow the new library. A retired policy stays retired.

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
    study = Study(name, library, states, fitted=fitted, earlier=by_key, **vars(settings or StudySettings()))
    return study.keep(memory)


def study_document(study: Study) -> dict[str, Any]:
    """A study as plain data: its settings, types, policies with their states, and mean outcomes."""
    return {
        "study": study.name,
        **described(study.library),
        "states": dict(sorted(study.states.items())),
        "control": study.control,
        "incumbent": study.incumbent,
        "rule": study.rule,
        "explore": study.explore,
        "change": study.change,
        "models": study.models,
        "fitted": study.fitted,
    }
