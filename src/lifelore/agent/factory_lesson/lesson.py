"""The lesson of one person, who assembles one task after another, step by step. Thesis: §3.4.8."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.agent.factory_lesson.lesson_prior import advice_in, prior_of
from lifelore.agent.factory_lesson.lesson_task import LessonTask, lesson_task
from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, TERMINAL
from lifelore.domains.factory.factory import ACTION_NAMES, ASSEMBLED, RAW

MOST_STEPS = 2000
"""Steps after which a demonstration must be given up; more take more of the memory."""


class FactoryLesson:
    """A lesson.

    Parameters
    ----------
    name : str
        Anonymous identifier of the person.
    components : int
        Number of components that a task assembles, 1 to 4.
    seed : int
        Draws the factories.
    shown : sequence of Demonstration
        Demonstrations so far; `task` of each is the number of its factory, as text.

    Attributes
    ----------
    number : int
        Of the present task.
    state : int
        Of the present task, see `domains.factory.factory`.
    """

    def __init__(
        self, name: str, components: int = 2, *, seed: int = 0, shown: Sequence[Demonstration] = ()
    ) -> None:
        self.name, self.components, self.seed = name, components, seed
        self.shown = list(shown)
        self.number = 1 + max((int(one.task) for one in shown), default=-1)
        self._start()

    @property
    def present(self) -> LessonTask:
        """The task that is being demonstrated."""
        return self.task_of(self.number)

    def task_of(self, number: int) -> LessonTask:
        """A task that is demonstrated."""
        return lesson_task(self.seed, self.name, self.components, "shown", number)

    @property
    def over(self) -> bool:
        """Whether everything of the present task is assembled."""
        return bool(self.present.task.completed[self.state])

    def act(self, action: int) -> None:
        """Take a step: 0 north, 1 south, 2 east, 3 west, 4 procure, 5 assemble.

        Raises
        ------
        InputError
            There is no such action, the task is over, or it has taken too many steps.
        """
        if isinstance(action, bool) or not isinstance(action, int) or not 0 <= action < len(ACTION_NAMES):
            raise InputError(f"action must lie in [0, {len(ACTION_NAMES)}), got {action!r}")
        if self.over:
            raise InputError("the task is over; go on to the next task")
        if len(self.actions) >= MOST_STEPS:
            raise InputError(f"a demonstration has at most {MOST_STEPS} steps; skip this task")
        tables = self.present.tables
        self.states.append(self.state)
        self.actions.append(action)
        self.reward += float(tables.reward[self.state, action, 0])
        self.event = int(tables.event[self.state, action, 0])
        self.state = int(tables.next_state[self.state, action, 0])

    def demonstration(self) -> Demonstration:
        """The demonstration of the present task, which the caller stores and then hands to `accept`."""
        if not self.event & TERMINAL:
            raise InputError("the task is not over yet; assemble the components that are left")
        return Demonstration(str(self.number), self.name, np.array(self.states), np.array(self.actions))

    def accept(self, shown: Demonstration) -> None:
        """Count a demonstration that is stored."""
        self.shown.append(shown)

    def go_on(self) -> None:
        """Begin the next task; steps of a task that is not over are dropped."""
        self.number += 1
        self._start()

    def view(self) -> dict[str, Any]:
        """The lesson and the state of the present task as plain data.

        Returns
        -------
        dict
            ``lesson``, ``components``, ``number``, ``shown`` (demonstrations), ``steps``, ``reward``, ``over``,
            ``collision`` (of the last step), ``cell`` (row, column of the robot), ``items`` (``component``,
            ``stage``, ``procure``, ``assemble`` with their cells), ``unused`` (cells of the stations that the task
            does not need), ``advice`` (probability by action) and ``advised`` (whether the prior has counts here).
        """
        task, floor = self.present.task, self.present.task.factory.floor
        size = task.factory.n_cells
        stages = task.stages[self.state // size]
        prior = prior_of(self.shown, self.task_of)
        advice, advised = advice_in(prior, self.present, self.state)
        items = [
            {
                "component": component + 1,
                "stage": "raw" if stage == RAW else "assembled" if stage == ASSEMBLED else "procured",
                "procure": floor.cells[task.factory.procure_at[component]].tolist(),
                "assemble": floor.cells[task.factory.assemble_at[component]].tolist(),
            }
            for component, stage in zip(task.components, stages, strict=True)
        ]
        return {
            "lesson": self.name, "components": self.components, "number": self.number, "shown": len(self.shown),
            "steps": len(self.actions), "reward": self.reward, "over": self.over,
            "collision": bool(self.event & COLLISION), "cell": floor.cells[self.state % size].tolist(),
            "items": items, "unused": self._unused(), "advice": advice, "advised": advised,
        }  # fmt: skip

    def floor(self) -> list[str]:
        """The floor of the present factory, a text for each row: ``#`` wall, ``.`` free."""
        grid = self.present.task.factory.floor
        picture = np.full(grid.shape, "#")
        picture[tuple(grid.cells.T)] = "."
        return ["".join(row) for row in picture]

    def _unused(self) -> dict[str, list[list[int]]]:
        """Cells of the stations of other components; the robot sees them as stations too."""
        task = self.present.task
        cells, others = task.factory.floor.cells, np.ones(task.factory.n_components, bool)
        others[list(task.components)] = False
        points = {"procure": task.factory.procure_at, "assemble": task.factory.assemble_at}
        return {kind: cells[at[others]].tolist() for kind, at in points.items()}

    def _start(self) -> None:
        self.state = int(self.present.tables.starts[0])
        self.states: list[int] = []
        self.actions: list[int] = []
        self.reward, self.event = 0.0, 0
