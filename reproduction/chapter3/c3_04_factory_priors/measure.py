"""Measures and rows of claim C3.4."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter3.c3_04_factory_priors.run import ADVICE, stages_of
from reproduction.chapter3.factory.learning import KEYS, LEARNT, PLAIN, grid_of
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.estimates import exact_share, interval_or_value, share_of
from reproduction.engine.results_table import BAND, ResultsTable

INVARIANCES = {
    "wall moves": False,
    "express routes": True,
    "uses elsewhere": False,
    "procurement first": True,
    "then assembly": True,
}
"""The invariances of §3.4.2; whether a prior that has learnt one favours its actions (else it avoids them)."""
MARGIN = -0.05
"""As good as: at most 5 % of the optimal reward below."""
PRIORS = (PLAIN, *ADVICE, LEARNT)


def _table(results: Sequence[Mapping]) -> ResultsTable:
    return ResultsTable.nested(results, "methods", keys=("prior", *KEYS), outer=("run",))


def _column(results: Sequence[Mapping], key: str) -> NDArray[np.float64]:
    return np.array([result[key] for result in results], float)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The comparisons at the default, shares of states without counts, the invariances, and shares of the grid."""
    table, grid = _table(results), grid_of(settings, ADVICE)
    reward, optimal = (_column(results, key) for key in ("optimal_reward", "optimal_return"))
    at = {prior: grid.where(prior, grid.default, "prior") for prior in PRIORS}
    numbers = ("early", "last", "greedy")
    early, last, greedy = ({prior: table.values(name, **at[prior]) for prior in PRIORS} for name in numbers)
    measured = {
        "learnt_minus_expert_of_optimal": mean_estimate((early[LEARNT] - early["expert"]) / reward),
        "learnt_minus_uniform": mean_estimate(early[LEARNT] - early[PLAIN]),
        "expert_minus_incorrect": mean_estimate(early["expert"] - early["incorrect"]),
        "incorrect_minus_uniform": mean_estimate(early["incorrect"] - early[PLAIN]),
        "last_incorrect_minus_uniform_of_optimal": mean_estimate((last["incorrect"] - last[PLAIN]) / reward),
        "optimal_reward": mean_estimate(reward),
        "test_task_seen": mean_estimate(_column(results, "seen")),
    }
    for prior in ("incorrect", PLAIN, LEARNT):
        measured[f"greedy_{prior}_of_optimal"] = ratio_estimate(greedy[prior], optimal)
    for encoding, states in product(settings["encodings"], ("all", "way")):
        measured[f"unseen_{states}_{encoding}"] = mean_estimate([r["unseen"][encoding][states] for r in results])
    measured |= _learnt_on(results, reward, optimal)
    return measured | _invariances(settings, results) | _grid_shares(settings, table, reward)


def stays_near(greedy: ArrayLike, optimal: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether greedy returns (n_runs, n_stages) are within 5 % of the optimum (n_runs,) from each stage on."""
    near = np.asarray(greedy) >= (1 + MARGIN) * optimal[:, None]
    return np.logical_and.accumulate(near[:, ::-1], axis=1)[:, ::-1]


def share_learnt(greedy: ArrayLike, optimal: NDArray[np.float64]) -> Estimate:
    """The share of runs that stay within 5 % of the optimum from a stage before the last one on."""
    return exact_share(stays_near(greedy, optimal)[:, -2])


def _learnt_on(results: Sequence[Mapping], reward: NDArray, optimal: NDArray) -> dict[str, Estimate]:
    """Each prior learnt on: the share of runs that have learnt by the end, and what is earned there.

    The optimistic learner has the incorrect prior, and a Q that starts above every return.
    """
    found = {"share_learnt_optimistic": share_learnt([r["optimistic"] for r in results], optimal)}
    last = {prior: np.array([r["long"][prior]["last"] for r in results]) for prior in PRIORS}
    for prior in PRIORS:
        greedy = [r["long"][prior]["greedy"] for r in results]
        found[f"share_learnt_{prior}"] = share_learnt(greedy, optimal)
        found[f"long_greedy_{prior}_of_optimal"] = ratio_estimate([of_run[-1] for of_run in greedy], optimal)
    difference = ratio_estimate(last["incorrect"] - last[PLAIN], reward)
    return found | {"long_incorrect_minus_uniform_of_optimal": difference}


def _invariances(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The share of the invariances on which the learnt prior's mass lies on the right side of a uniform one's."""
    right = []
    for name, favoured in INVARIANCES.items():
        priors = (settings["default"]["encoding"], PLAIN)
        learnt, even = (np.array([r["masses"][prior][name] for r in results]) for prior in priors)
        low, high = interval_or_value(mean_estimate(learnt - even))
        right.append(low > 0 if favoured else high < 0)
    return {"invariances_learnt": share_of(right)}


def _grid_shares(settings: Mapping, table: ResultsTable, reward: NDArray[np.float64]) -> dict[str, Estimate]:
    """Shares of the grid's cells in which each step of the order is found, by the ends of the intervals."""
    grid, answers = grid_of(settings, ADVICE), []
    for cell in grid.cells:
        early = {prior: table.values("early", **grid.where(prior, cell, "prior")) for prior in PRIORS}
        low = {
            "learnt_as_good_as_expert": (early[LEARNT] - early["expert"]) / reward,
            "expert_above_incorrect": early["expert"] - early["incorrect"],
            "incorrect_above_uniform": early["incorrect"] - early[PLAIN],
            "learnt_above_uniform": early[LEARNT] - early[PLAIN],
        }
        low = {name: interval_or_value(mean_estimate(values))[0] for name, values in low.items()}
        found = {name: end > 0 for name, end in low.items()}
        found["learnt_as_good_as_expert"] = low["learnt_as_good_as_expert"] >= MARGIN
        found["order"] = all(truth for name, truth in found.items() if name != "learnt_above_uniform")
        answers.append(found)
    return {f"grid_{name}": share_of([found[name] for found in answers]) for name in answers[0]}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, the curves of the default's use, masses of every prior, and the prior drawn in the figure."""
    table, grid = _table(results), grid_of(settings, ADVICE)
    reward, found = _column(results, "optimal_reward"), []
    for prior in PRIORS:
        for cell in grid.cells_of(prior):
            where = {"prior": prior, **cell}
            early, plain = (table.values("early", **w) for w in (where, grid.where(PLAIN, cell, "prior")))
            numbers = {name: table.mean(name, **where).to_dict() for name in ("early", "last")}
            loss = ratio_estimate(reward - early, reward - plain).to_dict()
            found.append({**where, **numbers, "loss_ratio": loss})
    found.append({"curve_edges": block_edges(settings["episodes"]).tolist()})
    shown = [(prior, grid.default) for prior in (PLAIN, *ADVICE)]
    for prior, cell in [*shown, *((LEARNT, {**grid.default, "encoding": e}) for e in settings["encodings"])]:
        where = grid.where(prior, cell, "prior")
        curve = table.curve("curve", parts=BAND, **where)
        found.append({"curve_of": prior, "encoding": where["encoding"], **curve})
    found += [_stages_row(settings, results, prior) for prior in PRIORS]
    for prior, name in product(results[0]["masses"], INVARIANCES):
        masses = [r["masses"][prior][name] for r in results if name in r["masses"][prior]]
        if masses:
            found.append({"mass_on": name, "of": prior, "mass": mean_estimate(masses).to_dict()})
    return found + [{"drawn": r["drawn"]} for r in results if "drawn" in r]


def _stages_row(settings: Mapping, results: Sequence[Mapping], prior: str) -> dict:
    """A prior learnt on, by stage: rewards, the policy's return, and the share of runs that have learnt."""
    rewards, greedy = (np.array([r["long"][prior][name] for r in results]) for name in ("rewards", "greedy"))
    optimal = _column(results, "optimal_return")
    return {
        "learnt_on": prior,
        "stages": stages_of(settings),
        "rewards": rewards.mean(axis=0).round(2).tolist(),
        "greedy_of_optimal": (greedy.mean(axis=0) / optimal.mean()).round(4).tolist(),
        "share_learnt": stays_near(greedy, optimal).mean(axis=0).round(4).tolist(),
    }
