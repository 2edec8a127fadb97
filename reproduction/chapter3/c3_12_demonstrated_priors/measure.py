"""Measures and rows of claim C3.12."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter3.c3_12_demonstrated_priors import run
from reproduction.chapter3.c3_12_demonstrated_priors.run import PEOPLE, SELF, SHOWN, WEIGHTS, WITHOUT_PRIOR
from reproduction.engine.estimates import is_above, share_of
from reproduction.engine.results_table import ResultsTable

COMPARABLE = 0.05


class Compared:
    """The results as tables, and a prior's rewards beside those of the self-trained one and of none."""

    def __init__(self, settings: Mapping, results: Sequence[Mapping]) -> None:
        self.grid = run.grid_of(settings)
        self.table = ResultsTable.nested(results, "found", ("method", *run.KEYS))
        self.groups = ResultsTable.nested(results, "groups", ("people", "weight"))
        self.optimal = np.array([result["optimal"] for result in results])
        self.size = np.array([result["optimal_size"] for result in results])

    def rewards(self, method: str, cell: Mapping, measure: str = "all") -> np.ndarray:
        """A method's mean reward of an episode in a cell of the grid, run by run."""
        read = self.grid.without_prior(cell) if method == WITHOUT_PRIOR else cell
        return self.table.values(measure, method=method, **read)

    def of_distance(self, rewards: np.ndarray, cell: Mapping) -> Estimate:
        """Rewards minus those of the self-trained prior, over the distance from no prior to the optimum."""
        distance = self.optimal - self.rewards(WITHOUT_PRIOR, cell)
        return ratio_estimate(rewards - self.rewards(SELF, cell), distance)

    def of_optimal(self, rewards: np.ndarray, cell: Mapping) -> Estimate:
        """Rewards minus those of the self-trained prior, over the absolute value of the optimal reward."""
        return ratio_estimate(rewards - self.rewards(SELF, cell), self.size)

    def gain(self, rewards: np.ndarray, cell: Mapping) -> Estimate:
        """Rewards minus those without a prior."""
        return mean_estimate(rewards - self.rewards(WITHOUT_PRIOR, cell))

    def shown(self, cell: Mapping) -> dict[str, Estimate]:
        """The default person's prior in a cell of the grid."""
        rewards = self.rewards(SHOWN, cell)
        return {"of_distance": self.of_distance(rewards, cell), "gain": self.gain(rewards, cell)}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Priors compared at the default and over the grid, and the people's demonstrations."""
    compared = Compared(settings, results)
    default = compared.grid.default
    varied = compared.groups.values("all", people=run.VARIED, weight="equal")
    shown = compared.shown(default)
    measured = {
        "optimal_reward": mean_estimate(compared.optimal),
        "shown_minus_self_of_distance": shown["of_distance"],
        "shown_minus_uniform": shown["gain"],
        "self_minus_uniform": compared.gain(compared.rewards(SELF, default), default),
        "varied_minus_uniform": compared.gain(varied, default),
        "varied_minus_self_of_distance": compared.of_distance(varied, default),
        "shown_minus_self_of_optimal": compared.of_optimal(compared.rewards(SHOWN, default), default),
        "varied_minus_self_of_optimal": compared.of_optimal(varied, default),
    }
    for name, method in (("uniform", WITHOUT_PRIOR), ("self", SELF), ("shown", SHOWN)):
        measured[f"early_{name}"] = mean_estimate(compared.rewards(method, default, "early"))
        measured[f"all_{name}"] = mean_estimate(compared.rewards(method, default))
    grid = [compared.shown(cell) for cell in compared.grid.cells]
    good = [is_comparable(cell["of_distance"]) and is_above(cell["gain"], 0.0) for cell in grid]
    of_optimal = [compared.of_optimal(compared.rewards(SHOWN, cell), cell) for cell in compared.grid.cells]
    strict = [is_comparable(x) and is_above(cell["gain"], 0.0) for x, cell in zip(of_optimal, grid, strict=True)]
    shares = {"grid_comparable": share_of(good), "grid_comparable_of_optimal": share_of(strict)}
    return measured | shares | _demonstrations(settings, results)


def is_comparable(number: Estimate) -> bool:
    """Whether the whole interval lies within 5 % of what the number is a share of."""
    return number.ci95 is not None and max(map(abs, number.ci95)) <= COMPARABLE


def _demonstrations(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Tasks given up, lengths of the demonstrations, and each person's weight by estimated competence."""
    table, found = ResultsTable.nested(results, "people", ("people",)), {}
    for people in settings["people"]:
        name = people.replace(" ", "_")
        found[f"given_up_{name}"] = table.mean("given_up", people=people)
        found[f"steps_{name}"] = table.mean("steps", people=people)
        for weight, turn in product(WEIGHTS[1:], range(len(PEOPLE[people]))):
            weights = [group["weights"][weight] for group in table.select(people=people).records]
            values = [of_run[f"person {turn}"] for of_run in weights if f"person {turn}" in of_run]
            if values:
                found[f"weight_{name}_{turn}_{weight.replace(' ', '_')}"] = mean_estimate(values)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, the people at the default, then the curves of the default under every schedule."""
    compared, found = Compared(settings, results), []
    for cell in compared.grid.cells:
        numbers = compared.shown(cell)
        found.append({**cell, **{name: number.to_dict() for name, number in numbers.items()}})
    for people, weight in product(settings["people"], WEIGHTS):
        rewards = compared.groups.values("all", people=people, weight=weight)
        ratio = compared.of_distance(rewards, compared.grid.default).to_dict()
        found.append({"people": people, "skills": list(PEOPLE[people]), "weight": weight, "of_distance": ratio})
    for cell in map(compared.grid.with_schedule, settings["schedules"]):
        for method in (WITHOUT_PRIOR, SELF, SHOWN):
            curve = {n: compared.rewards(method, cell, n).mean(axis=0).round(3) for n in ("mean", "deviation")}
            curve = {name: values.tolist() for name, values in curve.items()}
            found.append({"curve_of": method, "schedule": cell["schedule"], **curve})
    return found
