"""Priors from demonstrated trajectories beside self-trained ones, in modified factories (§3.4.8, Figure 3.16).

The thesis's demonstrator was a person. Here people are simulated, each with a skill: the share of steps taken
knowingly. A run draws training factories with lists of components; each is shown once, by the people in turn, and
solved exactly for the self-trained prior. A trajectory counts an action for each visit, a policy its tied best
actions in every state. Everything compared meets the same factories, lists and random numbers of its own.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.competence import competence_by_paths, competence_by_steps
from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.demonstrations.simulated_person import simulated_demonstration
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import TIES, prior_rows
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import Rows, uniform_rows
from lifelore.core.mdp import Tables
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import PHI, feature_codes, features
from lifelore.domains.factory.factory import ACTION_NAMES, N_COMPONENTS, FactoryTask
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.experiments.chapter3.factory_forms import Met, best_of, learn_task, optimal_reward
from lifelore.experiments.chapter3.lattice_learning import schedule_of
from lifelore.experiments.engine.learning_settings import (
    check_among,
    check_counts,
    check_default,
    check_learning,
    check_windows,
)
from lifelore.experiments.engine.open_choices import default_of, how_key, is_default_but_for_schedule, plain_how

PLAIN, SELF, SHOWN = "uniform", "self-trained", "shown"
WEIGHTS = ("equal", "by steps", "by ways")
"""w(π) of a person: 1, the share of best steps corrected for chance, or the length of ways beside known ones."""
PEOPLE = {
    "expert": (1.0,),
    "familiar": (0.9,),
    "varied": (1.0, 0.9, 0.7, 0.5),
    "one in four": (1.0, 0.3, 0.3, 0.3),
    "poor": (0.5,),
}
"""Skills of those who show, in turn."""
KEYS = ("features", "schedule", "ties", "alpha0", "trajectories")
"""The choices left open that make a cell of the grid."""
PATIENCE = 4000
"""Steps after which a person gives up."""


class Shown(NamedTuple):
    """A training task: exact best actions, codes of its states by set of features, each people's demonstration."""

    best: NDArray[np.bool_]
    codes: dict[str, NDArray[np.int64]]
    by: dict[str, Demonstration | None]


class Run(NamedTuple):
    """Training tasks in order, each people's w(π) by kind of weight, and test tasks."""

    training: list[Shown]
    weights: dict[tuple[str, str], dict[str, float]]
    testing: list[Met]


def run_of(settings: Mapping, seed: int, number: int) -> Run:
    """Run `number`."""
    own = (seed, "C3.12", number)
    training = [_shown(settings, (*own, "training", i), i) for i in range(max(settings["trajectories"]))]
    weights = {}
    for people in settings["people"]:
        done = [shown.by[people] for shown in training]
        done = [one for one in done if one]
        best = {str(i): shown.best for i, shown in enumerate(training)}
        weights[people, "equal"] = dict.fromkeys({one.agent for one in done}, 1.0)
        weights[people, "by steps"] = competence_by_steps(done, lambda name, b=best: b[name])
        weights[people, "by ways"] = competence_by_paths(done)
    return Run(training, weights, [_met(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])])


def _task(settings: Mapping, names: tuple) -> FactoryTask:
    random = stream(*names, "factory")
    floor = modified_factory(random, settings["discount"])
    return floor.task(floor.draw_components(random, settings["components"]))


def _codes(settings: Mapping, task: FactoryTask) -> dict[str, NDArray[np.int64]]:
    seen = features(task)
    return {name: feature_codes(seen, name) for name in settings["features"]}


def _shown(settings: Mapping, names: tuple, number: int) -> Shown:
    task = _task(settings, names)
    tables, best = task.tables(), best_of(task)
    by = {p: show(tables, best, PEOPLE[p], number, (*names, p)) for p in settings["people"]}
    return Shown(best, _codes(settings, task), by)


def show(tables: Tables, best, skills: Sequence[float], number: int, names: tuple) -> Demonstration | None:
    """Task `number`, shown by whose turn it is; None where that person gives up."""
    turn = number % len(skills)
    return simulated_demonstration(
        tables, best, skills[turn], stream(*names, "person"),
        task=str(number), agent=f"person {turn}", most_steps=PATIENCE,
    )  # fmt: skip


def _met(settings: Mapping, names: tuple) -> Met:
    task = _task(settings, names)
    tables = task.tables()
    return Met(tables, names, _codes(settings, task), optimal_reward(tables, task.optimal_q(tables)))


def self_trained(run: Run, how: Mapping) -> ActionPrior:
    """From the exact policies of the training tasks, every state counted (Eq. 3.7)."""
    prior = ActionPrior(len(ACTION_NAMES), how["alpha0"])
    for shown in run.training[: how["trajectories"]]:
        prior.update(shown.codes[how["features"]], shown.best)
    return prior


def from_shown(run: Run, how: Mapping, people: str, weight: str) -> ActionPrior:
    """From what people showed, each step weighed by who took it (Eq. 3.3)."""
    prior = ActionPrior(len(ACTION_NAMES), how["alpha0"])
    done = [shown.by[people] for shown in run.training[: how["trajectories"]]]
    count_demonstrations(
        prior,
        [one for one in done if one],
        lambda one: run.training[int(one.task)].codes[how["features"]][one.states],
        run.weights[people, weight],
    )
    return prior


def hows(settings: Mapping) -> list[dict]:
    """The grid: features × ε × ties, and every other α⁰ and number of trajectories, one at a time."""
    default = default_of(settings, KEYS)
    crossed = product(settings["features"], settings["schedules"], settings["ties"])
    grid = [{**default, "features": f, "schedule": s, "ties": t} for f, s, t in crossed]
    sizes = [(key, n) for key in ("alpha0", "trajectories") for n in settings[key] if n != default[key]]
    return grid + [{**default, key: n} for key, n in sizes]


def cells(settings: Mapping) -> list[dict]:
    """A run each."""
    return [{"run": number} for number in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: no prior, self-trained and the default people in every cell; all people at the default."""
    run = run_of(settings, seed, cell["run"])
    optimal = float(np.mean([met.optimal for met in run.testing]))
    return {
        **cell,
        "optimal": optimal,
        "found": list(_all_found(settings, run)),
        "people": _of_people(settings, run),
    }


def _of_people(settings: Mapping, run: Run) -> list[dict]:
    """How many tasks were shown, how long, and how each people's members were weighed."""
    found = []
    for people in settings["people"]:
        done = [shown.by[people] for shown in run.training]
        steps = [len(one.states) for one in done if one]
        weights = {w: dict(sorted(run.weights[people, w].items())) for w in WEIGHTS}
        found.append(
            {"people": people, "given_up": len(done) - len(steps), "steps": sum(steps), "weights": weights}
        )
    return found


def _all_found(settings: Mapping, run: Run) -> Iterator[dict]:
    default = default_of(settings, KEYS)

    def numbers(how: Mapping, rows_for) -> dict:
        schedule = schedule_of(settings, how["schedule"])
        rewards = np.array([learn_task(met, rows_for(met), schedule) for met in run.testing])
        found = {"all": float(rewards.mean()), "first": float(rewards[:, 0].mean())}
        found["early"] = float(rewards[:, : settings["early"]].mean())
        if is_default_but_for_schedule(how, settings, KEYS):
            found |= {"mean": rewards.mean(axis=0).tolist(), "deviation": rewards.std(axis=0, ddof=1).tolist()}
        return found

    def with_prior(how: Mapping, prior: ActionPrior) -> dict:
        return numbers(how, lambda met: rows_of(met, prior, how))

    plain = {how_key(how, KEYS): how for how in (plain_how(h, KEYS) for h in hows(settings))}
    for how in plain.values():
        yield {"method": PLAIN, **how, **numbers(how, lambda met: uniform_rows(met.tables))}
    for how in hows(settings):
        yield {"method": SELF, **how, **with_prior(how, self_trained(run, how))}
        methods = [(settings["default"]["people"], "equal")]
        if how_key(how, KEYS) == how_key(default, KEYS):
            methods = list(product(settings["people"], WEIGHTS))
        for people, weight in methods:
            found = with_prior(how, from_shown(run, how, people, weight))
            yield {"method": SHOWN, "people": people, "weight": weight, **how, **found}


def rows_of(met: Met, prior: ActionPrior, how: Mapping) -> Rows:
    """Rows of ε-QPAP with the proportion form."""
    return prior_rows(met.tables, met.codes[how["features"]], prior.probs, how["ties"])


VARIED = "varied"


def check(settings: Mapping) -> None:
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
