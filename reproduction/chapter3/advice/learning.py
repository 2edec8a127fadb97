"""Q-learning on the errands of a maze, with advice in its ε branch and without, for claims C3.15 to C3.17.

The advisor watches every step of the learner, over the episodes of a task. Where the learner explores, and
condition 3.16 holds at this step, it draws from θ, else from all actions alike. Episodes have at most 200 steps:
a goal far away is seldom met by chance. Thesis: §3.7.2.2, Alg. 2.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advice import consider, observe
from lifelore.action.advice.advisor import Advisor
from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.learning.q_learning import Schedule, cumulative, epsilon_greedy
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.streams import stream
from reproduction.chapter3.advice.mazes import Errand, Maze
from reproduction.chapter3.learning.schedules import Epsilon, schedule_of

LEARNING_RATE = 0.5
"""α of schedules that have none of their own."""


def errand_tables(maze: Maze, found: Errand, number: int, starts: str) -> Tables:
    """The tables of errand `number`, by where its episodes start.

    ``"one"``: in the cell where agents of fixed policy start; ``"any"``: in every cell.
    """
    if starts == "any":
        return found.tables
    random = random_state(stream(*maze.names, "walk", number))
    first = int(next_uniform(random) * len(found.tables.starts))
    return found.tables._replace(starts=found.tables.starts[first : first + 1])


def learner_schedule(settings: Mapping, maze: Maze, epsilon: Epsilon, first: int | None = None) -> Schedule:
    """The schedule of ``episodes`` episodes, or of the `first` of them."""
    learning = {
        "episodes": settings["episodes"],
        "max_steps": settings["max_episode_steps"],
        "learning_rate": LEARNING_RATE,
        "discount": maze.world.discount,
    }
    schedule = schedule_of(learning, epsilon)
    return schedule._replace(epsilon=schedule.epsilon[:first], alpha=schedule.alpha[:first])


def reached_by_learner(
    maze: Maze, tables: Tables, number: int, schedule: Schedule, advisor: Advisor
) -> NDArray[np.bool_]:
    """Whether each episode of errand `number` reached the goal, (n_episodes,); with κ = ∞ plain Q-learning."""
    own, world = (random_state(stream(*maze.names, "learner", number, of)) for of in ("learner", "world"))
    theta, uniform = advisor.guide.theta[0], np.full((1, tables.n_actions), 1 / tables.n_actions)
    explore = cumulative(np.concatenate([np.where(theta.any(axis=1, keepdims=True), theta, uniform), uniform]))
    reached, q = np.zeros(schedule.epsilon.size, np.bool_), np.zeros(theta.shape)
    task, rows = (tables.next_state, tables.reward, tables.event, tables.starts), (explore, np.ones_like(explore))
    _learn(task, schedule, q, rows, advisor.guide, advisor.rule, advisor.watch(), world, own, reached)
    return reached


@kernel
def _learn(task, schedule, q, rows, guide, rule, agent, world, own, reached):
    """The Q-learning of `core.learning.q_learning`, row by row; its context is the state where advice is given."""
    next_state, reward_of, event_of, starts = task
    explore_cum, tie_weight = rows
    unadvised = len(q)
    for episode in range(reached.size):
        state = starts[int(next_uniform(world) * starts.size)]
        for _ in range(schedule.max_steps):
            if schedule.epsilon[episode] > 0.0 and next_uniform(own) < schedule.epsilon[episode]:
                advised, _gain = consider(guide, rule, agent, state)
                context, u, a = state if advised else unadvised, next_uniform(own), 0
                while u >= explore_cum[context, a]:
                    a += 1
            else:
                a = epsilon_greedy(q, state, explore_cum, tie_weight, unadvised, 0.0, own)
            observe(guide, rule, agent, state, a, False)
            following, over = next_state[state, a, 0], event_of[state, a, 0] & TERMINAL > 0
            target = reward_of[state, a, 0]
            if not over:
                best = q[following, 0]
                for b in range(1, q.shape[1]):
                    best = max(best, q[following, b])
                target += schedule.discount * best
            q[state, a] += schedule.alpha[episode] * (target - q[state, a])
            state = following
            if over:
                reached[episode] = True
                break


def final_reward(reached: NDArray[np.bool_]) -> float:
    """The mean reward of an episode, of 1000, over the last tenth of the episodes."""
    return 1000 * float(reached[-max(1, len(reached) // 10) :].mean())
