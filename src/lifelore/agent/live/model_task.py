"""Learns one task with the model-based learner."""

from threading import Event

import numpy as np

from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.task_result import (
    CHECK_EVERY,
    CHECK_EVERY_BY_SIGHT,
    THRESHOLD,
    TaskResult,
    first_arrival,
)
from lifelore.core.learning.curve import EPISODE, STEP, first_episodes, new_curve
from lifelore.core.learning.known_value import KnownValue
from lifelore.core.learning.known_world import WorldModel, best_known_actions, known_policy
from lifelore.core.learning.model_learning import (
    ExplorationStrategy,
    ModelLearner,
    StateInfo,
    check_deterministic,
    explore,
)
from lifelore.core.learning.sight_search import FOUND_STEP, SightSearch, explore_by_sight
from lifelore.core.learning.tour_search import KnownTour, explore_on_tour
from lifelore.core.mdp import Tables

NEAR = 1e-9
"""Share of the optimal return around the threshold within which the exact value decides. It is far larger than the
rounding error of the value that is updated step by step."""


def live_model_task(
    tables: Tables,
    optimal: float,
    discount: float,
    model: WorldModel,
    perceived: StateInfo,
    search: SightSearch | None,
    tour: KnownTour | None,
    strategy: ExplorationStrategy,
    explorer: ModelLearner,
    episodes: int,
    max_steps: int,
    stop: Event,
) -> TaskResult:
    """Explore until the greedy policy has 80 % of the `optimal` value or the cap is reached; changes `model`.

    With `search` the learner perceives places at a distance, else by touch. It may then know enough as soon as it
    sees the goal; it still walks to the end of that episode, which counts for the returns and the model alone.
    With `tour` it visits the places known before the task in the order of a tour.
    """
    check_deterministic(tables)
    curve = new_curve(episodes)
    known = KnownValue(tables, model, explorer, discount)
    task = perceived, strategy, explorer

    def run(budget: int) -> int:
        if tour is not None:
            return explore_on_tour(tables, model, *task, tour, curve, max_steps, discount, budget)
        if search is None:
            return explore(tables, model, *task, curve, max_steps, discount, budget)
        return explore_by_sight(tables, model, *task, search, curve, max_steps, discount, budget)

    value, total, trace = 0.0, 0, []
    while value < THRESHOLD * optimal:
        if stop.is_set():
            raise Stopped
        steps = run(CHECK_EVERY if search is None else CHECK_EVERY_BY_SIGHT)
        if steps == 0:
            break
        total += steps
        value = known.update()
        if abs(value - THRESHOLD * optimal) < NEAR * optimal:
            value = known.exact()
        trace.append((total, value / optimal))
    reached = value >= THRESHOLD * optimal
    collisions, begun = int(curve.collisions.sum()), _begun(explorer)
    while search is not None and reached and explorer.cursor[STEP]:
        run(1)
    episode, step = int(explorer.cursor[EPISODE]), int(explorer.cursor[STEP])
    if step:
        curve.returns[episode], curve.steps[episode] = explorer.running[0], step
    arrival = first_arrival(curve, episodes * max_steps)
    if search is not None and search.found[FOUND_STEP] >= 0:
        arrival = int(search.found[FOUND_STEP])
    return TaskResult(
        first_return=float(curve.returns[0]),
        collisions=collisions,
        steps_to_80=total if reached else episodes * max_steps,
        episodes_to_80=begun if reached else episodes,
        reached=bool(reached),
        final_return=known.exact(),
        policy=known_policy(model, explorer.place),
        best=best_known_actions(model, explorer.place),
        trace=np.array(trace, float).reshape(-1, 2),
        curve=first_episodes(curve, _begun(explorer)),
        complete=episode,
        steps_to_goal=arrival,
    )


def _begun(explorer: ModelLearner) -> int:
    """Number of episodes that began, with the interrupted one."""
    return int(explorer.cursor[EPISODE]) + int(explorer.cursor[STEP] > 0)
