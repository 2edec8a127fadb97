"""An action prior of ten tasks on an eleventh, in an MDP given as matrices T and R.

For reinforcement-learning researchers. Thesis: §3.2.2, Algorithm 2.
"""

import numpy as np
from scipy import sparse

from lifelore.action import ActionPrior, prior_rows
from lifelore.core import QLearning, Tables, optimal_actions

# A room of 12 × 12 cells with four moves, each of which fails one time in five; one sparse T(s, s') a move.
cells = np.arange(144)
row, column = np.divmod(cells, 12)
moves = [(row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)]
ahead = [np.clip(r, 0, 11) * 12 + np.clip(c, 0, 11) for r, c in moves]
stay = sparse.csr_matrix(sparse.eye(144))
transitions = [0.8 * stay[to] + 0.2 * stay for to in ahead]

# Eleven tasks: reach one of the cells of the first row, which ends the episode and pays 1.
goals = [0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 5]
tasks = [Tables.from_matrices(transitions, rewards=cells == goal, terminal=goal) for goal in goals]

prior = ActionPrior(n_actions=4)
for task in tasks[:10]:
    prior.update(cells, optimal_actions(task, discount=0.95))

learner = QLearning(episodes=100, max_steps=500)
for name, used in (("uniform exploration", ActionPrior(n_actions=4)), ("action prior", prior)):
    _, curve = learner.learn(tasks[10], discount=0.95, rows=prior_rows(tasks[10], cells, used.probs))
    print(f"{name}: {curve.steps[:20].mean():.1f} steps an episode in the first twenty")
