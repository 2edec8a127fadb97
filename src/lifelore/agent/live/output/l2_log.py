"""Writes a life as a log folder that L2Logger and L2Metrics read (log format 1.1).

    FOLDER/SCENARIO-TIMESTAMP/
        logger_info.json     which columns are measures of performance, and the version of the format
        scenario_info.json   description of the scenario
        worker-0/NUMBER-TYPE/data-log.tsv   one row an experience: nine standard columns, then ours by name

A block is a sequence of experiences of one type: ``train`` (the agent learns) or ``test`` (it only acts). Format:
github.com/lifelong-learning-systems/l2logger, docs/log_format.md and docs/interface.md.
"""

import csv
import json
import re
from collections.abc import Iterable, Mapping
from datetime import datetime
from io import StringIO
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from lifelore.agent.live.baselines import AGENTS
from lifelore.agent.live.grid_life import Result
from lifelore.agent.live.output.folder import folder_to_write
from lifelore.agent.live.task_result import TaskResult
from lifelore.core.errors import InputError

VERSION = "1.1"
STANDARD = (
    "block_num", "exp_num", "worker_id", "block_type", "block_subtype", "task_name", "task_params", "exp_status",
    "timestamp",
)  # fmt: skip
TYPES = ("train", "test")
WORKER = "worker-0"
_NAME = re.compile(r"[0-9a-zA-Z]+_[0-9a-zA-Z]+")
_SCENARIO = re.compile(r"[0-9a-zA-Z_\-]+")
_TIME = "%Y%m%dT%H%M%S.%f"


class L2Log:
    """The log of one scenario, written while it runs.

    Parameters
    ----------
    folder : path
        The folder of the scenario is made in it.
    scenario : str
        Name of letters, digits, ``_`` and ``-``; the time is added to it.
    measures : iterable of str
        Names of the columns that measure performance, at least one; each call of `add` needs them.
    info : mapping, optional
        Description as JSON. L2Metrics reads ``author``, ``complexity`` (1-low, 2-intermediate,
        3-high), ``difficulty`` (1-easy, 2-medium, 3-hard) and ``scenario_type`` (condensed, dispersed, permuted,
        alternating, ste, custom).

    Raises
    ------
    InputError, StoreError
        An argument breaks its rule; the folder cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     log = L2Log(folder, "maze", ["performance"])
    ...     log.add("train", "maze_0", {"performance": [0.1, 0.4]})
    """

    def __init__(
        self, folder: str | Path, scenario: str, measures: Iterable[str], info: Mapping | None = None
    ) -> None:
        self.measures = list(measures)
        if not self.measures or set(self.measures) & set(STANDARD):
            raise InputError(f"measures must be at least one column that is not standard, got {self.measures}")
        if not _SCENARIO.fullmatch(scenario):
            raise InputError(f"scenario must be of letters, digits, _ and -, got '{scenario}'")
        moment = datetime.now().timestamp()
        self.path = Path(folder) / f"{scenario}-{moment:.6f}".replace(".", "-")
        self._columns: list[str] | None = None
        self._block, self._type, self._experiences = -1, "", 0
        logger = {"metrics_columns": self.measures, "log_format_version": VERSION}
        for name, data in (("logger_info", logger), ("scenario_info", dict(info or {}))):
            _write(self.path / f"{name}.json", json.dumps(data, indent=2))

    def add(
        self,
        block_type: str,
        task_name: str,
        columns: Mapping[str, ArrayLike],
        *,
        params: Mapping | None = None,
        complete: ArrayLike = True,
    ) -> None:
        """Add experiences of one task, in order; a `block_type` other than the last one begins a new block.

        Parameters
        ----------
        block_type : {"train", "test"}
        task_name : str
            ``label_variant``, both of letters and digits; readers convert it to lower case.
        columns : mapping of str to (n,) numbers
            The measures and other columns; the same names at each call.
        params : mapping, optional
            The task's parameters, as JSON.
        complete : bool or (n,) bool
            False where an experience was interrupted; L2Metrics leaves it out.
        """
        rows = self._checked(block_type, task_name, columns)
        done = np.broadcast_to(np.asarray(complete, bool), len(rows))
        if block_type != self._type:
            self._block, self._type = self._block + 1, block_type
        standard = [self._block, 0, WORKER, block_type, "wake", task_name, json.dumps(dict(params or {}))]
        written = []
        for row, whole in zip(rows, done, strict=True):
            standard[1] = self._experiences + len(written)
            status = "complete" if whole else "incomplete"
            written.append([*standard, status, datetime.now().strftime(_TIME), *row])
        self._write(written)
        self._experiences += len(written)

    def _checked(self, block_type: str, task_name: str, columns: Mapping[str, ArrayLike]) -> list[tuple]:
        """The values row by row, columns in order of name."""
        if block_type not in TYPES:
            raise InputError(f"block_type must be one of {', '.join(TYPES)}, got '{block_type}'")
        if not _NAME.fullmatch(task_name):
            raise InputError(f"task_name must be label_variant, of letters and digits, got '{task_name}'")
        names = sorted(columns)
        if not set(self.measures) <= set(names) or set(names) & set(STANDARD):
            raise InputError(
                f"columns must hold {', '.join(self.measures)} and no standard column, got {', '.join(names)}"
            )
        if names != (self._columns or names):
            raise InputError(f"columns must stay {', '.join(self._columns or names)}, got {', '.join(names)}")
        values = [np.asarray(columns[name]) for name in names]
        if len({value.shape for value in values}) != 1 or values[0].ndim != 1:
            raise InputError(f"columns must be equally long rows, got {[value.shape for value in values]}")
        self._columns = names
        return list(zip(*(value.tolist() for value in values), strict=True))

    def _write(self, rows: list[list]) -> None:
        file = self.path / WORKER / f"{self._block}-{self._type}" / "data-log.tsv"
        text = StringIO()
        table = csv.writer(text, delimiter="\t", lineterminator="\n")
        table.writerows(rows if file.exists() else [[*STANDARD, *(self._columns or [])], *rows])
        _write(file, text.getvalue())


def _write(file: Path, text: str) -> None:
    """Append to a file, in a folder that is made if it is missing."""
    with folder_to_write(file.parent, "folder"), file.open("a", encoding="utf-8", newline="") as out:
        out.write(text)


class LifeLog:
    """The log of a life: one scenario for each agent with memory, one for each task of an agent without memory.

    Parameters
    ----------
    folder : path
    domain : str
        Label of the tasks; each task's variant is the cell of its goal.

    Examples
    --------
    ``live(settings, watch=LifeLog("logs", settings.world.domain).add_results)``
    """

    def __init__(self, folder: str | Path, domain: str) -> None:
        self.folder, self._label = Path(folder), re.sub("[^0-9a-zA-Z]", "", domain) or "task"
        self._lives: dict[str, L2Log] = {}
        # A folder that cannot be made fails here, before the long run.
        with folder_to_write(folder, "folder"):
            pass

    def add_results(self, task: Mapping, results: Mapping[str, Result]) -> None:
        """Log one finished task; pass it to `live` as ``watch``. Driven tasks have no episodes."""
        row, column = task["goal"]
        for name, result in results.items():
            if not isinstance(result, TaskResult):
                continue
            self._of(name, task["index"]).add(
                "train",
                f"{self._label}_{row}x{column}",
                _columns(result),
                params={"goal": [row, column], "index": task["index"], "optimal_return": task["optimal_return"]},
                complete=np.arange(len(result.curve.returns)) < result.complete,
            )

    def _of(self, name: str, index: int) -> L2Log:
        measures = ("reward", "performance", "reached")
        if not (AGENTS[name].uses_prior or AGENTS[name].remembers):
            return L2Log(self.folder, f"{name}-task{index}", measures, {"scenario_type": "ste", "agent": name})
        if name not in self._lives:
            info = {"scenario_type": "custom", "agent": name}
            self._lives[name] = L2Log(self.folder, name, measures, info)
        return self._lives[name]


def _columns(result: TaskResult) -> dict[str, np.ndarray]:
    curve = result.curve
    return {
        "reward": curve.rewards,
        "performance": curve.returns,
        "reached": curve.reached.astype(int),
        "episode_step_count": curve.steps,
        "collisions": curve.collisions,
    }
