"""Run claims: cells, finished ones kept, then numbers, marks, result file and figure.

Results do not depend on where cells run, nor on whether a run was stopped and taken up again.
"""

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

from lifelore.core.errors import InputError, StoreError
from lifelore.core.metrics import Estimate
from lifelore.core.protocols import Progress
from lifelore.core.usable_cores import usable_cores
from reproduction.engine.cell_store import CellStore, write_atomically
from reproduction.engine.claim import Claim
from reproduction.engine.provenance import provenance, source_key, versions
from reproduction.engine.registry import RESULTS, claim_ids, claim_of
from reproduction.engine.run_cells import CellRun, run_here, run_on_workers
from reproduction.engine.statement import word_of

RESULT_KEYS = (
    "claim", "mode", "verdict", "marks", "measured", "settings", "seed", "versions", "seconds", "made", "readings",
    "rows",
)  # fmt: skip
MAX_BYTES = 200_000
"""Largest ``result.json``: results are committed."""


def reproduce(
    ids: Sequence[str],
    mode: str = "quick",
    overrides: Mapping[str, Any] | None = None,
    jobs: int | None = None,
    out: str | Path = RESULTS,
    seed: int = 0,
    progress: Progress | None = None,
    scheduler: str | None = None,
) -> list[dict]:
    """Run claims and write ``<out>/<ID>/result.json`` and ``figure.png``.

    Parameters
    ----------
    ids : sequence of str
        Such as ``["C3.1"]``; empty: every claim.
    mode : {"quick", "full"}
        ``quick`` is for tests; only ``full`` is evidence.
    overrides : mapping, optional
        Settings to change, values or texts (``--set KEY=VALUE``); each must belong to every claim named.
    jobs : int, optional
        Cells that run at once, at least 1; default: one a core.
    out : path
        Folder of the results. A quick run never takes the place of a full one: where that is there already it
        writes into ``<out>/<ID>/quick``. Finished cells are kept in ``<out>/<ID>/cells`` (those that claims share
        in ``<out>/shared/cells``); a later run with the same settings, seed and code takes them up.
    seed : int
    progress : callable, optional
        ``progress(done, total, label)``, called from this thread as cells finish; both count the cells of all
        claims.
    scheduler : str, optional
        Address of a dask cluster whose workers run the cells, such as ``tcp://host:8786`` (extra ``cluster``);
        default: this machine, full runs in `jobs` processes, quick ones one cell after another.

    Returns
    -------
    list of dict
        The results, each with exactly `RESULT_KEYS`: `verdict` is the claim's word, `marks` has three marks by
        statement, `seconds` is the processor time of the cells, whenever and for whichever claim they
        were run, and `made` that of `provenance`.

    Raises
    ------
    NotFoundError
        An id that no claim has.
    InputError
        A mode, setting or number of jobs that breaks its rule; a cluster that cannot be used.
    MissingExtraError
        A cluster needs the extra ``cluster``.
    StoreError
        The disk refuses.
    KeyboardInterrupt
        Ctrl-C; finished cells are kept, those under way are dropped.
    """
    claims = [claim_of(claim_id) for claim_id in dict.fromkeys(ids or claim_ids())]
    plan = [ClaimRun(claim, mode, claim.settings(mode, overrides), seed) for claim in claims]
    results = []
    for claim, result in zip(claims, run_plan(plan, jobs, out, progress, scheduler), strict=True):
        _write(claim, result, result_folder(Path(out) / claim.id, mode))
        results.append(result)
    return results


class ClaimRun(NamedTuple):
    """A claim to run."""

    claim: Claim
    mode: str
    settings: dict
    seed: int


def run_plan(
    plan: Sequence[ClaimRun],
    jobs: int | None,
    out: str | Path,
    progress: Progress | None,
    scheduler: str | None = None,
) -> Iterator[dict]:
    """The results of claims, one after the other; cells are kept in `out`, results not written.

    Cells of all claims share the workers, so that none waits for the last cell of a claim. `progress` counts the
    cells of all.
    """
    jobs = usable_cores() if jobs is None else jobs
    if jobs < 1:
        raise InputError(f"jobs must be at least 1, got {jobs}")
    if not plan:
        return

    asked = [_cell_runs(run, Path(out)) for run in plan]
    places = [[one.store.path(one.cell) for one in own] for own in asked]
    once = dict(zip(chain(*places), chain(*asked), strict=True))  # claims that share a cell have one place for it
    kept = {place: found for place, one in once.items() if (found := one.store.get(one.cell)) is not None}
    missing = [place for place in once if place not in kept]
    cells = [once[place] for place in missing]

    shown, uses = progress or _silent, Counter(chain(*places))
    done, total = sum(uses[place] for place in kept), uses.total()
    shown(done, total, plan[0].claim.id)
    quick = all(run.mode == "quick" for run in plan)
    if scheduler is None and (quick or min(jobs, len(cells)) < 2):
        finished = run_here(cells)
    else:
        finished = run_on_workers(cells, jobs, scheduler)
    with closing(finished):
        for run, own in zip(plan, places, strict=True):
            while not kept.keys() >= set(own):
                number, cell = next(finished)
                kept[missing[number]] = cell
                done += uses[missing[number]]
                shown(done, total, run.claim.id)
            yield finish(run, [kept[place] for place in own])


def _silent(done: int, total: int, label: str) -> None:
    pass


def _cell_runs(run: ClaimRun, out: Path) -> list[CellRun]:
    store = _store(run, out)
    return [CellRun(run.claim, run.settings, run.seed, cell, store) for cell in run.claim.cells(run.settings)]


def _store(run: ClaimRun, out: Path) -> CellStore:
    """Where the finished cells of a run are; claims that share cells use one place."""
    claim = run.claim
    made = {"seed": run.seed, "code": source_key()}
    if claim.shared is None:
        return CellStore(out / claim.id / "cells", {"claim": claim.id, "settings": run.settings, **made})
    read = {name: run.settings[name] for name in claim.shared}
    name = f"{claim.run_cell.__module__}.{claim.run_cell.__qualname__}"
    return CellStore(out / "shared" / "cells", {"run": name, "settings": read, **made})


def stored_result(folder: Path, claim_id: str) -> dict | None:
    """The result in a folder; None where there is none.

    Raises
    ------
    StoreError, InputError
        It cannot be read, or is not JSON.
    """
    path = folder / "result.json"
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise StoreError(f"cannot read {path}: {error.strerror}") from None
    except ValueError:
        raise InputError(f"{path} is not JSON; run `lifelore reproduce {claim_id} --full` again") from None


def result_folder(folder: Path, mode: str) -> Path:
    """Where a result goes: evidence is never overwritten by a quick run."""
    kept = stored_result(folder, folder.name) if mode == "quick" else None
    return folder / "quick" if kept is not None and kept["mode"] == "full" else folder


def finish(run: ClaimRun, kept: Sequence[Mapping]) -> dict:
    """The result of a run from its finished cells, plain data."""
    claim, mode, settings, seed = run
    results = [found["result"] for found in kept]
    estimates, each = claim.measured(settings, results)
    measured, readings = _plain(estimates), [{"cell": dict(cell), **_plain(found)} for cell, found in each]
    data = claim.data if settings.get("real", True) else ()
    seconds = round(sum(found["seconds"] for found in kept), 1)
    values = (
        claim.id, mode, *judged(claim, measured, readings), measured, settings, seed, versions(), seconds,
        provenance(data), rounded(readings), rounded(claim.rows(settings, results)),
    )  # fmt: skip
    return json.loads(json.dumps(dict(zip(RESULT_KEYS, values, strict=True)), allow_nan=False))


def judged(claim: Claim, measured: Mapping, readings: Sequence[Mapping]) -> tuple[str, dict[str, list[str]]]:
    """The claim's word, and the three marks of each statement."""
    marks = [one.marks(measured, readings) for one in claim.statements]
    return word_of(claim.statements, marks, bool(claim.erratum)), {
        one.says: list(of) for one, of in zip(claim.statements, marks, strict=True)
    }


def _plain(estimates: Mapping[str, Estimate]) -> dict[str, Any]:
    return {name: rounded(estimate.to_dict()) for name, estimate in estimates.items()}


def rounded(data: Any) -> Any:
    """Plain data, floats to six significant digits; what is not finite becomes None: JSON has no word for it."""
    if isinstance(data, float):
        return float(f"{data:.6g}") if abs(data) < float("inf") else None
    if isinstance(data, Mapping):
        return {key: rounded(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [rounded(value) for value in data]
    return data


def _write(claim: Claim, result: dict, folder: Path) -> None:
    text = _one_row_a_line(result)
    if len(text.encode()) > MAX_BYTES:
        raise InputError(f"{claim.id}: result.json may hold {MAX_BYTES} bytes, got {len(text)}; compact its rows")
    write_atomically(folder / "result.json", text)
    draw(claim, result, folder)


def draw(claim: Claim, result: Mapping, folder: Path) -> None:
    """Draw ``figure.png``, and ``readings.png`` where there are several readings; nothing is run."""
    from lifelore.figures.style import house_style, save_figure
    from reproduction.engine.statement_figures import draw_numbers, draw_readings

    with house_style():
        save_figure(claim.draw(result) if claim.draw else draw_numbers(claim, result), folder / "figure.png")
        if len(result["readings"]) > 2:
            save_figure(draw_readings(claim, result), folder / "readings.png")


def _one_row_a_line(result: dict) -> str:
    """JSON that people and diffs can read: keys indented, each measured number, reading and row on a line."""
    lines = []
    for key, value in result.items():
        if key in ("measured", "marks"):
            inner = ",\n".join(f"  {json.dumps(k)}: {json.dumps(v, ensure_ascii=False)}" for k, v in value.items())
            lines.append(f' "{key}": {{\n{inner}\n }}')
        elif key in ("readings", "rows") and value:
            inner = ",\n".join(f"  {json.dumps(row)}" for row in value)
            lines.append(f' "{key}": [\n{inner}\n ]')
        else:
            lines.append(f" {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"
