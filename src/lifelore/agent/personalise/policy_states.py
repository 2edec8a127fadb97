"""The verbs `reuse retire` and `reuse add`, and the policies that a request may name as available."""

from collections.abc import Sequence

from lifelore.agent.personalise.study import ACTIVE, PILOT, RETIRED, Study
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name


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
