"""Run claims: cells on threads or a cluster, finished ones kept, then numbers, verdict, result file and figure.

Results do not depend on the number of threads or workers, nor on whether a run was stopped and taken up again.
"""

import json
from collections.abc import Generator, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import closing
from pathlib import Path
from time import thread_time
from typing import Any

from lifelore.core.errors import InputError, StoreError
from lifelore.core.protocols import Progress
from lifelore.core.usable_cores import usable_cores
from lifelore.experiments.engine.cell_store import CellStore, write_atomically
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.provenance import provenance, versions
from lifelore.experiments.engine.registry import built_ids, claim_of
from lifelore.experiments.engine.source_key import source_key

RESULT_KEYS = (
    "claim", "mode", "thesis", "measured", "verdict", "why", "second", "settings", "seed", "versions", "seconds",
    "made", "rows",
)  # fmt: skip
ENGINES = ("local", "dask")
MAX_BYTES = 200_000
"""Largest ``result.json``: results are committed."""


def reproduce(
    ids: Sequence[str],
    mode: str = "quick",
    overrides: Mapping[str, Any] | None = None,
    jobs: int | None = None,
    out: str | Path = "results",
    seed: int = 0,
    progress: Progress | None = None,
    engine: str = "local",
    scheduler: str | None = None,
) -> list[dict]:
    """Run claims and write ``<out>/<ID>/result.json`` and ``figure.png``.

    Parameters
    ----------
    ids : sequence of str
        Such as ``["C3.1"]``; empty: every claim that is built.
    mode : {"quick", "full"}
        ``quick`` is for tests; only ``full`` is evidence.
    overrides : mapping, optional
        Settings to change, values or texts (``--set KEY=VALUE``); each must belong to every claim named.
    jobs : int, optional
        Threads, at least 1; default: one a core.
    out : path
        Folder of the results. A quick run never takes the place of a full one: where that is there already it
        writes into ``<out>/<ID>/quick``. Finished cells are kept in ``<out>/<ID>/cells`` (those that claims share
        in ``<out>/shared/cells``); a later run with the same settings, seed and code takes them up.
    seed : int
    progress : callable, optional
        ``progress(done, total, label)``, called from this thread as cells finish; both count the cells of all
        claims.
    engine : {"local", "dask"}
        Where cells run: on threads here, or on the workers of a dask cluster (extra ``cluster``).
    scheduler : str, optional
        Address of the cluster, such as ``tcp://host:8786``.

    Returns
    -------
    list of dict
        The results, each with exactly `RESULT_KEYS`; `seconds` is the processor time of the cells' threads,
        whenever and for whichever claim they were run, `made` is that of `provenance`, and `second` the verdict of
        the second reading.

    Raises
    ------
    NotFoundError
        An id that is not in the ledger or not built.
    InputError
        A mode, setting or number of jobs that breaks its rule; a cluster that cannot be used.
    MissingExtraError
        Engine ``dask`` needs the extra ``cluster``.
    StoreError
        The disk refuses.
    KeyboardInterrupt
        Ctrl-C; cells under way are finished and kept first.
    """
    if engine not in ENGINES:
        raise InputError(f"engine must be one of {', '.join(ENGINES)}, got '{engine}'")
    if (engine == "dask") != (scheduler is not None):
        raise InputError(
            f"engine dask and scheduler belong together, got engine '{engine}' and scheduler {scheduler}; "
            "give --engine dask --scheduler tcp://HOST:8786, or neither"
        )
    claims = [claim_of(claim_id) for claim_id in dict.fromkeys(ids or built_ids())]
    plan = [(claim, claim.settings(mode, overrides), seed) for claim in claims]
    results = []
    for claim, result in zip(claims, run_plan(plan, mode, jobs, Path(out), progress, scheduler), strict=True):
        _write(claim, result, result_folder(Path(out) / claim.id, mode))
        results.append(result)
    return results


def run_plan(
    plan: Sequence[tuple[Claim, dict, int]],
    mode: str,
    jobs: int | None,
    out: Path,
    progress: Progress | None,
    scheduler: str | None = None,
) -> Iterator[dict]:
    """The results of claims with settings and seeds, one after the other; cells are kept, results not written.

    `progress` counts the cells of all.
    """
    jobs = usable_cores() if jobs is None else jobs
    if jobs < 1:
        raise InputError(f"jobs must be at least 1, got {jobs}")
    sizes, before = [len(claim.cells(settings)) for claim, settings, _ in plan], 0
    for (claim, settings, seed), size in zip(plan, sizes, strict=True):
        shown = _part_of(progress, before, sum(sizes)) if progress else _silent
        store = _store(claim, settings, seed, out)
        yield finish(claim, mode, settings, seed, _run_cells(claim, settings, seed, store, jobs, shown, scheduler))
        before += size


def _part_of(progress: Progress, before: int, total: int) -> Progress:
    """Progress of one claim as a part of the cells of all claims."""
    return lambda done, _, label: progress(before + done, total, label)


def _store(claim: Claim, settings: dict, seed: int, out: Path) -> CellStore:
    """Where the finished cells of a run are; claims that share cells use one place."""
    module = claim.run_cell.__module__
    made = {"seed": seed, "code": source_key(module)}
    if claim.shared is None:
        return CellStore(out / claim.id / "cells", {"claim": claim.id, "settings": settings, **made})
    read = {name: settings[name] for name in claim.shared}
    run = f"{module}.{claim.run_cell.__qualname__}"
    return CellStore(out / "shared" / "cells", {"run": run, "settings": read, **made})


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


def _silent(done: int, total: int, label: str) -> None:
    pass


def _run_cells(
    claim: Claim, settings: dict, seed: int, store: CellStore, jobs: int, progress, scheduler: str | None
) -> list[dict]:
    """All cells in order, stored ones read, the others run."""
    cells = claim.cells(settings)
    kept = [store.get(cell) for cell in cells]
    missing = [i for i, found in enumerate(kept) if found is None]
    done = len(cells) - len(missing)
    progress(done, len(cells), claim.id)

    wanted = [cells[i] for i in missing]
    if scheduler is None:
        finished = _on_threads(claim, settings, wanted, seed, store, jobs)
    else:
        finished = _on_cluster(claim, settings, wanted, seed, store, scheduler)
    with closing(finished):
        for place, cell in finished:
            kept[missing[place]] = cell
            done += 1
            progress(done, len(cells), claim.id)
    return kept  # type: ignore[return-value]


Finished = Generator[tuple[int, dict], None, None]
"""Place and content of each finished cell, which is stored already."""


def _on_threads(claim: Claim, settings: dict, cells: list, seed: int, store: CellStore, jobs: int) -> Finished:
    """Run cells on threads; where it is stopped, cells under way are finished and stored first."""
    from threadpoolctl import threadpool_limits

    def run(i: int) -> dict:
        began = thread_time()
        result = claim.run_cell(settings, cells[i], seed)
        return store.put(cells[i], result, thread_time() - began)

    # Cells share the cores among themselves; threads of a library's own would fight them, and change its sums.
    with threadpool_limits(1), ThreadPoolExecutor(max_workers=jobs) as pool:
        place: dict[Future, int] = {pool.submit(run, i): i for i in range(len(cells))}
        try:
            for future in as_completed(place):
                yield place[future], future.result()
        except BaseException:
            pool.shutdown(wait=True, cancel_futures=True)
            raise


def _on_cluster(
    claim: Claim, settings: dict, cells: list, seed: int, store: CellStore, scheduler: str
) -> Finished:
    """Run cells on a cluster; where it is stopped, cells under way are dropped."""
    from lifelore.experiments.engine.cluster import cells_on_cluster

    if cells:
        for place, result, seconds in cells_on_cluster(scheduler, claim.id, settings, cells, seed):
            yield place, store.put(cells[place], result, seconds)


def finish(claim: Claim, mode: str, settings: dict, seed: int, kept: Sequence[Mapping]) -> dict:
    """The result of a run from its finished cells, plain data.

    Measures that a condition, a figure or a page reads stand under ``measured``; the others are the last row,
    ``{"other_measures": …}``.
    """
    results = [found["result"] for found in kept]
    estimates = {name: rounded(estimate.to_dict()) for name, estimate in claim.measure(settings, results).items()}
    measured, others = split_measures(claim, estimates)
    rows = rounded(claim.rows(settings, results)) + others
    why = claim.predicate.why(measured, claim.causes)
    seconds = round(sum(found["seconds"] for found in kept), 1)
    module = claim.run_cell.__module__
    data = claim.data if settings.get("real", True) else ()
    values = (
        claim.id, mode, claim.thesis, measured, claim.predicate.verdict(measured), why, _second(claim, measured),
        settings, seed, versions(module), seconds, provenance(module, data), rows,
    )  # fmt: skip
    return json.loads(json.dumps(dict(zip(RESULT_KEYS, values, strict=True)), allow_nan=False))


def _second(claim: Claim, measured: Mapping[str, Mapping]) -> dict[str, str] | None:
    """The verdict of the second reading; None for a claim without one."""
    if claim.second is None:
        return None
    return {"verdict": claim.second.verdict(measured), "why": claim.second.said(measured)}


def split_measures(claim: Claim, estimates: Mapping[str, Mapping]) -> tuple[dict[str, Any], list[dict]]:
    """The measures that are read, and a row of the others (no row where there are none)."""
    read = claim.read_measures()
    others = {name: number for name, number in estimates.items() if name not in read}
    rows = [{"other_measures": others}] if others else []
    return {name: number for name, number in estimates.items() if name in read}, rows


def own_rows(result: Mapping) -> list[dict]:
    """The rows of a result without that of the other measures."""
    return [row for row in result["rows"] if "other_measures" not in row]


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
    from lifelore.figures.style import save_figure

    text = _one_row_a_line(result)
    if len(text.encode()) > MAX_BYTES:
        raise InputError(f"{claim.id}: result.json may hold {MAX_BYTES} bytes, got {len(text)}; compact its rows")
    write_atomically(folder / "result.json", text)
    save_figure(claim.draw({**result, "rows": own_rows(result)}), folder / "figure.png")


def _one_row_a_line(result: dict) -> str:
    """JSON that people and diffs can read: keys indented, each measured number and each row on a line."""
    lines = []
    for key, value in result.items():
        if key == "measured":
            inner = ",\n".join(f"  {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items())
            lines.append(f' "{key}": {{\n{inner}\n }}')
        elif key == "rows":
            inner = ",\n".join(f"  {json.dumps(row)}" for row in value)
            lines.append(f' "{key}": [\n{inner}\n ]')
        else:
            lines.append(f" {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"
