"""Learns one task by ε-greedy Q-learning whose exploration the prior guides (Alg. 2, 4)."""

from threading import Event

import numpy as np

from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.task_result import CHECK_EVERY, THRESHOLD, TaskResult, first_arrival
from lifelore.core.learning.curve import EPISODE, STEP, first_episodes, new_curve
from lifelore.core.learning.q_learning import QLearner, Rows, Schedule, learn
from lifelore.core.mdp import Tables
from lifelore.core.planning.planning import greedy_policy, learnt_best_actions, mean_start_value, policy_values

CHUNK = 100_000
"""Steps between checks of the stop event after the threshold is reached: a few milliseconds."""


def live_q_task(
    tables: Tables, optimal: float, rows: Rows, schedule: Schedule, learner: QLearner, stop: Event
) -> TaskResult:
    """Run all episodes of the schedule; check the threshold every `CHECK_EVERY` steps until it is reached."""
    curve = new_curve(len(schedule.epsilon))
    reached_at: tuple[int, int, int] | None = None
    total, trace, steps = 0, [], 1
    while steps:
        if stop.is_set():
            raise Stopped
        steps = learn(tables, rows, schedule, learner, curve, CHUNK if reached_at else CHECK_EVERY)
        total += steps
        if steps and reached_at is None:
            share = _greedy_value(tables, learner, schedule.discount) / optimal
            trace.append((total, share))
            if share >= THRESHOLD:
                begun = int(learner.cursor[EPISODE]) + int(learner.cursor[STEP] > 0)
                reached_at = total, begun, int(curve.collisions.sum())
    final = _greedy_value(tables, learner, schedule.discount)
    episodes = len(curve.returns)
    cap = episodes * schedule.max_steps, episodes, int(curve.collisions.sum())
    steps_to_80, episodes_to_80, collisions = reached_at or cap
    return TaskResult(
        first_return=float(curve.returns[0]),
        collisions=collisions,
        steps_to_80=steps_to_80,
        episodes_to_80=episodes_to_80,
        reached=reached_at is not None,
        final_return=final,
        policy=greedy_policy(learner.q),
        best=learnt_best_actions(learner.q),
        trace=np.array(trace, float).reshape(-1, 2),
        curve=first_episodes(curve, episodes),
        complete=episodes,
        steps_to_goal=first_arrival(curve, episodes * schedule.max_steps),
    )


def _greedy_value(tables: Tables, learner: QLearner, discount: float) -> float:
    return mean_start_value(tables, policy_values(tables, greedy_policy(learner.q), discount))
