"""Whether the tasks of a life differ in anything that was observed: next states, ends of episodes, rewards.

A life whose tasks are all one decision process measures repetition, not transfer. The moves of each task are
compared with those of all tasks before it, as those of two types: what joins types calls tasks one.
"""

from lifelore.agent.any_tasks.known_moves import KnownMoves
from lifelore.agent.any_tasks.moves import Counts


class TaskDifferences:
    """Compares tasks while a life runs; after the first difference it counts nothing more."""

    def __init__(self) -> None:
        self.tasks, self.differ, self.moves = 0, False, Counts()

    def end_task(self, moves: Counts) -> None:
        """Compare the moves of a task with those before it."""
        self.tasks += 1
        if not self.differ:
            self.differ = self.tasks > 1 and len(KnownMoves([self.moves, moves]).joined()) > 1
            self.moves.update(moves)

    @property
    def one_task(self) -> bool:
        """Whether two tasks or more were compared and nothing tells them apart."""
        return self.tasks > 1 and not self.differ
