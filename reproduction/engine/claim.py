"""A claim of the thesis as a folder: `claim.toml` and the modules `run`, `measure` and `figure`.

- ``claim.toml``: title, what the thesis reports, settings with their limits, and the conditions and rules of the
  verdict.
- ``run.py``: ``cells(settings)`` lists the cells of a run (without it: `each_run`), ``run_cell(settings, cell,
  seed)`` computes one of them. Cells are independent plain dictionaries, run in any order in any thread
  or process.
- ``measure.py``: ``measure(settings, results)`` gives named estimates, ``rows(settings, results)`` compact rows.
- ``figure.py``: ``draw(result)`` draws the finished result; it runs nothing again.

A small claim may leave out one or two of the modules; their functions then stand in a module that is there.

Claims with the same ``run_cell`` share their finished cells where a module has ``shared = ("pairs", "camera")``:
the names of the settings that ``run_cell`` reads. Without it all settings count, and cells belong to one claim.

Results of cells are plain data (what JSON can hold), so that a stored cell equals a fresh one.
"""

import json
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from reproduction.engine.limits import check_limits
from reproduction.engine.predicate import Condition, Predicate
from reproduction.engine.second_reading import SecondReading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODES = ("quick", "full")
MODULES = ("run", "measure", "figure")
FUNCTIONS = ("cells", "run_cell", "measure", "rows", "draw")
REQUIRED = {"title", "thesis", "where", "ran", "settings", "conditions", "rules"}
OPTIONAL = {"limits", "named", "timed", "data", "second", "sentence", "reason", "more", "refiled"}
"""Keys of ``claim.toml``."""

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
    where : str
        Section, figure or table of the thesis.
    ran : str
        What was run, in two sentences.
    sizes : mapping
        Settings by mode, ``quick`` (for tests) and ``full`` (evidence); the same keys in both.
    limits : mapping
        What each setting may be, see `check_limits`.
    predicate : Predicate
        Conditions and rules of the verdict.
    causes : mapping
        Likely cause by condition of either reading, reported where the condition is not met.
    shown_by : mapping
        The erratum whose tests show a cause, by condition; a cause without one is untested.
    named : tuple of str
        Measures beside those of conditions that a figure or a page reads; all others are stored in the rows.
    cells, run_cell, measure, rows, draw : callable
        The functions of the claim's modules, see above. `run_cell` is pure, and picklable by name.
    check : callable, optional
        ``check(settings)`` of the module `run` raises `InputError` for settings that limits cannot describe.
    data : tuple of str
        Folders in that of ``LIFELORE_DATA`` that it reads, unless its setting ``real`` is false.
    timed : bool
        Whether it measures time, which differs between runs of one seed: measures whose names start with
        ``seconds`` may differ then; no other may.
    second : SecondReading, optional
        A second reading of the verdict.
    sentence : str
        What the claim says in one plain sentence, true or false, for the list of all claims.
    reason : str
        Why the verdict is what it is, or what limits it, in one clause; see `reason_in_words`.
    plain : mapping
        Words for pages by condition, where the filed ones cannot be understood alone; they ask the same.
    more : str
        What else was run, and choices; folded on the page.
    refiled : str
        What was filed anew of the second reading after a run of it, and why; folded on the page.
    shared : tuple of str, optional
        The settings that `run_cell` reads, if claims with the same `run_cell` share their finished cells.
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
    where: str = ""
    ran: str = ""
    limits: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    causes: Mapping[str, str] = field(default_factory=dict)
    named: tuple[str, ...] = ()
    check: Callable[[Settings], None] | None = None
    timed: bool = False
    data: tuple[str, ...] = ()
    second: SecondReading | None = None
    shown_by: Mapping[str, str] = field(default_factory=dict)
    sentence: str = ""
    reason: str = ""
    plain: Mapping[str, str] = field(default_factory=dict)
    more: str = ""
    refiled: str = ""
    shared: tuple[str, ...] | None = None

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
        missing, unknown = REQUIRED - data.keys(), data.keys() - REQUIRED - OPTIONAL
        if missing or unknown:
            keys = (
                f"missing {', '.join(sorted(missing)) or 'none'}, unknown {', '.join(sorted(unknown)) or 'none'}"
            )
            raise InputError(f"{path} must have the keys of a claim; {keys}")
        modules = [import_module(f"{package}.{name}") for name in MODULES if (folder / f"{name}.py").is_file()]
        found = {
            name: [vars(m)[name] for m in modules if name in vars(m)] for name in (*FUNCTIONS, "check", "shared")
        }
        found["cells"] = found["cells"] or [each_run]
        full = data["settings"]["full"]
        absent = [name for name in FUNCTIONS if not found[name]]
        unread = {name for names in found["shared"] for name in names} - full.keys()
        if unread:
            raise InputError(f"shared of {folder} must name settings, got {', '.join(sorted(unread))}")
        if absent:
            raise InputError(
                f"modules of {folder} must define {', '.join(FUNCTIONS)}; missing {', '.join(absent)}"
            )
        predicate = Predicate.from_data(data)
        second = data.get("second", {}).get("conditions", [])
        explained = [(c.get("name", c.get("first")), c) for c in (*data["conditions"], *second)]
        return cls(
            id=claim_id,
            title=data["title"],
            thesis=data["thesis"],
            where=data["where"],
            ran=data["ran"],
            sizes={"quick": full | data["settings"].get("quick", {}), "full": full},
            limits=data.get("limits", {}),
            predicate=predicate,
            causes={name: c["cause"] for name, c in explained if "cause" in c},
            shown_by={name: c["shown_by"] for name, c in explained if "shown_by" in c},
            named=tuple(data.get("named", ())),
            timed=data.get("timed", False),
            data=tuple(data.get("data", ())),
            sentence=data.get("sentence", data["title"]),
            reason=data.get("reason", ""),
            plain={name: c["plain"] for name, c in explained if "plain" in c},
            more=data.get("more", ""),
            refiled=data.get("refiled", ""),
            second=SecondReading.from_data(data["second"], predicate) if "second" in data else None,
            **{name: functions[0] for name, functions in found.items() if functions},
        )

    def words_of(self, condition: Condition) -> str:
        """The words of a condition for people to read."""
        return self.plain.get(condition.name, condition.words)

    def causes_in_words(self) -> dict[str, str]:
        """`causes`, each with the erratum whose tests show it, or *untested*."""
        shown = {name: f"shown by tests: {erratum}" for name, erratum in self.shown_by.items()}
        return {name: f"{cause} ({shown.get(name, 'untested')})" for name, cause in self.causes.items()}

    def read_measures(self) -> set[str]:
        """Names of the measures that conditions, figures or pages read."""
        second = self.second.measures if self.second else set()
        return {condition.measure for condition in self.predicate.conditions} | second | set(self.named)

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


def each_run(settings: Settings) -> list[dict]:
    """The cells of a claim whose module `run` lists none: ``{"run": number}`` for each of its ``runs``."""
    return [{"run": number} for number in range(settings["runs"])]


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
