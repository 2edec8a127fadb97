"""A family of tasks for tests: three doors, of which one has a prize; which one is the hidden type."""

from dataclasses import dataclass

import numpy as np

from lifelore.agent.long_lived.task_family import Plan, Step, TaskFamily
from lifelore.core.streams import stream
from lifelore.domains.task_stream import DrawnTask, TaskStream

N = 3
PRIZE, NOTHING, COST = 0, 1, -1.0


@dataclass(frozen=True)
class Doors(TaskFamily):
    """An episode has two tries; the prize of 10 is behind the door of the type with probability 0.9."""

    stream: TaskStream

    name = "doors"
    acts = ("left", "middle", "right", "leave")
    n_causes = N
    n_effects = 2

    def meet(self, number, abilities, context=None):
        drawn = self.stream.draw(number, context)
        return drawn, DoorTask(drawn)

    def best_return(self, number, context=None):
        return 10 * 0.99 + COST * 1.1

    def cause_name(self, cause):
        return f"open {self.acts[cause]}"

    def effect_name(self, cause, effect):
        return ("prize", "nothing")[effect]


class DoorTask:
    """The task; the door of a type is its number."""

    def __init__(self, drawn: DrawnTask) -> None:
        self.door = int(drawn.hidden_type)
        self.rng = stream(0, "doors", drawn.number)
        self.begin()

    context = 0

    def begin(self):
        self.left = 2

    def describe(self):
        return f"three doors, {self.left} tries left"

    def act(self, act):
        if act == N:
            return Step(0.0, (), True)
        prize = act == self.door and self.rng.random() < 0.9
        self.left -= 1
        reward = COST + 10.0 * prize
        return Step(reward, ((act, PRIZE if prize else NOTHING),), bool(prize or self.left == 0))

    def plan(self, laws, tried, new, shared):
        hope = laws[:, :, PRIZE].copy()
        if new is not None:
            hope[new, ~tried] = 1.0
        acts = hope.argmax(axis=1)
        values = self.left * COST + 10 * (1 - (1 - hope[:, acts]) ** self.left)
        return Plan(values, acts, acts)

    def best_acts(self, laws, shared):
        best = np.zeros((1, N + 1), np.bool_)
        best[0, laws[:, PRIZE].argmax()] = True
        return np.array([0]), best
