"""Q-learning on the errands of a maze: the kernel against a naive twin and against plain Q-learning."""

import numpy as np
import pytest

from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.mdp import TERMINAL
from lifelore.core.streams import stream
from reproduction.chapter3.advice.learning import errand_tables, learner_schedule, reached_by_learner
from reproduction.chapter3.advice.mazes import errands_of, goal_models_of, maze_of, thesis_advisor
from reproduction.engine.learning_run import learnt
from reproduction.engine.registry import claim_of

QUICK = claim_of("C3.16").sizes["quick"]
SMALL = {**QUICK, "episodes": 12, "max_episode_steps": 30}


@pytest.fixture(scope="module")
def maze():
    return maze_of(QUICK, {"loops": 0.1, "maze": 0}, 0)


def test_without_advice_it_is_q_learning(maze):
    silent = thesis_advisor(goal_models_of(maze, "walks", 0.1), float("inf"))
    for number, errand in enumerate(errands_of(maze, 3)):
        schedule = learner_schedule({**QUICK, "episodes": 200}, maze, [1.0, 0.99, 0.05])
        plain = learnt(errand.tables, (*maze.names, "learner", number), None, schedule)[0].reached
        assert (reached_by_learner(maze, errand.tables, number, schedule, silent) == plain).all()


@pytest.mark.parametrize("kappa", [0.1, 0.5])
def test_advised_learning_by_a_naive_twin(maze, kappa):
    advisor = thesis_advisor(goal_models_of(maze, "walks", 0.1), kappa)
    errand, number = errands_of(maze, 1)[0], 0
    tables = errand_tables(maze, errand, number, "one")
    schedule = learner_schedule(SMALL, maze, "printed")
    own, world = (random_state(stream(*maze.names, "learner", number, of)) for of in ("learner", "world"))
    q, watched, reached, advised_steps = np.zeros((tables.n_states, 4)), advisor.watch(), [], 0
    for epsilon, alpha in zip(schedule.epsilon, schedule.alpha, strict=True):
        next_uniform(world)
        state, over, step = int(tables.starts[0]), False, 0
        while not over and step < schedule.max_steps:
            if next_uniform(own) < epsilon:
                advice = advisor.consider(watched, state)
                advised_steps += advice.advise
                theta = advice.theta if advice.advise else np.full(4, 0.25)
                action = int(np.searchsorted(np.cumsum(theta)[:3], next_uniform(own), side="right"))
            else:
                best = np.flatnonzero(q[state] == q[state].max())
                action = int(best[0] if len(best) == 1 else best[int(next_uniform(own) * len(best))])
            advisor.observe(watched, state, action)
            following = int(tables.next_state[state, action, 0])
            over = bool(tables.event[state, action, 0] & TERMINAL)
            target = tables.reward[state, action, 0] + (not over) * schedule.discount * q[following].max()
            q[state, action] += alpha * (target - q[state, action])
            state, step = following, step + 1
        reached.append(over)
    assert advised_steps > 0
    assert reached_by_learner(maze, tables, number, schedule, advisor).tolist() == reached
