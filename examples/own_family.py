"""A family of tasks of your own: a robot crosses a grid in a wind that it does not see.

The wind pushes the robot up in some columns. It is the hidden type of a task, and each weekday has a usual wind.
"""

import numpy as np

from lifelore import AgentTask, Plan, Step, TaskFamily, TaskStream, live_long

WINDS = {"early": (0, 2, 2, 1, 0, 0, 0), "middle": (0, 0, 1, 2, 1, 0, 0), "late": (0, 0, 0, 0, 1, 2, 2)}
SIZE, START, GOAL, MOST_MOVES = 7, 21, 27, 20
MOVES = np.array([(-1, 0), (0, 1), (1, 0), (0, -1)])
PUSHES = np.array([(0, 0), (-1, 0), (-2, 0)])
CELLS = np.argwhere(np.ones((SIZE, SIZE)))
NEXT = np.clip(CELLS[:, None, None] + MOVES[:, None] + PUSHES, 0, SIZE - 1) @ (SIZE, 1)  # by cell, act and push


def values(law, acts=None):
    """Expected returns of moves (cell, act) under P(push | column), if `acts` or the best moves follow."""
    found = np.zeros((len(CELLS), len(MOVES)))
    for _ in range(MOST_MOVES):
        after = found.max(axis=1) if acts is None else found[np.arange(len(CELLS)), acts]
        after[GOAL] = 0.0
        found = np.einsum("ce,cae->ca", law[CELLS[:, 1]], after[NEXT]) - 1
    return found


class Crossing(AgentTask):
    def __init__(self, wind):
        self.wind = wind

    def begin(self):
        self.cell, self.moves = START, 0

    def act(self, act):
        column = CELLS[self.cell, 1]
        push = self.wind[column]
        self.cell, self.moves = NEXT[self.cell, act, push], self.moves + 1
        return Step(-1.0, ((column, push),), ended=self.cell == GOAL or self.moves == MOST_MOVES)

    def plan(self, laws, tried, new, shared):
        best = [values(law).argmax(axis=1) for law in laws]  # the behaviour of each type
        returns = [[values(law, acts)[self.cell, acts[self.cell]] for acts in best] for law in laws]
        acts = np.array([acts[self.cell] for acts in best])
        return Plan(np.array(returns), acts, acts)


class WindyGrid(TaskFamily):
    name, acts = "windy grid", ("up", "right", "down", "left")
    n_causes, n_effects = SIZE, len(PUSHES)  # each column is a cause; its effect is the push
    stream = TaskStream(tuple(WINDS))

    def meet(self, number, abilities, context=None):
        drawn = self.stream.draw(number, context)
        return drawn, Crossing(WINDS[drawn.hidden_type])

    def best_return(self, number, context=None):
        wind = WINDS[self.stream.draw(number, context).hidden_type]
        return values(np.eye(len(PUSHES))[list(wind)])[START].max()


if __name__ == "__main__":
    for agent in ("full", "scratch"):
        below = live_long(WindyGrid(), tasks=20, episodes=4, agent=agent)["summary"]["second half"]
        print(f"{agent}: first episodes are {below['first_episode_below_best']:.1f} points below the best")
