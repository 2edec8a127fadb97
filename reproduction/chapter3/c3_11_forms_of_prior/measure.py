"""Measures and rows of claim C3.11."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter3.c3_11_forms_of_prior import run
from reproduction.chapter3.c3_11_forms_of_prior.run import DIRICHLET, FORMS, PROPORTION, WITHOUT_PRIOR
from reproduction.engine.estimates import interval_or_value, is_above, share_of
from reproduction.engine.results_table import ResultsTable

COMPARABLE = "dirichlet_minus_proportion_of_optimal"
ABOVE_0, ABOVE_1 = (0.0, np.inf), (1.0, np.inf)
BOUNDS = {
    COMPARABLE: (-0.05, 0.05),
    "proportion_minus_softmax": ABOVE_0,
    "dirichlet_minus_softmax": ABOVE_0,
    "early_proportion_minus_softmax": ABOVE_0,
    "early_dirichlet_minus_softmax": ABOVE_0,
    "early_spread_ratio_softmax_to_proportion": ABOVE_1,
    "early_spread_ratio_softmax_to_dirichlet": ABOVE_1,
}
"""What the thesis's sentence asks of the numbers of a cell: the bounds of the second reading's headline."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What the claim compares at the default, and the shares of the grid in which it is so."""
    table, grid = ResultsTable.nested(results, "found", ("form", *run.KEYS)), run.grid_of(settings)
    optimal, size = (np.array([result[key] for result in results]) for key in ("optimal", "optimal_size"))
    measured = {"optimal_reward": mean_estimate(optimal), **sentence(table, grid.default, size)}
    drawn, proportion = table.paired("all", {"form": DIRICHLET}, {"form": PROPORTION}, **grid.default)
    without = table.values("all", form=WITHOUT_PRIOR, **grid.without_prior(grid.default))
    measured["dirichlet_minus_proportion_of_distance"] = ratio_estimate(drawn - proportion, optimal - without)
    compared = [_beside_proportion(table, cell, form) for cell in grid.cells for form in run.SOFTMAXES]
    poor = [is_above(c["early_difference"], 0.0) and is_above(c["early_spread_ratio"], 1.0) for c in compared]
    measured["grid_softmax_poor_and_spread"] = share_of(poor)
    return measured | _grid_shares([sentence(table, cell, size) for cell in grid.cells])


def sentence(table: ResultsTable, cell: Mapping, size: NDArray[np.float64]) -> dict[str, Estimate]:
    """The numbers of the thesis's sentence in a cell of the grid, with the softmax as printed.

    `size` (n_runs,) are the absolute values of the optimal reward.
    """
    found, printed = {}, {"form": run.AS_PRINTED}
    for form in (PROPORTION, DIRICHLET):
        ours, name = {"form": form}, f"early_spread_ratio_softmax_to_{form}"
        found[f"{form}_minus_softmax"] = table.difference("all", ours, printed, **cell)
        found[f"early_{form}_minus_softmax"] = table.difference("early", ours, printed, **cell)
        found[name] = table.ratio("spread_early", printed, ours, **cell)
    drawn, proportion = table.paired("all", {"form": DIRICHLET}, {"form": PROPORTION}, **cell)
    return found | {COMPARABLE: ratio_estimate(drawn - proportion, size)}


def _grid_shares(cells: Sequence[Mapping[str, Estimate]]) -> dict[str, Estimate]:
    """Shares of the cells in which the `sentence` is so, and its parts on the softmax alone; then by means."""
    certain = [{name: lies_in(interval_or_value(cell[name]), BOUNDS[name]) for name in BOUNDS} for cell in cells]
    by_means = [all(lies_in([cell[name].value], BOUNDS[name]) for name in BOUNDS) for cell in cells]
    below = [all(answers[name] for name in BOUNDS if name != COMPARABLE) for answers in certain]
    return {
        "grid_printed_sentence": share_of([all(answers.values()) for answers in certain]),
        "grid_printed_softmax_below": share_of(below),
        "grid_printed_sentence_by_means": share_of(by_means),
    }


def lies_in(ends: Sequence[float], bounds: tuple[float, float]) -> bool:
    """Whether a number, or both ends of its interval, lie between two bounds."""
    return all(bounds[0] < end < bounds[1] for end in ends)


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
