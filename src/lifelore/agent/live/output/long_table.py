"""Writes the measures of a life as CSV in long format: one value a row, as statistics programs take it.

    run,task,agent,episode,measure,value

`run` is the seed of the life. `episode` counts from 0 in each task, and is empty for a measure of the whole task.
"""

import csv
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from lifelore.agent.live.grid_life import Result
from lifelore.core.atomic_write import refused_writes

COLUMNS = ("run", "task", "agent", "episode", "measure", "value")


class LongTable(AbstractContextManager):
    """The file, written while the life runs: after each task, its rows are on disk. An older file is replaced.

    Parameters
    ----------
    path : path
    run : int
        Value of the column ``run``.

    Raises
    ------
    StoreError
        The file cannot be written.
    """

    def __init__(self, path: str | Path, run: int) -> None:
        self.path, self.run = Path(path), run
        with refused_writes(path, "measures"):
            self._file = self.path.open("w", newline="", encoding="utf-8")
        self._rows = csv.writer(self._file, lineterminator="\n")
        self._write([COLUMNS])

    def __exit__(self, *error: object) -> None:
        self._file.close()

    def add(
        self, task: Mapping[str, Any], episodes: Mapping[str, Mapping[str, Sequence[float] | NDArray]]
    ) -> None:
        """Write a finished task.

        Parameters
        ----------
        task : mapping
            Entry of the report's ``tasks``: ``index``, and ``agents``: agent to measure to value. Measures that
            are None are left out.
        episodes : mapping
            Agent to measure to the value of each episode.
        """
        rows: list[tuple[Any, ...]] = []
        for agent, measures in task["agents"].items():
            first = self.run, task["index"], agent
            rows += [(*first, "", name, _number(value)) for name, value in measures.items() if value is not None]
            for name, values in episodes[agent].items():
                rows += [(*first, number, name, _number(value)) for number, value in enumerate(values)]
        self._write(rows)

    def add_results(self, task: Mapping[str, Any], results: Mapping[str, Result]) -> None:
        """Write a finished task of `lifelore.agent.live.life.live`: its ``watch``."""
        self.add(task, {agent: result.episodes() for agent, result in results.items()})

    def _write(self, rows: Sequence[Sequence[Any]]) -> None:
        with refused_writes(self.path, "measures"):
            self._rows.writerows(rows)
            self._file.flush()


def _number(value: Any) -> float | int:
    """A plain number: truth values as 0 and 1; `repr` of a float reads back to the same bits."""
    number = float(value)
    return int(number) if number.is_integer() else number
