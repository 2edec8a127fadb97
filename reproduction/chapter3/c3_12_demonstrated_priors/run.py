"""C3.12: priors from demonstrated trajectories beside self-trained ones, in modified factories.

The thesis's demonstrator was a person. Here people are simulated, each with a skill: the share of steps taken
knowingly. A run draws training factories with lists of components; each is demonstrated once, by the people in
turn, and solved exactly for the self-trained prior. A trajectory counts an action for each visit, a policy its
tied best actions in every state. All priors meet the same factories, lists and random numbers. Optimal rewards
lie near 0; *comparable* is relative to the distance from learning without a prior to the optimum, as in C3.11.
Thesis: §3.4.8, Figure 3.16.
"""

from collections.abc import Mapping
from itertools import product
from typing import NamedTuple

import numpy as np

from lifelore.action.demonstrations.competence import competence_by_paths, competence_by_steps
from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.demonstrations.simulated_person import simulated_demonstration
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from reproduction.chapter3.factory import modified_tasks
from reproduction.chapter3.factory.modified_tasks import N_ACTIONS, Problem, contexts_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Grid, run_grid

WITHOUT_PRIOR, SELF, SHOWN = "uniform", "self-trained", "shown"
WEIGHTS = ("equal", "by steps", "by ways")
"""w(π) of a person: 1, the share of best steps corrected for chance, or the length of ways beside known ones."""
PEOPLE = {
    "expert": (1.0,),
    "familiar": (0.9,),
    "varied": (1.0, 0.9, 0.7, 0.5),
    "one in four": (1.0, 0.3, 0.3, 0.3),
    "poor": (0.5,),
}
"""Skills of the people who demonstrate, in turn."""
VARIED = "varied"
KEYS = ("features", "schedule", "ties", "alpha0", "trajectories")
PATIENCE = 4000
"""Steps after which a person gives up."""


class Tasks(NamedTuple):
    """Training tasks, demonstrations by group (None: given up), w(π) by group and kind of weight, test tasks."""

    training: list[Problem]
    shown: dict[str, list[Demonstration | None]]
    weights: dict[tuple[str, str], dict[str, float]]
    testing: list[Problem]


def run_of(settings: Mapping, seed: int, number: int) -> Tasks:
    """Run `number`."""
    own = (seed, "C3.12", number)
    training = modified_tasks.problems_of(settings, (*own, "training"), max(settings["trajectories"]))
    shown, weights = {}, {}
    for people in settings["people"]:
        shown[people] = [demonstrate(problem, people, i) for i, problem in enumerate(training)]
        done = [demonstration for demonstration in shown[people] if demonstration]
        weights[people, "equal"] = dict.fromkeys({demonstration.agent for demonstration in done}, 1.0)
        weights[people, "by steps"] = competence_by_steps(done, lambda task: training[int(task)].best)
        weights[people, "by ways"] = competence_by_paths(done)
    testing = modified_tasks.problems_of(settings, (*own, "testing"), settings["test_tasks"])
    return Tasks(training, shown, weights, testing)


def demonstrate(problem: Problem, people: str, number: int) -> Demonstration | None:
    """Task `number`, demonstrated by the person whose turn it is; None where that person gives up."""
    skills = PEOPLE[people]
    turn = number % len(skills)
    return simulated_demonstration(
        problem.tables, problem.best, skills[turn], stream(*problem.stream, people, "person"),
        task=str(number), agent=f"person {turn}", most_steps=PATIENCE,
    )  # fmt: skip


def self_trained(run: Tasks, how: Mapping) -> ActionPrior:
    """The prior from the exact policies of the training tasks, every state counted (Eq. 3.7)."""
    prior = ActionPrior(N_ACTIONS, how["alpha0"])
    for problem in run.training[: how["trajectories"]]:
        prior.update(contexts_of(problem, how["features"]), problem.best)
    return prior


def from_shown(run: Tasks, how: Mapping, people: str, weight: str) -> ActionPrior:
    """The prior from demonstrations, each step weighed by its person's w(π) (Eq. 3.3)."""
    prior = ActionPrior(N_ACTIONS, how["alpha0"])
    done = [shown for shown in run.shown[people][: how["trajectories"]] if shown]
    codes = {shown.task: contexts_of(run.training[int(shown.task)], how["features"]) for shown in done}
    count_demonstrations(prior, done, lambda shown: codes[shown.task][shown.states], run.weights[people, weight])
    return prior


def grid_of(settings: Mapping) -> Grid:
    """Features × ε × ties, and every other α⁰ and number of trajectories, one at a time."""
    crossed = {"features": "features", "schedule": "schedules", "ties": "ties"}
    return Grid.crossed(settings, KEYS, crossed, {key: key for key in ("alpha0", "trajectories")})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: all methods with the default people in every cell of the grid; all people at the default."""
    run, grid = run_of(settings, seed, cell["run"]), grid_of(settings)

    def learn(how: Mapping, prior: ActionPrior | None) -> dict:
        def rows_for(problem: Problem):
            return (
                None
                if prior is None
                else modified_tasks.rows_of(problem, how["features"], prior.probs, how["ties"])
            )

        rewards = modified_tasks.rewards_of(run.testing, rows_for, schedule_of(settings, how["schedule"]))
        curve = modified_tasks.curve_across(rewards) if grid.is_default_but_for_schedule(how) else {}
        return {"all": float(rewards.mean()), "early": float(rewards[:, : settings["early"]].mean()), **curve}

    def numbers(method: str, how: Mapping) -> dict:
        if method == SHOWN:
            people = settings["default"]["people"]
            return {"people": people, "weight": "equal", **learn(how, from_shown(run, how, people, "equal"))}
        return learn(how, self_trained(run, how) if method == SELF else None)

    found = list(run_grid(grid, "method", WITHOUT_PRIOR, (SELF, SHOWN), numbers))
    groups = [
        {"people": people, "weight": weight, **learn(grid.default, from_shown(run, grid.default, people, weight))}
        for people, weight in product(settings["people"], WEIGHTS)
    ]
    optimal = [problem.optimal for problem in run.testing]
    means = {"optimal": float(np.mean(optimal)), "optimal_size": float(np.abs(optimal).mean())}
    return {**cell, **means, "found": found, "groups": groups, "people": _competence(settings, run)}


def _competence(settings: Mapping, run: Tasks) -> list[dict]:
    """Tasks that people gave up, lengths of their demonstrations, and the weights of each person."""
    found = []
    for people in settings["people"]:
        steps = [len(shown.states) for shown in run.shown[people] if shown]
        weights = {w: dict(sorted(run.weights[people, w].items())) for w in WEIGHTS}
        given_up = len(run.shown[people]) - len(steps)
        found.append({"people": people, "given_up": given_up, "steps": sum(steps), "weights": weights})
    return found


def check(settings: Mapping) -> None:
    if VARIED not in settings["people"]:
        raise InputError(f"people must hold {VARIED}, got {', '.join(settings['people'])}")
