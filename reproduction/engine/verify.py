"""Run stored results again and compare them to the last digit (`lifelore reproduce --verify`)."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from lifelore.core.errors import NotFoundError
from lifelore.core.protocols import Progress
from reproduction.engine.provenance import data_hash
from reproduction.engine.registry import RESULTS, claim_ids, claim_of
from reproduction.engine.reproduce import ClaimRun, run_plan, stored_result

CIRCUMSTANCES = ("source", "processor", "simd", "data")
MOST_SHOWN = 20
"""Differences that are listed for a claim."""
ABSENT = "nothing"


def verify(
    ids: Sequence[str],
    jobs: int | None = None,
    out: str | Path = RESULTS,
    progress: Progress | None = None,
    scheduler: str | None = None,
) -> list[dict[str, Any]]:
    """Run the claims of stored results again, with their settings and seed, and compare the numbers.

    Nothing stored is changed, and no cell is taken up that was finished before.

    Parameters
    ----------
    ids : sequence of str
        Empty: every claim that has a result in `out`.
    jobs, progress, scheduler
        As for `reproduce`.
    out : path
        Folder of ``<ID>/result.json``.

    Returns
    -------
    list of dict
        For each claim: ``claim``; ``equal``: whether marks, measures, readings and rows are the same to the
        last of the six digits that results have, None where it was not run; ``missing``: folders of outside
        data that the stored result was made with and that are not here, so that it was not run; ``of``: the commit
        that the stored result was made at; ``n_differences`` and the first of them in ``differences``,
        ``{"where", "stored", "now"}``; ``changed``, the same for versions, code, processor and data, which may
        explain them; ``verdict``, ``seconds`` and ``made`` now. Measures of time, whose names begin with
        ``seconds``, are not compared, nor the rows of a claim that measures time.

    Raises
    ------
    NotFoundError
        There is no result of a claim.
    InputError
        A result is no JSON, or was made with settings that the claim has no more.
    """
    results = [_stored(Path(out), claim_id) for claim_id in dict.fromkeys(ids or _with_results(Path(out)))]
    missing = {result["claim"]: _missing(result) for result in results}
    ready = [result for result in results if not missing[result["claim"]]]
    with TemporaryDirectory() as folder:
        again = run_plan([_as_stored(result) for result in ready], jobs, folder, progress, scheduler)
        found = {stored["claim"]: compared(stored, new) for stored, new in zip(ready, again, strict=True)}
    return [found.get(result["claim"]) or _not_run(result, missing[result["claim"]]) for result in results]


def compared(stored: Mapping[str, Any], again: Mapping[str, Any]) -> dict[str, Any]:
    """What `verify` gives for one claim, from the stored result and the new one."""
    differences = list(_differences("", _numbers(stored), _numbers(again)))
    changed = list(_differences("", _circumstances(stored), _circumstances(again)))
    return {
        "claim": stored["claim"],
        "equal": not differences,
        "missing": [],
        "of": _commit_of(stored),
        "verdict": again["verdict"],
        "seconds": again["seconds"],
        "made": again["made"],
        "n_differences": len(differences),
        "differences": differences[:MOST_SHOWN],
        "changed": changed,
    }


def _missing(stored: Mapping[str, Any]) -> list[str]:
    """Outside data that a result was made with and that are not here."""
    made_with = stored.get("made", {}).get("data", {})
    return [name for name, key in made_with.items() if key is not None and data_hash(name) is None]


def _not_run(stored: Mapping[str, Any], missing: list[str]) -> dict[str, Any]:
    """What `verify` gives for a claim whose outside data are not here."""
    head = {"claim": stored["claim"], "equal": None, "missing": missing, "of": _commit_of(stored)}
    nothing = {"verdict": None, "seconds": 0.0, "made": None, "n_differences": 0, "differences": [], "changed": []}
    return head | nothing


def _commit_of(stored: Mapping[str, Any]) -> str | None:
    return stored.get("made", {}).get("commit")


def _with_results(out: Path) -> list[str]:
    found = [claim_id for claim_id in claim_ids() if (out / claim_id / "result.json").is_file()]
    if not found:
        raise NotFoundError(f"no result in {out}; name the folder of the results with --out")
    return found


def _stored(out: Path, claim_id: str) -> dict[str, Any]:
    claim_of(claim_id)
    found = stored_result(out / claim_id, claim_id)
    if found is None:
        raise NotFoundError(f"no result of {claim_id} in {out}; run `lifelore reproduce {claim_id}` first")
    return found


def _as_stored(result: Mapping[str, Any]) -> ClaimRun:
    claim = claim_of(result["claim"])
    return ClaimRun(claim, result["mode"], claim.settings(result["mode"], result["settings"]), result["seed"])


def _numbers(result: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "verdict": result["verdict"],
        "marks": result["marks"],
        "measured": {name: n for name, n in result["measured"].items() if not name.startswith("seconds")},
        "readings": result["readings"],
        "rows": [] if claim_of(result["claim"]).timed else result["rows"],
    }


def _circumstances(result: Mapping[str, Any]) -> dict[str, Any]:
    """What may differ without a fault."""
    return {"versions": result["versions"], **{name: result["made"][name] for name in CIRCUMSTANCES}}


def _differences(where: str, stored: Any, now: Any) -> Iterator[dict[str, Any]]:
    """The places where plain data differ; the order of keys does not count."""
    if isinstance(stored, Mapping) and isinstance(now, Mapping):
        for key in dict.fromkeys([*stored, *now]):
            yield from _differences(f"{where}.{key}".lstrip("."), stored.get(key, ABSENT), now.get(key, ABSENT))
    elif isinstance(stored, list) and isinstance(now, list):
        for place, (one, other) in enumerate(zip_longest(stored, now, fillvalue=ABSENT)):
            yield from _differences(f"{where}[{place}]", one, other)
    elif stored != now:
        yield {"where": where, "stored": stored, "now": now}
