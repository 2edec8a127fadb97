"""Measures and rows of claim C3.4."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_04_factory_priors.run import is_default, makes, uses
from lifelore.experiments.chapter3.factory_gains import band
from lifelore.experiments.engine.curve_blocks import block_edges

INVARIANCES = {
    "wall moves": False,
    "express routes": True,
    "uses elsewhere": False,
    "procurement first": True,
    "then assembly": True,
}
"""The invariances of §3.4.2 by name, and whether a prior that has learnt them favours or shuns the actions."""
MARGIN = -0.05
"""As good as: at most 5 % of the optimal reward below."""


def _key(method: Mapping) -> tuple:
    schedule = tuple(method["schedule"])
    return (method["prior"], method["encoding"], method["alpha0"], method["ties"], schedule)


def _columns(results: Sequence[Mapping], number: str) -> dict[tuple, np.ndarray]:
    """A number of each method over the runs."""
    found: dict[tuple, list] = {}
    for result in results:
        for method in result["methods"]:
            found.setdefault(_key(method), []).append(method[number])
    return {key: np.array(values, float) for key, values in found.items()}


def _uniform(schedule: Sequence[float]) -> tuple:
    return ("uniform", None, None, None, tuple(schedule))


def _of(make: Mapping, use: Mapping) -> tuple:
    return _key({**use, **make})


def _named(make: Mapping) -> str:
    return make["encoding"] or make["prior"]


def _hand_made(name: str, use: Mapping) -> tuple:
    return _of({"prior": name, "encoding": None}, use)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The headline at the default, every encoding beside it, the invariances, and the shares of the grid."""
    return {
        **_headline(settings, results),
        **_each_make(settings, results),
        **_invariances(settings, results),
        **_grid_shares(settings, results),
    }


def _headline(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    default = settings["default"]
    early, last, greedy = (_columns(results, number) for number in ("early", "last", "greedy"))
    reward = np.array([r["optimal_reward"] for r in results])
    learnt = _of({"prior": "learnt", "encoding": default["encoding"]}, default)
    expert, incorrect = _hand_made("expert", default), _hand_made("incorrect", default)
    uniform = _uniform(default["schedule"])
    returns = np.array([r["optimal_return"] for r in results])
    return {
        "learnt_minus_expert_of_optimal": mean_estimate((early[learnt] - early[expert]) / reward),
        "learnt_minus_incorrect": mean_estimate(early[learnt] - early[incorrect]),
        "learnt_minus_uniform": mean_estimate(early[learnt] - early[uniform]),
        "expert_minus_incorrect": mean_estimate(early[expert] - early[incorrect]),
        "incorrect_minus_uniform": mean_estimate(early[incorrect] - early[uniform]),
        "last_incorrect_minus_uniform_of_optimal": mean_estimate((last[incorrect] - last[uniform]) / reward),
        "greedy_incorrect_of_optimal": ratio_estimate(greedy[incorrect], returns),
        "greedy_uniform_of_optimal": ratio_estimate(greedy[uniform], returns),
        "greedy_learnt_of_optimal": ratio_estimate(greedy[learnt], returns),
        "optimal_reward": mean_estimate(reward),
        "test_task_seen": mean_estimate([float(r["seen"]) for r in results]),
    }


def _each_make(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """First, early and last rewards of every make used in the default's way; each encoding against the expert."""
    default, found = settings["default"], {}
    keys = {"uniform": _uniform(default["schedule"])}
    keys |= {_named(make): _of(make, default) for make in makes(settings)}
    for number in ("first", "early", "last"):
        column = _columns(results, number)
        found |= {f"{number}_{name}": mean_estimate(column[key]) for name, key in keys.items()}
    early = _columns(results, "early")
    for encoding in settings["encodings"]:
        found[f"{encoding}_minus_expert"] = mean_estimate(early[keys[encoding]] - early[keys["expert"]])
        for which in ("all", "way"):
            unseen = [r["unseen"][encoding][which] for r in results]
            found[f"unseen_{which}_{encoding}"] = mean_estimate(unseen)
    return found


def _invariances(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The learnt prior's mass on each and a uniform one's, and the share on which it is as it should be."""
    learnt = settings["default"]["encoding"]
    found, right = {}, []
    for name, wanted in INVARIANCES.items():
        mass, even = (np.array([r["masses"][make][name] for r in results]) for make in (learnt, "uniform"))
        told = mean_estimate(mass - even)
        right.append(_beyond(told, above=0.0) if wanted else _beyond(told, below=0.0))
        words = name.replace(" ", "_")
        found[f"mass_{words}"], found[f"mass_{words}_uniform"] = mean_estimate(mass), mean_estimate(even)
    found["invariances_learnt"] = _share(right)
    return found


def _beyond(number: Estimate, above: float | None = None, below: float | None = None) -> bool:
    """Whether the whole interval lies above, or below; without one, whether the value does."""
    low, high = number.ci95 or (number.value, number.value)
    return low > above if above is not None else high < below  # type: ignore[operator]


def _share(truths: Sequence[bool]) -> Estimate:
    values = np.array(truths, float)
    return Estimate(float(values.mean()), float(np.median(values)), None, len(values))


def _grid_shares(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of the grid's cells, encoding × α⁰ × ties × schedule, in which each step of the order is found."""
    early = _columns(results, "early")
    reward = np.array([r["optimal_reward"] for r in results])
    truths: dict[str, list[bool]] = {}
    for use in uses(settings):
        expert, incorrect = early[_hand_made("expert", use)], early[_hand_made("incorrect", use)]
        uniform = early[_uniform(use["schedule"])]
        expert_first = _beyond(mean_estimate(expert - incorrect), above=0.0)
        incorrect_next = _beyond(mean_estimate(incorrect - uniform), above=0.0)
        for encoding in settings["encodings"]:
            learnt = early[_of({"prior": "learnt", "encoding": encoding}, use)]
            learnt_first = _at_least(mean_estimate((learnt - expert) / reward), MARGIN)
            cell = {
                "learnt_as_good_as_expert": learnt_first,
                "expert_above_incorrect": expert_first,
                "incorrect_above_uniform": incorrect_next,
                "learnt_above_uniform": _beyond(mean_estimate(learnt - uniform), above=0.0),
                "order": learnt_first and expert_first and incorrect_next,
            }
            for name, truth in cell.items():
                truths.setdefault(name, []).append(truth)
    return {f"grid_{name}": _share(found) for name, found in truths.items()}


def _at_least(number: Estimate, bound: float) -> bool:
    return (number.ci95[0] if number.ci95 else number.value) >= bound


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, the curves of the default's use, the masses of every make, and one run's prior as drawn."""
    return [
        *_grid_rows(settings, results),
        *_curve_rows(settings, results),
        *_mass_rows(results),
        *({"drawn": r["drawn"]} for r in results if "drawn" in r),
    ]


def _grid_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Early reward of each method, and the loss against the optimal reward as a ratio to Q-learning's."""
    early, last = _columns(results, "early"), _columns(results, "last")
    reward = np.array([r["optimal_reward"] for r in results])
    found = []
    for key, values in early.items():
        loss = ratio_estimate(reward - values, reward - early[_uniform(key[4])])
        how = dict(zip(("prior", "encoding", "alpha0", "ties"), key[:4], strict=True))
        numbers = {"early": mean_estimate(values), "last": mean_estimate(last[key]), "loss_ratio": loss}
        plain = {name: number.to_dict() for name, number in numbers.items()}
        found.append({**how, "schedule": list(key[4]), **plain})
    return found


def _curve_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean curves of the default's use in blocks of episodes."""
    found = [{"curve_edges": block_edges(settings["episodes"]).tolist()}]
    for i, how in enumerate(results[0]["methods"]):
        if is_default(settings, how):
            curves = np.array([r["methods"][i]["curve"] for r in results])
            found.append({"curve_of": how["prior"], "encoding": how["encoding"], **band(curves)})
    return found


def _mass_rows(results: Sequence[Mapping]) -> list[dict]:
    found = []
    for make in results[0]["masses"]:
        for name in INVARIANCES:
            masses = [r["masses"][make][name] for r in results if name in r["masses"][make]]
            if masses:
                found.append({"mass_on": name, "of": make, "mass": mean_estimate(masses).to_dict()})
    return found
