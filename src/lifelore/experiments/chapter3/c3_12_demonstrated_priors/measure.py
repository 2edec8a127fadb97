"""Measures and rows of claim C3.12."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_12_demonstrated_priors.run import (
    KEYS,
    PEOPLE,
    PLAIN,
    SELF,
    SHOWN,
    VARIED,
    WEIGHTS,
    hows,
)
from lifelore.experiments.engine.estimates import is_above, share_of
from lifelore.experiments.engine.open_choices import default_of, how_key, plain_how, runs_by_cell

COMPARABLE = 0.05
Found = dict[tuple, list[Mapping]]


def _by_method(results: Sequence[Mapping]) -> Found:
    """(method, people, weight, cell of the grid) to its numbers, run by run."""
    return runs_by_cell(results, ("method", "people", "weight"), KEYS)


def _of(found: Found, method: tuple, how: Mapping, key: str) -> np.ndarray:
    how = plain_how(how, KEYS) if method[0] == PLAIN else how
    return np.array([numbers[key] for numbers in found[(*method, how_key(how, KEYS))]], float)


_PLAIN, _SELF = (PLAIN, None, None), (SELF, None, None)


def _shown(people: str, weight: str = "equal") -> tuple:
    return (SHOWN, people, weight)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What is compared at the default, every people and weight there, and the share of the grid."""
    found, default = _by_method(results), default_of(settings, KEYS)
    optimal = np.array([result["optimal"] for result in results])
    plain, own = (_of(found, method, default, "all") for method in (_PLAIN, _SELF))
    shown = _of(found, _shown(settings["default"]["people"]), default, "all")
    varied = _of(found, _shown(VARIED), default, "all")
    measured = {
        "optimal_reward": mean_estimate(optimal),
        "shown_minus_self_of_distance": ratio_estimate(shown - own, optimal - plain),
        "shown_minus_uniform": jumpstart(shown, plain),
        "self_minus_uniform": jumpstart(own, plain),
        "varied_minus_uniform": jumpstart(varied, plain),
        "varied_minus_self_of_distance": ratio_estimate(varied - own, optimal - plain),
    }
    for name, method in (("uniform", _PLAIN), ("self", _SELF), ("shown", _shown(settings["default"]["people"]))):
        for key in ("first", "early", "all"):
            measured[f"{key}_{name}"] = mean_estimate(_of(found, method, default, key))
    for people in settings["people"]:
        for weight in WEIGHTS:
            rewards = _of(found, _shown(people, weight), default, "all")
            name = f"{people}_{weight}".replace(" ", "_")
            measured[f"of_distance_{name}"] = ratio_estimate(rewards - own, optimal - plain)
    return measured | _grid(settings, results, found) | _people(settings, results)


def _against_self(
    settings: Mapping, results: Sequence[Mapping], found: Found, how: Mapping
) -> dict[str, Estimate]:
    """The default people's prior in a cell of the grid, beside the self-trained one and none."""
    optimal = np.array([result["optimal"] for result in results])
    methods = (_shown(settings["default"]["people"]), _SELF, _PLAIN)
    shown, own, plain = (_of(found, method, how, "all") for method in methods)
    return {"of_distance": ratio_estimate(shown - own, optimal - plain), "gain": jumpstart(shown, plain)}


def _grid(settings: Mapping, results: Sequence[Mapping], found: Found) -> dict[str, Estimate]:
    compared = [_against_self(settings, results, found, how) for how in hows(settings)]
    near = np.array([is_comparable(c["of_distance"]) for c in compared])
    gains = np.array([is_above(c["gain"], 0.0) for c in compared])
    return {
        "grid_near_self": share_of(near),
        "grid_above_uniform": share_of(gains),
        "grid_comparable": share_of(near & gains),
    }


def is_comparable(number: Estimate) -> bool:
    """Whether the whole interval lies within 5 % of the distance."""
    return number.ci95 is not None and max(map(abs, number.ci95)) <= COMPARABLE


def _people(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Tasks that people gave up, lengths of what they showed, and weights of each by estimated competence."""
    found = {}
    for people in settings["people"]:
        told = [one for result in results for one in result["people"] if one["people"] == people]
        name = people.replace(" ", "_")
        found[f"given_up_{name}"] = mean_estimate([one["given_up"] for one in told])
        found[f"steps_{name}"] = mean_estimate([one["steps"] for one in told])
        for weight in WEIGHTS[1:]:
            for turn, _ in enumerate(PEOPLE[people]):
                agent, ending = f"person {turn}", f"{name}_{turn}_{weight.replace(' ', '_')}"
                values = [one["weights"][weight][agent] for one in told if agent in one["weights"][weight]]
                if values:
                    found[f"weight_{ending}"] = mean_estimate(values)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, the people at the default, then the curves of the default under every schedule."""
    found, default = _by_method(results), default_of(settings, KEYS)
    optimal = np.array([result["optimal"] for result in results])
    plain, own = (_of(found, method, default, "all") for method in (_PLAIN, _SELF))
    table = []
    for how in hows(settings):
        compared = _against_self(settings, results, found, how)
        table.append({**how, **{name: number.to_dict() for name, number in compared.items()}})
    for people in settings["people"]:
        for weight in WEIGHTS:
            rewards = _of(found, _shown(people, weight), default, "all")
            ratio = ratio_estimate(rewards - own, optimal - plain).to_dict()
            table.append(
                {"people": people, "skills": list(PEOPLE[people]), "weight": weight, "of_distance": ratio}
            )
    for schedule in settings["schedules"]:
        how = {**default, "schedule": schedule}
        for method in (_PLAIN, _SELF, _shown(settings["default"]["people"])):
            key = (*method, how_key(plain_how(how, KEYS) if method == _PLAIN else how, KEYS))
            kept = {name: np.mean([n[name] for n in found[key]], axis=0) for name in ("mean", "deviation")}
            curve = {name: np.round(values, 3).tolist() for name, values in kept.items()}
            table.append({"curve_of": method[0], "schedule": schedule, **curve})
    return table
