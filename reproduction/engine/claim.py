"""A claim of the thesis as a folder: `claim.toml`, `run.py`, and `figure.py` where a figure is long.

- ``claim.toml``: the thesis's sentence, its statements with the conditions that make them true, settings.
- ``run.py``: ``cells(settings)`` lists the cells of a run (without it: `each_run`), ``run_cell(settings, cell,
  seed)`` computes one of them. Cells are independent plain dictionaries, run in any order in any thread
  or process. ``readings(settings, results)`` gives pairs of a reading of the choices left open (a plain mapping)
  and named estimates there, the default first; ``measure(settings, results)`` gives what is measured at the
  default beside the first reading, or instead of it. One of the two may be missing. ``rows(settings, results)``
  gives what the figure needs beside them, and may be missing. ``draw(result)``, here or in ``figure.py``, draws
  the thesis's figure, or ours beside others, from the finished result in the house style, which the engine sets;
  it runs nothing again. Most are functions of panels, see `reproduction.figures.panels`. Without it the picture
  shows the number of each statement beside its bound.

Claims with the same ``run_cell`` share their finished cells where a module has ``shared = ("pairs", "camera")``:
the names of the settings that ``run_cell`` reads. Without it all settings count, and cells belong to one claim.

Results of cells are plain data (what JSON can hold), so that a stored cell equals a fresh one.

Settings have limits: a rule for all, and the table ``[limits]`` of ``claim.toml`` for what differs. A whole
number is at least 1, other numbers, also in lists, are at least 0, a list is not empty. A limit such as
``share = { above = 0, most = 1 }`` or ``ties = { among = ["uniform", "prior"] }`` holds for a value, or for every
value of a list at any depth. No limit names another setting, so that one setting can be changed alone.
"""

import json
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from reproduction.engine.statement import Statement

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODES = ("quick", "full")

Settings = Mapping[str, Any]
Cell = Mapping[str, Any]
CellResult = Mapping[str, Any]
Estimates = Mapping[str, Estimate]


def each_run(settings: Settings) -> list[dict]:
    """The cells of a claim whose module `run` lists none: ``{"run": number}`` for each of its ``runs``."""
    return [{"run": number} for number in range(settings["runs"])]


def no_readings(settings: Settings, results: Sequence[CellResult]) -> list:
    """The readings of a claim without choices left open."""
    return []


def no_measures(settings: Settings, results: Sequence[CellResult]) -> dict:
    """The measures of a claim that measures nothing beside its first reading."""
    return {}


@dataclass(frozen=True)
class Claim:
    """One claim of the thesis as an experiment.

    Parameters
    ----------
    id, title : str
    sentence : str
        What the thesis says, in one sentence.
    thesis, here : str
        What the thesis prints and what was measured, in a few words for one row of a table; `here` and `decides`
        name measures in braces, see `filled`.
    decides : str
        What decides whether it holds, in at most two sentences.
    statements : tuple of Statement
        One or more of them central.
    sizes : mapping
        Settings by mode, ``quick`` (for tests) and ``full`` (evidence); the same keys in both.
    run_cell, draw, measure, cells, readings, rows : callable
        The functions of the claim's modules, see above. `run_cell` is pure, and picklable by name.
    figure : tuple of str
        The thesis's figures and tables that it reproduces, such as ``3.7`` and ``Table 3.1``.
    erratum : str
        The erratum that shows the thesis's formula or proof to be wrong; empty where there is none.
    limits : mapping
        What each setting may be, see `check_limits`.
    check : callable, optional
        ``check(settings)`` of the module `run` raises `InputError` for settings that limits cannot describe.
    data : tuple of str
        Folders in that of ``LIFELORE_DATA`` that it reads, unless its setting ``real`` is false.
    timed : bool
        Whether it measures time, which differs between runs of one seed: measures whose names start with
        ``seconds`` may differ then; no other may.
    shared : tuple of str, optional
        The settings that `run_cell` reads, if claims with the same `run_cell` share their finished cells.
    """

    id: str
    title: str
    sentence: str
    thesis: str
    here: str
    decides: str
    statements: tuple[Statement, ...]
    sizes: Mapping[str, Settings]
    run_cell: Callable[[Settings, Cell, int], dict]
    measure: Callable[[Settings, Sequence[CellResult]], Estimates] = no_measures
    cells: Callable[[Settings], list[dict]] = each_run
    readings: Callable[[Settings, Sequence[CellResult]], Iterable[tuple[Cell, Estimates]]] = no_readings
    rows: Callable[[Settings, Sequence[CellResult]], list[dict]] = no_readings
    draw: Callable[[Mapping], "Figure"] | None = None
    figure: tuple[str, ...] = ()
    erratum: str = ""
    limits: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    check: Callable[[Settings], None] | None = None
    data: tuple[str, ...] = ()
    timed: bool = False
    shared: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        if not any(one.central for one in self.statements):
            raise InputError(f"{self.id} must have a statement with central = true")

    @classmethod
    def load(cls, claim_id: str, folder: Path, package: str) -> "Claim":
        """The claim of a folder, its modules imported from `package`.

        Raises
        ------
        InputError
            ``claim.toml`` is no TOML, a key of it is missing or unknown, or a function is missing.
        """
        path = folder / "claim.toml"
        try:
            data = tomllib.loads(path.read_text(encoding="utf-8"))
        except tomllib.TOMLDecodeError as error:
            raise InputError(f"{path} is not TOML: {error}") from None
        functions = _functions(folder, package, data.get("settings", {}))
        try:
            full = data.pop("settings")
            sizes = {"quick": full | data.pop("quick", {}), "full": full}
            data["statements"] = tuple(Statement.parsed(**one) for one in data["statements"])
            for name in ("figure", "data"):
                data[name] = tuple(data.get(name, ()))
            return cls(id=claim_id, sizes=sizes, **data, **functions)
        except (KeyError, TypeError) as error:
            raise InputError(f"{path} must have the keys of a claim: {error}") from None

    def measured(
        self, settings: Settings, results: Sequence[CellResult]
    ) -> tuple[Estimates, list[tuple[Cell, Estimates]]]:
        """What is measured at the default, and in every reading."""
        readings = list(self.readings(settings, results))
        first = readings[0][1] if readings else {}
        return {**first, **self.measure(settings, results)}, readings

    @property
    def central(self) -> list[Statement]:
        """The statements that its word rests on."""
        return [one for one in self.statements if one.central]

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
        check_limits(settings, self.limits)
        if self.check:
            self.check(settings)
        return settings


def _functions(folder: Path, package: str, settings: Settings) -> dict[str, Any]:
    """The functions of a claim's modules by name, and `shared` where a module has it."""
    names = {path.stem for path in folder.glob("*.py")} & {"run", "figure"}
    scope = {
        name: value
        for module in sorted(names)
        for name, value in vars(import_module(f"{package}.{module}")).items()
    }
    known = ("run_cell", "draw", "measure", "readings", "cells", "rows", "check", "shared")
    found = {name: scope[name] for name in known if name in scope}
    if "run_cell" not in found or not {"measure", "readings"} & found.keys():
        raise InputError(f"modules of {folder} must define run_cell, and measure or readings")
    if unread := set(found.get("shared", ())) - settings.keys():
        raise InputError(f"shared of {folder} must name settings, got {', '.join(sorted(unread))}")
    return found


def _as_type_of(default: Any, value: Any, label: str) -> Any:
    """`value` as a setting of the type of `default`; texts are read first."""
    read = value
    if isinstance(value, str) and not isinstance(default, str):
        with suppress(ValueError):
            read = json.loads(value, parse_constant=int)  # refuses NaN and infinity, which no JSON may hold
    if isinstance(default, float) and type(read) is int:
        read = float(read)
    if type(read) is not type(default):
        raise InputError(f"{label} must be of the type of its default {json.dumps(default)}, got {value!r}")
    return read


BOUNDS = {
    "least": ("at least", lambda x, bound: x >= bound),
    "most": ("at most", lambda x, bound: x <= bound),
    "above": ("above", lambda x, bound: x > bound),
    "below": ("below", lambda x, bound: x < bound),
}
KEYS = {*BOUNDS, "among"}


def check_limits(settings: Mapping[str, Any], limits: Mapping[str, Mapping[str, Any]]) -> None:
    """Check settings against their limits.

    Raises
    ------
    InputError
        A setting breaks its limit, or a limit names a setting or rule that does not exist.
    """
    for key, limit in limits.items():
        if key not in settings or limit.keys() - KEYS:
            raise InputError(f"limits of '{key}' must name a setting and rules among {', '.join(sorted(KEYS))}")
    for key, value in settings.items():
        if value == []:
            raise InputError(f"{key} must hold at least one value, got []")
        limit = limits.get(key, {"least": 1 if isinstance(value, int) else 0})
        for item in _items(value):
            _check(key, item, limit)


def _check(key: str, item: Any, limit: Mapping[str, Any]) -> None:
    if "among" in limit and item not in limit["among"]:
        raise InputError(f"{key} must be among {', '.join(map(str, limit['among']))}, got {item}")
    if isinstance(item, (int, float)) and not isinstance(item, bool):
        for rule, bound in limit.items():
            if rule in BOUNDS and not BOUNDS[rule][1](item, bound):
                raise InputError(f"{key} must be {BOUNDS[rule][0]} {bound}, got {item}")


def _items(value: Any) -> Iterator[Any]:
    """The value itself, or the items of a list at any depth; nothing of a table."""
    if isinstance(value, list):
        for item in value:
            yield from _items(item)
    elif not isinstance(value, Mapping):
        yield value
