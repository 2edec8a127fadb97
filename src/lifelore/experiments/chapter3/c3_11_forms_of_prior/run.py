"""C3.11: action priors as proportions, as draws from a Dirichlet and as a softmax, in the modified factory.

Every prior knows the optimal policies of 80 other factories and lists; learners without one know nothing. The
thesis does not say which observations Figure 3.15 uses, how ε falls, or what the counts in the exponent are
divided by: all are crossed in a grid. The default takes φ3, the thesis's best set, and the softmax as printed.

Here an optimal episode's moves cost about what its task pays, so its reward lies near 0 and "within 5 % of the
optimal return" has no scale. *Comparable* is asked of the distance from learning without a prior to the optimum.
Thesis: §3.2.2.1, §3.4.7, Figure 3.15.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import PHI
from lifelore.domains.factory.factory import N_COMPONENTS, FactoryRewards
from lifelore.experiments.chapter3.factory_forms import (
    AS_PRINTED,
    DIRICHLET,
    FORMS,
    KEYS,
    PLAIN,
    PROPORTION,
    SOFTMAXES,
    cells,
    hows,
    run_cell,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import is_above, share_of
from lifelore.experiments.engine.learning_settings import (
    check_among,
    check_counts,
    check_default,
    check_learning,
    check_windows,
)
from lifelore.experiments.engine.open_choices import default_of, how_key, plain_how, runs_by_cell
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "discount": 0.99,
    "components": 4,
    "runs": 30,
    "policies": [10, 80],
    "test_tasks": 6,
    "episodes": 100,
    "early": 10,
    "learning_rate": 0.5,
    "max_steps": [500, 2000],
    "features": ["phi2", "phi3", "phi4"],
    "ties": ["uniform", "prior"],
    "schedules": [[0.1, 1.0, 0.1], [1.0, 0.95, 0.01]],
    "alpha0": [0.1, 1.0],
    "default": {
        "features": "phi3",
        "schedule": [1.0, 0.95, 0.01],
        "ties": "uniform",
        "alpha0": 0.1,
        "max_steps": 2000,
        "policies": 80,
    },
}
QUICK = {
    **FULL,
    "components": 1,
    "runs": 3,
    "policies": [1, 3],
    "test_tasks": 3,
    "episodes": 20,
    "early": 5,
    "max_steps": [100, 200],
    "default": {**FULL["default"], "max_steps": 200, "policies": 3},
}
NUMBERS = ("first", "early", "all", "late", "spread_first", "spread_early", "spread_of_means")

Found = dict[tuple, list[Mapping]]


def _check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "policies", "episodes", "early", "max_steps", "components"))
    check_counts(settings, ("test_tasks",), least=2)  # one task has no deviation across tasks
    check_windows(settings, ("early",))
    check_learning(settings)
    check_among(settings, "features", tuple(PHI))
    check_among(settings, "ties", TIES)
    among = {"ties": "ties", "schedule": "schedules", "features": "features", "alpha0": "alpha0"}
    check_default(settings, {**among, "max_steps": "max_steps", "policies": "policies"})
    if settings["components"] > N_COMPONENTS:
        raise InputError(f"components must be at most {N_COMPONENTS}, got {settings['components']}")
    if min(settings["alpha0"]) <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")


def _by_form(results: Sequence[Mapping]) -> Found:
    """(form, cell of the grid) to its numbers, run by run."""
    return runs_by_cell(results, ("form",), KEYS)


def _of(found: Found, form: str, how: Mapping, key: str) -> np.ndarray:
    how = plain_how(how, KEYS) if form == PLAIN else how
    return np.array([numbers[key] for numbers in found[form, how_key(how, KEYS)]], float)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Every form at the default, what the claim compares there, and shares of the grid."""
    found, default = _by_form(results), default_of(settings, KEYS)
    optimal = np.array([result["optimal"] for result in results])
    measured = {"optimal_reward": mean_estimate(optimal)}
    for form in (PLAIN, *FORMS):
        for key in NUMBERS:
            measured[f"{key}_{_name(form)}"] = mean_estimate(_of(found, form, default, key))
    measured |= _headline(found, default)
    all_of = {form: _of(found, form, default, "all") for form in (PLAIN, PROPORTION, DIRICHLET)}
    apart = all_of[DIRICHLET] - all_of[PROPORTION]
    measured["dirichlet_minus_proportion"] = mean_estimate(apart)
    measured["dirichlet_minus_proportion_of_pay"] = mean_estimate(apart / pay_of(settings["components"]))
    measured["dirichlet_minus_proportion_of_distance"] = ratio_estimate(apart, optimal - all_of[PLAIN])
    return measured | _grid_shares(settings, found)


def pay_of(components: int) -> float:
    """What a finished task pays, the cost of moves left out."""
    rewards = FactoryRewards()
    return 2 * components * rewards.use + rewards.completion


def _name(form: str) -> str:
    return form.replace("10 × ", "ten_").replace(" ", "_")


def _headline(found: Found, default: Mapping) -> dict[str, Estimate]:
    """Proportions and the Dirichlet against the softmax as printed, at the default, paired by run."""
    headline = {}
    for form in (PROPORTION, DIRICHLET):
        for prefix, key in (("", "all"), ("early_", "early"), ("first_", "first")):
            ours, theirs = (_of(found, f, default, key) for f in (form, AS_PRINTED))
            headline[f"{prefix}{form}_minus_softmax"] = jumpstart(ours, theirs)
        for key in ("early", "first"):
            spreads = [_of(found, f, default, f"spread_{key}") for f in (AS_PRINTED, form)]
            headline[f"{key}_spread_ratio_softmax_to_{form}"] = ratio_estimate(*spreads)
    return headline


def _against_proportion(found: Found, how: Mapping, form: str) -> dict[str, Estimate]:
    """A softmax in a cell of the grid: what it earns less, and how much more it spreads, early and paired."""
    early = [_of(found, f, how, "early") for f in (PROPORTION, form)]
    spread = [_of(found, f, how, "spread_early") for f in (form, PROPORTION)]
    return {"early_difference": jumpstart(*early), "early_spread_ratio": ratio_estimate(*spread)}


def _grid_shares(settings: Mapping, found: Found) -> dict[str, Estimate]:
    """Shares of normalisations × cells in which the softmax does worse early, spreads more, and both."""
    compared = [_against_proportion(found, how, form) for how in hows(settings) for form in SOFTMAXES]
    poor = np.array([is_above(c["early_difference"], 0.0) for c in compared])
    spread = np.array([is_above(c["early_spread_ratio"], 1.0) for c in compared])
    return {
        "grid_softmax_poor": share_of(poor),
        "grid_softmax_spread": share_of(spread),
        "grid_softmax_poor_and_spread": share_of(poor & spread),
    }


def _grid_rows(settings: Mapping, found: Found) -> list[dict]:
    grid = []
    for how in hows(settings):
        row = {key: how[key] for key in KEYS}
        for form in (PLAIN, *FORMS):
            row[f"early_{_name(form)}"] = float(_of(found, form, how, "early").mean())
            row[f"spread_early_{_name(form)}"] = float(_of(found, form, how, "spread_early").mean())
        for form in (DIRICHLET, *SOFTMAXES):
            compared = _against_proportion(found, how, form)
            row |= {f"{name}_{_name(form)}": number.to_dict() for name, number in compared.items()}
        grid.append(row)
    return grid


def _curve_rows(settings: Mapping, found: Found) -> list[dict]:
    """The default's curves under every schedule: mean of each episode and deviation across a run's tasks."""
    curves = []
    for schedule in settings["schedules"]:
        how = {**default_of(settings, KEYS), "schedule": schedule}
        for form in (PLAIN, *FORMS):
            key = how_key(plain_how(how, KEYS) if form == PLAIN else how, KEYS)
            kept = {name: [n[name] for n in found[form, key]] for name in ("mean", "deviation")}
            curve = {name: np.mean(values, axis=0).tolist() for name, values in kept.items()}
            curves.append({"curve_of": form, "schedule": schedule, **curve})
    return curves


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default."""
    found = _by_form(results)
    return _grid_rows(settings, found) + _curve_rows(settings, found)


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_11_forms_of_prior.figure_form_curves import draw_form_curves

    return draw_form_curves(result)


CAUSES = {
    "proportion above softmax": "the softmax of large counts is nearly the most frequent best action alone, and "
    "here that is seldom wrong; of proportions, in [0, 1], it is nearly uniform, and poor as the thesis reports",
    "most of the grid": "which way it goes is decided by how counts are normalised before the softmax",
}

CLAIM = Claim(
    id="C3.11",
    title="Proportions, Dirichlet draws and a softmax as action priors (Figure 3.15)",
    thesis="In the modified factory, 4 random components, priors from 80 training policies, 20 runs: proportions "
    "and the Dirichlet perform comparably and outperform the softmax, which performs poorly during the initial "
    "episodes, with a high variance across tasks.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.11"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
