"""C3.12: priors from 40 demonstrated trajectories beside self-trained priors, in the modified factory (simulated).

The thesis's trajectories were a person's. These are of simulated people of stated skill: what is measured speaks
of them, and people remain untested. One person who knows the task well ("familiar", nine steps of ten taken
knowingly) is the default, as in the thesis; other people, alone and several, with equal weights w(π) and weights
by estimated competence, stand beside. The set of features is not stated and is crossed, φ3 being the default.

Optimal rewards lie near 0 here, so *comparable* is asked of the distance from learning without a prior to the
optimum, as in C3.11. Thesis: §3.4.8, Figure 3.16.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import PHI
from lifelore.domains.factory.factory import N_COMPONENTS
from lifelore.experiments.chapter3.c3_12_demonstrated_priors.shown_priors import (
    KEYS,
    PEOPLE,
    PLAIN,
    SELF,
    SHOWN,
    WEIGHTS,
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
    "runs": 20,
    "trajectories": [10, 40],
    "test_tasks": 4,
    "episodes": 100,
    "early": 10,
    "learning_rate": 0.5,
    "max_steps": 2000,
    "people": list(PEOPLE),
    "features": ["phi1", "phi2", "phi3", "phi4"],
    "ties": ["uniform", "prior"],
    "schedules": [[0.1, 1.0, 0.1], [1.0, 0.95, 0.01]],
    "alpha0": [0.1, 1.0],
    "default": {
        "features": "phi3",
        "schedule": [1.0, 0.95, 0.01],
        "ties": "uniform",
        "alpha0": 0.1,
        "trajectories": 40,
        "people": "familiar",
    },
}
QUICK = {
    **FULL,
    "components": 1,
    "runs": 3,
    "trajectories": [2, 4],
    "test_tasks": 2,
    "episodes": 20,
    "early": 5,
    "max_steps": 200,
    "features": ["phi2", "phi3"],
    "ties": ["uniform"],
    "default": {**FULL["default"], "trajectories": 4},
}
VARIED = "varied"
COMPARABLE = 0.05

Found = dict[tuple, list[Mapping]]


def _check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "trajectories", "episodes", "early", "max_steps", "components"))
    check_counts(settings, ("test_tasks",), least=2)  # one task has no deviation across tasks
    check_windows(settings, ("early",))
    check_learning(settings)
    check_among(settings, "features", tuple(PHI))
    check_among(settings, "ties", TIES)
    check_among(settings, "people", tuple(PEOPLE))
    among = {"ties": "ties", "schedule": "schedules", "features": "features", "alpha0": "alpha0"}
    check_default(settings, {**among, "trajectories": "trajectories", "people": "people"})
    if VARIED not in settings["people"]:
        raise InputError(f"people must hold {VARIED}, got {', '.join(settings['people'])}")
    if settings["components"] > N_COMPONENTS:
        raise InputError(f"components must be at most {N_COMPONENTS}, got {settings['components']}")
    if min(settings["alpha0"]) <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_12_demonstrated_priors.figure_shown_priors import draw_shown_priors

    return draw_shown_priors(result)


CAUSES = {
    "comparable": "a trajectory counts the states it passes, as often as it passes them, and the one action "
    "taken; a policy counts every state and all its best actions",
    "comparable, varied": "people who err show what is not best, too",
}

CLAIM = Claim(
    id="C3.12",
    title="Priors from 40 demonstrated trajectories, of simulated people (Figure 3.16); people untested",
    thesis="In the modified factory, 4 random components, 20 runs: with a prior from trajectories that a person "
    "supplied for 40 random tasks, learning performs comparably to having full prior policies, and better than "
    "with uniform priors, even when they are sub-optimal.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.12"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
