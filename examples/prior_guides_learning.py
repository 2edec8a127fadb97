"""An action prior learnt in four mazes gives Q-learning a better start in a fifth maze.

For reinforcement-learning researchers. Thesis: §3.2.2, Algorithms 2 and 4.
"""

from lifelore import ActionPrior, QLearning, make_world
from lifelore.action import prior_rows
from lifelore.core import learnt_best_actions

learner = QLearning(episodes=500)


def learn(maze: int, prior: ActionPrior):
    """Learn one maze from nothing, exploring by the prior: the Q table and the learning curve."""
    world = make_world("noise", density=0.6, seed=maze)
    task = world.task(goal=world.n_states - 1).tables()
    rows = prior_rows(task, world.percepts, prior.probs)
    learnt, curve = learner.learn(task, 0.95, seed=maze, rows=rows)
    return world, learnt, curve


prior = ActionPrior(n_actions=4)
for maze in range(4):
    world, learnt, _ = learn(maze, ActionPrior(n_actions=4))
    prior.update(world.percepts, learnt_best_actions(learnt.q))  # which moves were best, by local percept

for name, used in (("uniform exploration", ActionPrior(n_actions=4)), ("action prior", prior)):
    _, _, curve = learn(9, used)
    print(f"{name}: mean return of the first ten episodes {curve.returns[:10].mean():.1f}")
