"""How far each rule is from the best that can be done on golf's training holes in a few shots (Eq. 4.3)."""

from lifelore.domains.golf.golf import CLUBS, Golf
from lifelore.experiments.chapter4.golf_runs import exact_library
from lifelore.experiments.chapter4.reuse_rules import RULES_SHOWN
from lifelore.interaction.selection.belief_program import best_plan, value_of_rule

GIVEN = "exact models; the hole is one of the four training holes, each as likely"


def program_gaps(horizon: int) -> dict[str, dict]:
    """By rule: yards missed a round in expectation, and how many more than under the dynamic program.

    "dynamic program" is the optimum itself; "hole known" plays the best club for the hole from the first shot.
    """
    library = exact_library()
    plan = best_plan(library, horizon)
    found = {
        "dynamic program": {"yards": -plan.value, "gap": 0.0, "first_club": CLUBS[plan.first]},
        "hole known": _way(plan.value, horizon * float(Golf().mean.max(axis=1).mean())),
    }
    for name, rule in RULES_SHOWN.items():
        found[name] = _way(plan.value, value_of_rule(library, rule, horizon))
    for j, club in enumerate(CLUBS):
        found[f"only the {club}"] = _way(plan.value, horizon * float(Golf().mean[:, j].mean()))
    return {
        name: {k: round(v, 6) if isinstance(v, float) else v for k, v in w.items()} for name, w in found.items()
    }


def _way(best: float, value: float) -> dict:
    return {"yards": -value, "gap": best - value}
