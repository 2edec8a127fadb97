"""Measures and rows of claim C3.11."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.factory import FactoryRewards
from lifelore.experiments.chapter3.factory_forms import (
    AS_PRINTED,
    DIRICHLET,
    FORMS,
    KEYS,
    PLAIN,
    PROPORTION,
    SOFTMAXES,
    hows,
)
from lifelore.experiments.engine.estimates import is_above, share_of
from lifelore.experiments.engine.open_choices import default_of, how_key, plain_how, runs_by_cell

NUMBERS = ("first", "early", "all", "late", "spread_first", "spread_early", "spread_of_means")
Found = dict[tuple, list[Mapping]]


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
