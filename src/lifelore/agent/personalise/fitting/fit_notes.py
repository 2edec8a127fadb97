"""What a fitted study personalises by, and what its user should know: sentences for the reader of `reuse fit`."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lifelore.agent.personalise.fitting.choice_bias import choice_bias
from lifelore.agent.personalise.fitting.library_from_log import TypedRows
from lifelore.agent.personalise.fitting.model_choice import LEAST_USERS
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.agent.personalise.past import unread_times
from lifelore.agent.personalise.study import Study

FEW_USERS = 10
"""Number of users of a type below which the reader is warned."""


def personalised_by(study: Study, typed: TypedRows) -> list[str]:
    """What a choice follows from: "types" and "items" tell of policies that the user has not tried, "context"."""
    library = study.library
    types, shared = library.n_types > max(1, typed.contexts), library.performance.kind == "joint-normal"
    return ["types"] * types + ["context"] * (typed.contexts > 0) + ["items"] * shared


def fit_notes(study: Study, document: Mapping[str, Any], log: ReuseLog, model: str) -> list[str]:
    """Sentences on what is personalised, how well held-out users were served, and what looks wrong in the log.

    Parameters
    ----------
    document : mapping
        Of the fit, with ``held_out``, ``context`` and ``personalised_by``.
    model : str
        That the user asked for.
    """
    notes, by = [], document["personalised_by"]
    if not by:
        counts = study.models == "uncertain" and study.library.performance.spread.mean > 0
        own = " but by counting a user's own outcomes of each policy" if counts else ""
        notes.append(
            f"nothing is personalised{own}: one type was found, and no policy tells of another; every user starts "
            f"with {document['types'][0]['best']}"
        )
    notes += _of_context(study, document) + _of_held_out(document["held_out"])
    return notes + _warnings(document, log, model)


def _of_context(study: Study, document: Mapping[str, Any]) -> list[str]:
    """What the context of a user changes, and its value."""
    context, plain = document["context"], study.library.n_types == 1
    if document["features"]:
        return ["contexts and features change nothing: they tell of types, and there is one"] * plain
    if context is None:
        return []
    if plain:
        served = "types by context were not compared" if context["worth"] is None else "on users held out"
        found = "outcomes do not differ by it"
        if context["differ"]:
            found = f"outcomes differ by it, but that gives no better choices ({served})"
        return [f"{context['column']} changes nothing: {found}"]
    worth, tells = "", "tells of types"
    if context["worth"] is not None:
        gain, low, high = context["worth"]
        worth = f", worth {gain:+.3g} ({low:.3g} to {high:.3g}) an outcome on users held out"
        tells = tells if low > 0 else "tells little of types"
    if not context["types_of"]:
        return [f"{context['column']} {tells}{worth}"]
    types = study.library.n_types // context["types_of"]
    found = "one type: users of a context start alike" if types == 1 else f"{types} types in each context"
    return [f"{found}; {context['types_of']} contexts ({context['column']}) have outcomes of their own{worth}"]


def _of_held_out(held_out: Mapping[str, Any] | None) -> list[str]:
    """How well users were served who were held out."""
    if held_out is None or held_out["over_single"] is None:
        return [f"models were not compared: that needs model auto and {LEAST_USERS} users with two outcomes"]
    gain, low, high = held_out["over_single"]
    return [
        f"choices for {held_out['users']} users held out, as strangers and after half of their outcomes: "
        f"{gain:+.3g} ({low:.3g} to {high:.3g}) an outcome over the best single policy",
        _beside_counting(*held_out["over_counting"]),
    ]


def _beside_counting(gain: float, low: float, high: float) -> str:
    counting = "counting each user's own outcomes (a policy's mean counts as two)"
    if gain <= 0:
        return f"{counting} does as well for them: prefer it, it is simpler"
    clearly = "better" if low > 0 else "not clearly better"
    return f"{clearly} than {counting}: {gain:+.3g} ({low:.3g} to {high:.3g})"


def _warnings(document: Mapping[str, Any], log: ReuseLog, model: str) -> list[str]:
    """What in the log or the settings may not be meant."""
    found = []
    if len(values := np.unique(log.outcomes)) == 1:
        found.append(
            f"every outcome is {values[0]:g}, so the log compares no policies: does it leave failures out?"
        )
    if document["context"] and document["context"]["several"]:
        several = f"{document['context']['several']} of {document['users']} users have several contexts"
        found.append(f"{several}; the last of each counts")
    small = _small_types(document) if document["types_found"] else {}
    if small:
        named = ", ".join(f"{name} has {users}" for name, users in [*small.items()][:3])
        found.append(f"types of fewer than {FEW_USERS} users: {named}; ask for fewer --types")
    if model not in ("auto", "categorical") and len(values) == 2:
        found.append(
            f"outcomes have two values, which model {model} reads as amounts; --model categorical counts them"
        )
    if words := unread_times(log):
        found.append(
            f"the time of {len(words)} of {len(log)} lines cannot be read, such as {words[0]!r}, and only tells "
            "lines apart: an export with other words would count them again; write ISO dates or seconds since 1970"
        )
    found += _bias(log) + _equal_lines(log)
    return found + _spelt_twice("users", log.user.names) + _spelt_twice("policies", log.policy.names)


def _small_types(document: Mapping[str, Any]) -> dict[str, int]:
    """Types of several with few users in all contexts: a context's own are shrunk towards those everywhere."""
    types, contexts = document["types"], (document["context"] or {}).get("types_of") or 1
    n = len(types) // contexts
    users = {types[place]["name"]: sum(kind["users"] for kind in types[place::n]) for place in range(n)}
    named = {name.partition(", ")[0] if contexts > 1 else name: number for name, number in users.items()}
    return {name: number for name, number in named.items() if number < FEW_USERS and n > 1}


def _bias(log: ReuseLog) -> list[str]:
    """Whether the choices of the log suited the users, and what to do."""
    if (bias := choice_bias(log)) is None:
        return []
    return [
        f"the log's choices depend on the user: after outcomes of {bias.policy or 'a policy'} above its mean it "
        f"came again in {100 * bias.share:.0f} % of the lines, else in {100 * bias.others:.0f} %. Means are then "
        "biased, and a wrong policy may look best: give each line the weight 1 / (probability of its choice) by "
        "--columns weight=NAME, or fit to lines that were chosen at random"
    ]


def _equal_lines(log: ReuseLog) -> list[str]:
    """How many lines equal another one, also in their time, where no identifier tells them apart."""
    lines = np.flatnonzero([not given for given in log.decision.words])
    same = np.zeros(len(lines), np.int64)
    _, outcomes = np.unique(log.outcomes, return_inverse=True)
    for codes in (log.user.codes, log.policy.codes, outcomes, log.context.codes, log.type.codes, log.time.codes):
        _, same = np.unique(same * (codes.max() + 1) + codes[lines], return_inverse=True)
    n = len(lines) - len(np.unique(same))
    return [
        f"{n} of {len(log)} lines equal an earlier one, and each counts: if an export wrote lines twice, leave "
        "them out; if not, tell them apart by a column time or decision"
    ] * (n > 0)


def _spelt_twice(what: str, names: Sequence[str]) -> list[str]:
    """Which names differ only in capitals, in spaces at the ends, or as whole numbers with and without ``.0``."""
    first: dict[str, str] = {}
    alike = ((name.strip().casefold().removesuffix(".0"), name) for name in names)
    twice = [(other, name) for plain, name in alike if (other := first.setdefault(plain, name)) != name]
    return [
        f"{what} differ only in capitals, spaces or a final .0 from others ({len(twice)}, as '{one}' and "
        f"'{other}'); each counts"
        for one, other in twice[:1]
    ]
