"""A part of the reproduction's first page: how to run it again, what that costs, and what came of it last."""

from collections.abc import Mapping, Sequence

from reproduction.engine.registry import claim_of
from reproduction.engine.source_key import foreign_modules

SIMULATOR = "mujoco"


def run_again(found: Sequence[Mapping], verified: Sequence[Mapping], figures: str) -> list[str]:
    """Lines of Markdown.

    Parameters
    ----------
    found : sequence of results
        Each as `reproduce` gives it.
    verified : sequence of mappings
        What `verify` gave last, ``<results>/verify.json``; may be empty.
    figures : str
        The folder of the results as the page's links see it.
    """
    physics = [result for result in found if simulates_physics(result["claim"])]
    whose = ", ".join(result["claim"] for result in physics) or "none"
    lines = [
        "## Run it again",
        "",
        "`lifelore reproduce --verify` runs every stored result again, with its settings and seed, and compares",
        "the numbers to the last digit; `lifelore reproduce --verify C3.2` does so for one claim. Results with",
        "outside data are compared where `LIFELORE_DATA` has these; else their simulated parts run with",
        "`--full --set real=false`. What claims share is run once, and the cores share the work: all claims take",
        f"{minutes(found):.0f} minutes of processor time, {minutes(physics):.0f} of them claims that simulate",
        f"physics ({whose}).",
        "[How long that is on the clock](../performance.md#reproducing-all-claims).",
        "",
    ]
    if verified:
        lines += [f"[Last run]({figures}/verify.json): {_last_run(found, verified)}", ""]
    return lines


def _last_run(found: Sequence[Mapping], verified: Sequence[Mapping]) -> str:
    """What came of the last runs, and which results were made since."""
    run = [one for one in verified if one["equal"] is not None]
    made = {(one["made"]["date"], one["made"]["commit"][:7], one["made"]["processor"]) for one in run}
    where = "; ".join(f"{date}, commit {commit}, {processor}" for date, commit, processor in sorted(made))
    words = [f"{sum(one['equal'] for one in run)} of {len(run)} results were equal to the last digit ({where})."]
    others = [
        f"{one['claim']} ({one['n_differences']} numbers, verdict {one['verdict']})"
        for one in run if not one["equal"]
    ]  # fmt: skip
    words += [f"Others differ: {', '.join(others)}."] if others else []
    commit_of = {one["claim"]: one["of"] for one in verified}
    since = [r["claim"] for r in found if commit_of.get(r["claim"], "") != r.get("made", {}).get("commit")]
    words += [f"Made since then, and not run again: {', '.join(since)}."] if since else []
    return " ".join(words)


def minutes(results: Sequence[Mapping]) -> float:
    """Processor minutes of results, cells that claims share counted once."""
    once = {}
    for result in results:
        claim = claim_of(result["claim"])
        where = claim.id if claim.shared is None else claim.run_cell.__module__
        once[where] = max(result["seconds"], once.get(where, 0.0))
    return sum(once.values()) / 60


def simulates_physics(claim_id: str) -> bool:
    """Whether a claim's run rests on the physics simulator."""
    return SIMULATOR in foreign_modules(claim_of(claim_id).run_cell.__module__)
