"""A claim: settings and predicate as data, a pure run of one cell, and what is measured from the cells.

Cells are the pieces a run is made of: independent, each a plain dictionary, run in any order on any thread.
Everything that crosses a border here is plain data (what JSON can hold), so that a stored cell equals a fresh one.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.engine.predicate import Predicate

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODES = ("quick", "full")

Settings = Mapping[str, Any]
Cell = Mapping[str, Any]
CellResult = Mapping[str, Any]


@dataclass(frozen=True)
class Claim:
    """One claim of the thesis as an experiment.

    Parameters
    ----------
    id, title : str
    thesis : str
        What the thesis reports.
    sizes : mapping
        Settings by mode, ``quick`` (for tests) and ``full`` (evidence); the same keys in both.
    predicate : Predicate
        What decides the verdict.
    cells : callable
        ``cells(settings)``: the cells of a run.
    run_cell : callable
        ``run_cell(settings, cell, seed)``: one cell's result; pure, and picklable by name.
    measure : callable
        ``measure(settings, results)``: named numbers from all cells' results, in the order of `cells`.
    rows : callable
        ``rows(settings, results)``: what is kept of the results, compact; the figure is drawn from it.
    draw : callable
        ``draw(result)``: the figure, from the finished result alone; nothing is run again.
    causes : mapping
        Likely cause by condition, said where the condition is not met.
    check : callable, optional
        ``check(settings)`` raises `InputError` for overridden settings that cannot be run.
    timed : bool
        Whether it measures time, which no two runs share: measures whose names start with ``seconds`` may then
        differ between runs of one seed; no other may.
    """

    id: str
    title: str
    thesis: str
    sizes: Mapping[str, Settings]
    predicate: Predicate
    cells: Callable[[Settings], list[dict]]
    run_cell: Callable[[Settings, Cell, int], dict]
    measure: Callable[[Settings, Sequence[CellResult]], dict[str, Estimate]]
    rows: Callable[[Settings, Sequence[CellResult]], list[dict]]
    draw: Callable[[Mapping], "Figure"]
    causes: Mapping[str, str] = field(default_factory=dict)
    check: Callable[[Settings], None] | None = None
    timed: bool = False

    def settings(self, mode: str, overrides: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """The settings of a mode, with some of them overridden.

        Parameters
        ----------
        mode : {"quick", "full"}
        overrides : mapping
            Values, or texts as given to ``--set KEY=VALUE`` (numbers, ``true``, a list in JSON).

        Raises
        ------
        InputError
            An unknown mode or key, or a value of another type than the setting's.
        """
        if mode not in MODES:
            raise InputError(f"mode must be one of {', '.join(MODES)}, got '{mode}'")
        settings = dict(self.sizes[mode])
        for key, value in (overrides or {}).items():
            if key not in settings:
                raise InputError(f"{self.id} has no setting '{key}'; it has {', '.join(settings)}")
            settings[key] = _as_type_of(settings[key], value, f"{self.id} setting '{key}'")
        if self.check:
            self.check(settings)
        return settings


def _as_type_of(default: Any, value: Any, label: str) -> Any:
    """`value` as a setting of the type of `default`; texts are read first."""
    read = value
    if isinstance(value, str) and not isinstance(default, str):
        try:
            read = json.loads(value)
        except ValueError:
            read = value
    if isinstance(default, float) and isinstance(read, int) and not isinstance(read, bool):
        read = float(read)
    # NaN and infinity pass json.loads, but no JSON that others read may hold them.
    if type(read) is not type(default) or not _is_plain(read):
        raise InputError(f"{label} must be {_kind(default)}, got {value!r}; the default is {json.dumps(default)}")
    return read


def _is_plain(value: Any) -> bool:
    try:
        json.dumps(value, allow_nan=False)
    except (TypeError, ValueError):
        return False
    return True


def _kind(default: Any) -> str:
    names = {bool: "true or false", int: "a whole number", float: "a number", str: "a text", list: "a list"}
    return names.get(type(default), "a JSON object")
