"""What a fitted study personalises by, and what its user should know: sentences for the reader of `reuse fit`."""

from collections.abc import Mapping
from typing import Any

from lifelore.agent.personalise.fit.model_choice import LEAST_USERS
from lifelore.agent.personalise.study import Study


def personalised_by(study: Study) -> list[str]:
    """Of "types" and "items", those by which a user's outcomes tell of policies that the user has not tried."""
    library = study.library
    shared = library.performance.kind == "joint-normal"
    return ["types"] * (library.n_types > 1) + ["items"] * shared


def fit_notes(study: Study, document: Mapping[str, Any]) -> list[str]:
    """Sentences on what is personalised and how well held-out users were served, for the document of a fit."""
    notes = []
    if not personalised_by(study):
        counts = study.models == "uncertain" and study.library.performance.spread.mean > 0
        own = " but by counting a user's own outcomes of each policy" if counts else ""
        notes.append(
            f"nothing is personalised{own}: one type was found, and no policy tells of another; every user starts "
            f"with {document['types'][0]['best']}"
        )
    if study.library.n_types == 1 and (document["contexts"] or document["features"]):
        notes.append("contexts and features change nothing: they tell of types, and there is one")
    held_out = document["held_out"]
    if held_out is None or held_out["over_single"] is None:
        return [
            *notes,
            f"models were not compared: that needs model auto and {LEAST_USERS} users with two outcomes",
        ]
    gain, low, high = held_out["over_single"]
    notes.append(
        f"choices for {held_out['users']} users held out: {gain:+.3g} ({low:.3g} to {high:.3g}) an outcome over "
        "the best single policy"
    )
    notes.append(_beside_counting(*held_out["over_counting"]))
    return notes


def _beside_counting(gain: float, low: float, high: float) -> str:
    counting = "counting each user's own outcomes (a policy's mean counts as two)"
    if gain <= 0:
        return f"{counting} does as well for them: prefer it, it is simpler"
    clearly = "better" if low > 0 else "not clearly better"
    return f"{clearly} than {counting}: {gain:+.3g} ({low:.3g} to {high:.3g})"
