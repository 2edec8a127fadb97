"""Measures and rows of claim C3.11."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_11_forms_of_prior import run
from lifelore.experiments.chapter3.c3_11_forms_of_prior.run import DIRICHLET, FORMS, PROPORTION, WITHOUT_PRIOR
from lifelore.experiments.engine.estimates import is_above, share_of
from lifelore.experiments.engine.results_table import ResultsTable


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What the claim compares at the default, and the share of the grid in which it is so."""
    table, grid = ResultsTable.nested(results, "found", ("form", *run.KEYS)), run.grid_of(settings)
    default, printed = grid.default, {"form": run.AS_PRINTED}
    optimal = np.array([result["optimal"] for result in results])
    measured = {"optimal_reward": mean_estimate(optimal)}
    for form in (PROPORTION, DIRICHLET):
        ours, name = {"form": form}, f"early_spread_ratio_softmax_to_{form}"
        measured[f"{form}_minus_softmax"] = table.difference("all", ours, printed, **default)
        measured[f"early_{form}_minus_softmax"] = table.difference("early", ours, printed, **default)
        measured[name] = table.ratio("spread_early", printed, ours, **default)
    drawn, proportion = table.paired("all", {"form": DIRICHLET}, {"form": PROPORTION}, **default)
    without = table.values("all", form=WITHOUT_PRIOR, **grid.without_prior(default))
    measured["dirichlet_minus_proportion_of_distance"] = ratio_estimate(drawn - proportion, optimal - without)
    size = np.array([result["optimal_size"] for result in results])
    measured["dirichlet_minus_proportion_of_optimal"] = ratio_estimate(drawn - proportion, size)
    compared = [_beside_proportion(table, cell, form) for cell in grid.cells for form in run.SOFTMAXES]
    poor = [is_above(c["early_difference"], 0.0) and is_above(c["early_spread_ratio"], 1.0) for c in compared]
    return measured | {"grid_softmax_poor_and_spread": share_of(poor)}


def _beside_proportion(table: ResultsTable, cell: Mapping, form: str) -> dict[str, Estimate]:
    """In a cell of the grid: how much less a form earns early than proportions, and how much more it spreads."""
    theirs, ours = {"form": form}, {"form": PROPORTION}
    return {
        "early_difference": table.difference("early", ours, theirs, **cell),
        "early_spread_ratio": table.ratio("spread_early", theirs, ours, **cell),
    }


def key_of(form: str) -> str:
    """A form in the name of a number."""
    return form.replace("10 × ", "ten_").replace(" ", "_")


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default under every schedule."""
    table, grid, found = ResultsTable.nested(results, "found", ("form", *run.KEYS)), run.grid_of(settings), []
    for cell in grid.cells:
        row = dict(cell)
        for form in (WITHOUT_PRIOR, *FORMS):
            read = grid.without_prior(cell) if form == WITHOUT_PRIOR else cell
            for name in ("early", "spread_early"):
                row[f"{name}_{key_of(form)}"] = float(table.values(name, form=form, **read).mean())
        for form in (DIRICHLET, *run.SOFTMAXES):
            compared = _beside_proportion(table, cell, form)
            row |= {f"{name}_{key_of(form)}": number.to_dict() for name, number in compared.items()}
        found.append(row)
    for schedule in settings["schedules"]:
        for form in (WITHOUT_PRIOR, *FORMS):
            cell = grid.with_schedule(schedule)
            read = grid.without_prior(cell) if form == WITHOUT_PRIOR else cell
            curve = {n: table.values(n, form=form, **read).mean(axis=0).tolist() for n in ("mean", "deviation")}
            found.append({"curve_of": form, "schedule": schedule, **curve})
    return found
