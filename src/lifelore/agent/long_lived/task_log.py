"""What happened in a task, decision by decision; explanations are made of it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.task_stream import DrawnTask

Array = NDArray[np.float64]


@dataclass
class Decision:
    """Why the agent did an act.

    act : int
    behaviour : int
        Number of the type whose behaviour was followed; the last stands for an unknown type.
    belief : (n_types + 1,) float64
        In the known types and, last, in an unknown one, before the act.
    expected : (n_types + 1,) float64
        Expected return of each behaviour under the belief.
    scene : str
    reward : float
    effects : tuple of (int, int)
    """

    act: int
    behaviour: int
    belief: Array
    expected: Array
    scene: str
    reward: float = 0.0
    effects: tuple[tuple[int, int], ...] = ()


@dataclass
class TaskLog:
    """What happened in a task.

    drawn : DrawnTask
    returns : list of float
        Of the episodes.
    decisions : list of list of Decision
        Of each episode.
    prior : (n_types,) float64
        Over the types that were known before the task.
    types : list of str
        Their names.
    alarm : bool
        Whether no known type fitted.
    alarm_score : float
        Largest score of the detector, in deviations of known tasks.
    learnt : str
        Name of the type that learnt most from the task.
    """

    drawn: DrawnTask
    returns: list[float] = field(default_factory=list)
    decisions: list[list[Decision]] = field(default_factory=list)
    prior: Array = field(default_factory=lambda: np.zeros(0))
    types: list[str] = field(default_factory=list)
    alarm: bool = False
    alarm_score: float = 0.0
    learnt: str = ""
