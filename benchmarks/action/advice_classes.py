"""`bench advice_classes`: advice by class of agent beside one prior for all, in generated offices and mazes.

Each world has eight places, far from each other: four for staff and four for visitors. Experts of a class walk
shortest paths to its places. An agent to be advised is bound for a place of its class. A share of its steps, its
knowledge, leads there; the others are random. So without knowledge no step tells its class. All advisors meet the
same agents, starts and random numbers. Thesis: §3.7, hospital staff and visitors.
"""

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_most, estimated_row
from lifelore.action.advice.advised_walk import Walk, advised_walk
from lifelore.action.advice.advisor import BETTER, AdviceSettings, Advisor
from lifelore.action.advice.agent_classes import SURE, ClassAdvisor, classes_with_goals, pooled_classes
from lifelore.action.advice.goal_model import GoalModel
from lifelore.agent.advise.walk_building import spread_places
from lifelore.core.metrics import mean_estimate, ratio_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import make_world
from reproduction.chapter3.advice.mazes import Errand, expert_walk

WORLDS = {"offices": "building", "mazes": "advice"}
CLASSES = ("staff", "visitor")
KNOWLEDGE = (0.0, 0.25, 0.5)
EXPERT_WALKS, ERRANDS, MOST_STEPS = 30, 20, 3000
"""Walks of experts to each place; errands of each class in a world; steps after which an errand is given up."""
NAMED_AFTER = 30
"""Steps of an agent without advice, after which its class is named."""
ONE, INFERRED, SHOWN = "one prior", "class inferred", "class shown"
APART, APART_SHOWN = "goals apart", "goals apart, class shown"
NONE = "no advice"
AS_THESIS, LIMITED = "no limit", "at most 40 steps in 100"
SETTINGS = {AS_THESIS: AdviceSettings(), LIMITED: BETTER}
"""As in the thesis, all steps are evidence; else only those without advice."""
Case = tuple[str, float, str, str]
"""Worlds, knowledge, settings and advisor."""


class Place(NamedTuple):
    """A place of a class: the errand to it, and the model of the experts that walk there."""

    found: Errand
    model: GoalModel


def bench_advice_classes(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`. Each round is an office and a maze of its own."""
    steps: dict[Case, list[float]] = {}
    right: dict[tuple[str, float, str], list[float]] = {}
    for number, (round_, kind) in enumerate(product(range(repeats), WORLDS)):
        for case, mean in measured(kind, round_, right).items():
            steps.setdefault(case, []).append(mean)
        progress(number + 1, repeats * len(WORLDS), kind)
    rows, ratios = [], {}
    for (kind, knowledge, settings, way), means in steps.items():
        name = f"{kind}, knowledge {knowledge:g}, {settings}, {way}"
        rows.append(estimated_row(f"steps, {name}", mean_estimate(means), "steps"))
        reference = {INFERRED: ONE, SHOWN: ONE, APART: ONE, APART_SHOWN: APART}.get(way)
        if reference is not None:
            estimate = ratio_estimate(means, steps[kind, knowledge, settings, reference])
            ratios[name] = estimate.value
            rows.append(estimated_row(f"steps beside {reference}, {name}", estimate, "ratio"))
    for (kind, knowledge, way), shares in right.items():
        name = f"class named rightly by {NAMED_AFTER} steps without advice, {kind}, knowledge {knowledge:g}, {way}"
        rows.append(estimated_row(name, mean_estimate(shares), "share"))
    judged = (f"{kind}, knowledge 0.25, {LIMITED}, {INFERRED}" for kind in WORLDS)
    return {
        "rows": rows,
        "goals": [at_most(f"steps beside {ONE}, {name}", 0.9, ratios.get(name)) for name in judged],
    }


def measured(kind: str, round_: int, right: dict[tuple[str, float, str], list[float]]) -> dict[Case, float]:
    """Mean steps of all errands of a world by case; adds to `right` the shares of classes named rightly."""
    world = make_world(WORLDS[kind], seed=round_)
    classes = places_of(world, kind, round_)
    advisors, silent = advisors_of(world, classes), {}
    errands = [
        (name, number, classes[name][goal].found)
        for name in CLASSES
        for number, goal in enumerate(_errands(kind, round_, name, len(classes[name])))
    ]
    found: dict[Case, float] = {}
    for knowledge in KNOWLEDGE:
        for (settings, way), of_class in advisors.items():
            lengths = []
            for name, number, errand in errands:
                walk = _walk(world, errand, knowledge, of_class[name], (kind, round_, name, number))
                lengths.append(len(walk.states))
                if way == NONE:
                    silent[knowledge, name, number] = walk
            found[kind, knowledge, settings, way] = float(np.mean(lengths))
        for way, known in class_advisors(world, classes).items():
            named = [_named(known, silent[knowledge, name, number]) == name for name, number, _ in errands]
            right.setdefault((kind, knowledge, way), []).append(float(np.mean(named)))
    return found


def places_of(world: GridWorld, kind: str, round_: int) -> dict[str, list[Place]]:
    """The places of each class: every second of those that are far apart."""
    spots, distance = spread_places(f"{kind}:{round_}", world)
    found: dict[str, list[Place]] = {name: [] for name in CLASSES}
    for number, (goal, steps) in enumerate(zip(spots.tolist(), distance, strict=True)):
        moves = world.neighbour
        best = (moves >= 0) & (steps[moves] == steps[:, None] - 1)
        errand = Errand(goal, world.task(goal).tables(), best, steps.astype(float), moves)
        random = stream(0, "bench", "advice classes", kind, round_, "experts", number)
        starts = random.choice(np.flatnonzero(steps > 0), EXPERT_WALKS)
        walks = [expert_walk(world, errand, int(start), random) for start in starts]
        model = GoalModel.from_trajectories(walks, world.n_states, moves.shape[1], [goal])
        found[CLASSES[number % len(CLASSES)]].append(Place(errand, model))
    return found


def advisors_of(world: GridWorld, classes: Mapping[str, list[Place]]) -> dict[tuple[str, str], dict[str, Advisor]]:
    """By settings and way: the advisor that an agent of each class meets."""
    models = {name: [place.model for place in places] for name, places in classes.items()}
    every = [model for of_class in models.values() for model in of_class]
    found: dict[tuple[str, str], dict[str, Advisor]] = {}
    for settings, chosen in SETTINGS.items():
        found[settings, NONE] = dict.fromkeys(CLASSES, Advisor.of_thesis(every, replace(chosen, kappa=1e9)))
        found[settings, ONE] = dict.fromkeys(CLASSES, Advisor.of_thesis(every, chosen))
        found[settings, INFERRED] = dict.fromkeys(CLASSES, pooled_classes(models, chosen).advisor)
        found[settings, SHOWN] = {name: pooled_classes(models, chosen, _tag(name)).advisor for name in CLASSES}
    apart = classes_with_goals(models, world.neighbour).advisor
    shown = {name: classes_with_goals(models, world.neighbour, None, _tag(name)).advisor for name in CLASSES}
    return found | {(LIMITED, APART): dict.fromkeys(CLASSES, apart), (LIMITED, APART_SHOWN): shown}


def class_advisors(world: GridWorld, classes: Mapping[str, list[Place]]) -> dict[str, ClassAdvisor]:
    """The two advisors that infer a class, by way."""
    models = {name: [place.model for place in places] for name, places in classes.items()}
    return {INFERRED: pooled_classes(models), APART: classes_with_goals(models, world.neighbour)}


def _tag(shown: str) -> dict[str, float]:
    return {name: SURE if name == shown else 1 - SURE for name in CLASSES}


def _errands(kind: str, round_: int, name: str, n_places: int) -> list[int]:
    random = stream(0, "bench", "advice classes", kind, round_, name, "errands")
    return random.integers(0, n_places, ERRANDS).tolist()


def _walk(world: GridWorld, found: Errand, knowledge: float, advisor: Advisor, names: tuple) -> Walk:
    policy = knowledge * _shares(found.best) + (1 - knowledge) * _shares(world.neighbour >= 0)
    random = stream(0, "bench", "advice classes", *names, "walk", f"{knowledge:g}")
    return advised_walk(found.tables, policy, advisor, random, MOST_STEPS)


def _shares(chosen: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Each chosen action as likely; any where none is chosen."""
    chosen = chosen | ~chosen.any(axis=1, keepdims=True)
    return chosen / chosen.sum(axis=1, keepdims=True)


def _named(known: ClassAdvisor, walk: Walk, n_steps: int | None = None) -> str:
    """The most probable class after the first steps of a walk."""
    n_steps, agent = NAMED_AFTER if n_steps is None else n_steps, known.advisor.watch()
    for state, action in zip(walk.states[:n_steps], walk.actions[:n_steps], strict=True):
        known.advisor.observe(agent, int(state), int(action))
    known.advisor.consider(agent, int(walk.states[min(n_steps, len(walk.states) - 1)]))
    probs = known.probs(agent)
    return max(CLASSES, key=probs.__getitem__)
