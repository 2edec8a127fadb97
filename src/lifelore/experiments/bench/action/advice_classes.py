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

from lifelore.action.advice.advised_walk import Walk, advised_walk
from lifelore.action.advice.advisor import BETTER, AdviceSettings, Advisor
from lifelore.action.advice.agent_classes import OWN_STEPS, class_advisor, class_probs
from lifelore.action.advice.goal_model import GoalModel, extend_goal_models
from lifelore.agent.advise.walk_building import spread_places
from lifelore.core.metrics import mean_estimate, ratio_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import make_world
from lifelore.experiments.bench.rounds import at_most, estimated_row
from lifelore.experiments.chapter3.advice.mazes import Errand, expert_walk

WORLDS = {"offices": "building", "mazes": "advice"}
CLASSES = ("staff", "visitor")
KNOWLEDGE = (0.0, 0.25, 0.5)
EXPERT_WALKS, ERRANDS, MOST_STEPS = 30, 20, 3000
"""Walks of experts to each place; errands of each class in a world; steps after which an errand is given up."""
SURE = 0.99
"""P(class) where a name tag shows it."""
ONE, INFERRED, SHOWN = "one prior", "class inferred", "class shown"
APART, APART_SHOWN = "goals apart", "goals apart, class shown"
NONE = "no advice"
AS_THESIS, LIMITED = "no limit", "at most 40 steps in 100"
SETTINGS = {AS_THESIS: AdviceSettings(), LIMITED: OWN_STEPS}
"""As in the thesis, all steps are evidence; else only those without advice."""
Case = tuple[str, float, str, str]
"""Worlds, knowledge, settings and advisor."""


class Place(NamedTuple):
    """A place of a class: the errand to it, and the model of the experts that walk there."""

    found: Errand
    model: GoalModel


def bench_advice_classes(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `lifelore.experiments.bench.bench`. Each round is an office and a maze of its own."""
    steps: dict[Case, list[float]] = {}
    right: dict[tuple[str, float], list[float]] = {}
    for number, (round_, kind) in enumerate(product(range(repeats), WORLDS)):
        for case, mean in measured(kind, round_, right).items():
            steps.setdefault(case, []).append(mean)
        progress(number + 1, repeats * len(WORLDS), kind)
    rows, ratios = [], {}
    for case, means in steps.items():
        kind, knowledge, settings, way = case
        name = f"{kind}, knowledge {knowledge:g}, {settings}, {way}"
        rows.append(estimated_row(f"steps, {name}", mean_estimate(means), "steps"))
        if way not in (ONE, NONE):
            estimate = ratio_estimate(means, steps[kind, knowledge, settings, ONE])
            rows.append(estimated_row(f"steps beside {ONE}, {name}", estimate, "ratio"))
            ratios[case] = estimate.value
    for (kind, knowledge), shares in right.items():
        name = f"class named rightly by 30 steps without advice, {kind}, knowledge {knowledge:g}"
        rows.append(estimated_row(name, mean_estimate(shares), "share"))
    goals = [
        at_most(f"steps beside {ONE}, {kind}, knowledge 0.25, {LIMITED}, {INFERRED}", 0.9,
                ratios.get((kind, 0.25, LIMITED, INFERRED)))
        for kind in WORLDS
    ]  # fmt: skip
    return {"rows": rows, "goals": goals}


def measured(kind: str, round_: int, right: dict[tuple[str, float], list[float]]) -> dict[Case, float]:
    """Mean steps of all errands of a world by case; adds to `right` the share of classes named rightly."""
    world = make_world(WORLDS[kind], seed=round_)
    classes = places_of(world, kind, round_)
    tables = advisors_of(world, classes)
    found: dict[Case, float] = {}
    for knowledge in KNOWLEDGE:
        for settings, by_class in tables.items():
            walks = {
                way: [
                    _walk(
                        world,
                        classes[name][goal].found,
                        knowledge,
                        by_class[name][way],
                        (kind, round_, name, number),
                    )
                    for name in CLASSES
                    for number, goal in enumerate(_errands(kind, round_, name, len(classes[name])))
                ]
                for way in by_class[CLASSES[0]]
            }
            for way, of_way in walks.items():
                found[kind, knowledge, settings, way] = float(np.mean([len(walk.states) for walk in of_way]))
        advisor = tables[LIMITED][CLASSES[0]][INFERRED]
        named = [
            _named(
                advisor,
                _walk(world, classes[name][goal].found, knowledge, advisor, (kind, round_, name, number), False),
            )
            == name
            for name in CLASSES
            for number, goal in enumerate(_errands(kind, round_, name, len(classes[name])))
        ]
        right.setdefault((kind, knowledge), []).append(float(np.mean(named)))
    return found


def places_of(world: GridWorld, kind: str, round_: int) -> dict[str, list[Place]]:
    """The places of each class: every second of those that are far apart."""
    spots, distance = spread_places(f"{kind}:{round_}", world)
    found: dict[str, list[Place]] = {name: [] for name in CLASSES}
    for number, (goal, steps) in enumerate(zip(spots.tolist(), distance, strict=True)):
        moves = world.neighbour
        best = (moves >= 0) & (steps[moves] == steps[:, None] - 1)
        errand = Errand(goal, world.task(goal).tables(), best, steps.astype(float))
        random = stream(0, "bench", "advice classes", kind, round_, "experts", number)
        starts = random.choice(np.flatnonzero(steps > 0), EXPERT_WALKS)
        walks = [expert_walk(world, errand, int(start), random) for start in starts]
        model = GoalModel.from_trajectories(walks, world.n_states, moves.shape[1], [goal])
        found[CLASSES[number % len(CLASSES)]].append(Place(errand, model))
    return found


def advisors_of(world: GridWorld, classes: Mapping[str, list[Place]]) -> dict[str, dict[str, dict[str, Advisor]]]:
    """By settings, class of the agent and way: the advisor that the agent meets."""
    models = {name: [place.model for place in places] for name, places in classes.items()}
    every = [model for of_class in models.values() for model in of_class]
    found: dict[str, dict[str, dict[str, Advisor]]] = {}
    for settings, chosen in SETTINGS.items():
        silent = replace(chosen, kappa=1e9)
        one, inferred = Advisor.of_thesis(every, chosen), class_advisor(models, chosen)
        shown = {
            name: class_advisor(models, chosen, {of: SURE if of == name else 1 - SURE for of in CLASSES})
            for name in CLASSES
        }
        found[settings] = {
            name: {
                NONE: Advisor.of_thesis(every, silent), ONE: one, INFERRED: inferred, SHOWN: shown[name],
            }
            for name in CLASSES
        }  # fmt: skip
    apart = Advisor(extend_goal_models(every, world.neighbour), None, BETTER)
    for name in CLASSES:
        found[LIMITED][name] |= {
            APART: apart,
            APART_SHOWN: Advisor(extend_goal_models(models[name], world.neighbour), None, BETTER),
        }
    return found


def _errands(kind: str, round_: int, name: str, n_places: int) -> list[int]:
    random = stream(0, "bench", "advice classes", kind, round_, name, "errands")
    return random.integers(0, n_places, ERRANDS).tolist()


def _walk(
    world: GridWorld, found: Errand, knowledge: float, advisor: Advisor, names: tuple, heeds: bool = True
) -> Walk:
    is_open = world.neighbour >= 0
    policy = knowledge * _shares(found.best) + (1 - knowledge) * _shares(is_open)
    random = stream(0, "bench", "advice classes", *names, "walk", f"{knowledge:g}")
    return advised_walk(found.tables, policy, advisor, random, MOST_STEPS, follows_advice=heeds)


def _shares(chosen: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Each chosen action as likely; any where none is chosen."""
    chosen = chosen | ~chosen.any(axis=1, keepdims=True)
    return chosen / chosen.sum(axis=1, keepdims=True)


def _named(advisor: Advisor, walk: Walk, n_steps: int = 30) -> str:
    """The most probable class after the first steps of a walk."""
    agent = advisor.watch()
    for state, action in zip(walk.states[:n_steps], walk.actions[:n_steps], strict=True):
        advisor.observe(agent, int(state), int(action))
    advisor.consider(agent, int(walk.states[min(n_steps, len(walk.states) - 1)]))
    return CLASSES[int(class_probs(advisor, agent).argmax())]
