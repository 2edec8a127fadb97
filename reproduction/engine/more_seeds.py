"""A claim under several seeds, pooled: for verdicts that lie so near a bound that a seed may decide them.

The seeds are independent. Of values v_i with intervals [v_i − l_i, v_i + h_i] under k seeds, the pool has

    v = mean v_i,   [v − √(Σ l_i²) / k,  v + √(Σ h_i²) / k]

Outside data is the same under every seed: the pooled intervals of its numbers are too narrow. The page says so.
Only the counted conditions of the second reading are pooled. Where the seeds' own verdicts differ, the page says
that the verdict depends on the seed.
"""

import json
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress
from reproduction.engine.cell_store import write_atomically
from reproduction.engine.claim import Claim
from reproduction.engine.condition_table import COUNTED
from reproduction.engine.predicate import Measured
from reproduction.engine.registry import claim_of
from reproduction.engine.reproduce import ClaimRun, result_folder, rounded, run_plan, stored_result
from reproduction.engine.second_reading import GRID, ReadCondition

FILE = "seeds.json"


def run_seeds(
    ids: Sequence[str],
    n_seeds: int,
    mode: str = "quick",
    overrides: Mapping[str, Any] | None = None,
    jobs: int | None = None,
    out: str | Path = "results",
    seed: int = 0,
    progress: Progress | None = None,
) -> list[dict]:
    """Run claims under `n_seeds` seeds from `seed` on, and write the pool to ``<out>/<ID>/seeds.json``.

    The first seed's stored result is taken where it has the same settings.

    Returns
    -------
    list of dict
        ``claim``, ``mode``, ``seeds``, ``settings``, ``pooled`` (numbers of the counted conditions), ``verdict``,
        ``why``, ``by_seed`` (``seed``, ``verdict``, ``measured``, ``seconds``, ``made`` of each).

    Raises
    ------
    InputError
        Fewer than two seeds; a claim without a second reading; else as `reproduce`.
    """
    if n_seeds < 2:
        raise InputError(f"seeds must be at least 2, got {n_seeds}; leave it out to run one")
    if not ids:
        raise InputError("seeds runs the claims that are named, and none is; name some, such as C3.17")
    claims = [claim_of(claim_id) for claim_id in dict.fromkeys(ids)]
    if once := [claim.id for claim in claims if claim.second is None]:
        raise InputError(f"seeds are pooled for second readings alone; {', '.join(once)} has none")
    chosen = [(claim, claim.settings(mode, overrides)) for claim in claims]
    stored = [_stored(claim, Path(out), mode, settings, seed) for claim, settings in chosen]
    seeds = [range(seed + len(kept), seed + n_seeds) for kept in stored]
    plan = [
        ClaimRun(claim, mode, settings, each)
        for (claim, settings), own in zip(chosen, seeds, strict=True)
        for each in own
    ]
    ready = sum(len(claim.cells(settings)) for (claim, settings), kept in zip(chosen, stored, strict=True) if kept)
    shown = _after(ready, progress) if progress else None
    runs, found = run_plan(plan, jobs, out, shown), []
    for claim, kept, own in zip(claims, stored, seeds, strict=True):
        found.append(_pool(claim, [*kept, *islice(runs, len(own))]))
        text = json.dumps(found[-1], indent=1, ensure_ascii=False) + "\n"
        write_atomically(result_folder(Path(out) / claim.id, mode) / FILE, text)
    return found


def _after(ready: int, progress: Progress) -> Progress:
    """Progress that also counts cells that were ready before."""
    return lambda done, total, label: progress(ready + done, ready + total, label)


def _stored(claim: Claim, out: Path, mode: str, settings: Mapping, seed: int) -> list[dict]:
    """The stored result of a seed, if it has these settings and all that the reading counts; else nothing."""
    kept = stored_result(result_folder(out / claim.id, mode), claim.id)
    if kept is None or not kept.get("second") or not set(_counted(claim)) <= kept["measured"].keys():
        return []
    return [kept] if (kept["mode"], kept["settings"], kept["seed"]) == (mode, settings, seed) else []


def _counted(claim: Claim) -> list[str]:
    """The measures that the second reading counts, sorted."""
    assert claim.second is not None, "run_seeds has looked"
    return sorted({one.condition.measure for one in claim.second.conditions if one.role in COUNTED})


def _pool(claim: Claim, results: Sequence[Mapping]) -> dict:
    assert claim.second is not None, "run_seeds has looked"
    read = _counted(claim)
    missing = {"value": None, "ci95": None, "n": 0}
    measured = {name: [result["measured"].get(name, missing) for result in results] for name in read}
    pool = {name: rounded(pooled(numbers)) for name, numbers in measured.items()}
    return {
        "claim": claim.id,
        "mode": results[0]["mode"],
        "seeds": [result["seed"] for result in results],
        "settings": results[0]["settings"],
        "pooled": pool,
        "verdict": claim.second.verdict(pool),
        "why": claim.second.said(pool),
        "by_seed": [
            {
                "seed": result["seed"],
                "verdict": result["second"]["verdict"],
                "measured": {name: result["measured"].get(name) for name in read},
                "seconds": result["seconds"],
                "made": result["made"],
            }
            for result in results
        ],
    }


def pooled(numbers: Sequence[Mapping]) -> dict[str, Any]:
    """One number under several seeds, pooled; without a value where a seed has none.

    >>> ones = [{"value": 1.0, "ci95": [0.0, 2.0], "n": 5}, {"value": 2.0, "ci95": [1.0, 3.0], "n": 5}]
    >>> {key: value for key, value in pooled(ones).items() if key != "ci95"}
    {'value': 1.5, 'n': 10}
    >>> [round(end, 3) for end in pooled(ones)["ci95"]]
    [0.793, 2.207]
    """
    n = sum(number["n"] for number in numbers)
    if any(number["value"] is None for number in numbers):
        return {"value": None, "ci95": None, "n": n}
    value = float(np.mean([number["value"] for number in numbers]))
    if not all(number["ci95"] and None not in number["ci95"] for number in numbers):
        return {"value": value, "ci95": None, "n": n}
    apart = np.array([[number["value"] - end for end in number["ci95"]] for number in numbers])
    low, high = np.sqrt((apart**2).sum(axis=0)) / len(numbers)
    return {"value": value, "ci95": [value - float(low), value + float(high)], "n": n}


def deciding_conditions(claim: Claim, measured: Measured) -> list[str]:
    """Names of the conditions whose number would turn the verdict if it moved by its interval's width.

    A share of a grid has no interval: it moves by one cell.
    """
    if claim.second is None:
        return []
    verdict = claim.second.verdict(measured)
    return [
        one.condition.name
        for one in claim.second.conditions
        if any(
            claim.second.verdict({**measured, one.condition.measure: other}) != verdict
            for other in _moved(one, measured.get(one.condition.measure))
        )
    ]


def _moved(one: ReadCondition, number: Mapping[str, Any] | None) -> list[dict[str, Any]]:
    """The number of a counted condition, moved down and up as far as chance may move it; empty if it is exact."""
    if one.role not in COUNTED or not number or number["value"] is None:
        return []
    ends = number["ci95"]
    if ends is None:
        return _by_a_cell(number) if one.role == GRID and one.exact else []
    if one.exact or None in ends:
        return []
    width = ends[1] - ends[0]
    return [
        {**number, "value": number["value"] + by, "ci95": [end + by for end in ends]} for by in (-width, width)
    ]


def _by_a_cell(share: Mapping[str, Any]) -> list[dict[str, Any]]:
    """A share of a grid with a cell less and a cell more."""
    n = share["n"]
    yes = round(share["value"] * n)
    return [{**share, "value": some / n} for some in (yes - 1, yes + 1) if 0 <= some <= n]
