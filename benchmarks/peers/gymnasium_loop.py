"""The textbook: an environment with a `step`, a Q-table in NumPy, and a loop between them."""

import time

import gymnasium
import numpy as np

from benchmarks.lattice import ALPHA, DISCOUNT, EPSILON, GOAL, MAX_STEPS

SIZE = 23
N_ACTIONS = 4
MOVES = ((-1, 0), (1, 0), (0, 1), (0, -1))
STEPS = 40_000


class TextbookLattice(gymnasium.Env):
    """The lattice, written as a tutorial writes a grid world.

    Actions: 0 north, 1 south, 2 east, 3 west. Observations: the number of the cell. Rewards: 100 at the goal,
    -10 at a wall, else 0. Starts in any cell but the goal; ends at the goal.
    """

    def __init__(self) -> None:
        inside = range(1, SIZE - 1)
        self.cells = [(row, column) for row in inside for column in inside if row % 2 == 1 or column % 2 == 1]
        self.number = {cell: i for i, cell in enumerate(self.cells)}
        self.goal = self.cells[GOAL]
        self.observation_space = gymnasium.spaces.Discrete(len(self.cells))
        self.action_space = gymnasium.spaces.Discrete(N_ACTIONS)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.cell = self.goal
        while self.cell == self.goal:
            self.cell = self.cells[self.np_random.integers(len(self.cells))]
        return self.number[self.cell], {}

    def step(self, action):
        row, column = self.cell[0] + MOVES[action][0], self.cell[1] + MOVES[action][1]
        if (row, column) not in self.number:
            return self.number[self.cell], -10.0, False, False, {}
        self.cell = (row, column)
        terminated = self.cell == self.goal
        return self.number[self.cell], 100.0 if terminated else 0.0, terminated, False, {}


def textbook_rate(steps: int = STEPS) -> float:
    """Million steps a second of the textbook loop, doing the work that all do."""
    return _rate(steps, same_work=True)


def short_textbook_rate(steps: int = STEPS) -> float:
    """The same, but ties go to the first best action (`argmax`), and only the episode's reward is kept."""
    return _rate(steps, same_work=False)


def _rate(steps: int, same_work: bool) -> float:
    env, random = TextbookLattice(), np.random.default_rng(0)
    q = np.zeros((len(env.cells), N_ACTIONS))
    visits = np.zeros((len(env.cells), N_ACTIONS), int)
    env.reset(seed=0)
    curve, done = [], 0
    started = time.perf_counter()
    while done < steps:
        state, _ = env.reset()
        total, discounted, collisions, terminated, step = 0.0, 0.0, 0, False, 0
        while not terminated and step < MAX_STEPS:
            if random.random() < EPSILON:
                action = random.integers(N_ACTIONS)
            elif same_work:
                tied = np.flatnonzero(q[state] == q[state].max())
                action = tied[random.integers(len(tied))]
            else:
                action = np.argmax(q[state])
            following, reward, terminated, _, _ = env.step(action)
            target = reward + DISCOUNT * np.max(q[following]) * (not terminated)
            q[state, action] += ALPHA * (target - q[state, action])
            total += reward
            if same_work:
                visits[state, action] += 1
                discounted += DISCOUNT**step * reward
                collisions += following == state
            state = following
            step += 1
        curve.append((discounted, total, step, collisions, terminated))
        done += step
    return done / (time.perf_counter() - started) / 1e6
