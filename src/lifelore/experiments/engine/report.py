"""The page of reproductions: every result under `results/`, rendered into ``docs/reproduction.md``.

Run ``python -m lifelore.experiments.engine.report`` after a full run; a test fails where page and results differ.
"""

import json
from collections.abc import Mapping
from pathlib import Path

from lifelore.core.errors import InputError, StoreError
from lifelore.experiments.engine.cell_store import write_atomically
from lifelore.experiments.engine.ledger import entries
from lifelore.experiments.engine.predicate import VERDICTS, number_in_words, short
from lifelore.experiments.engine.registry import claim_of

HEAD = """# Reproduction

What the thesis reports, what we measure, and whether it holds. This page is generated from `results/` by
`python -m lifelore.experiments.engine.report`; do not edit it by hand. Each verdict is decided by conditions
filed as data under `src/lifelore/experiments/engine/predicates/` before the first full run. Intervals are 95 %;
ratios and differences are paired.
"""


def render_report(results: str | Path = "results", figures: str = "../results") -> str:
    """The page as Markdown.

    Parameters
    ----------
    results : path
        Folder of ``<ID>/result.json``.
    figures : str
        The same folder as the page's links see it.
    """
    found = read_results(results)
    return "\n".join([HEAD, _overview(found), *(_section(result, figures) for result in found)])


def write_report(results: str | Path = "results", page: str | Path = "docs/reproduction.md") -> Path:
    """Render the page and write it; returns its path."""
    page = Path(page)
    write_atomically(page, render_report(results))
    return page


def read_results(results: str | Path) -> list[dict]:
    """All results of a folder, in the ledger's order."""
    found = []
    for entry in entries():
        path = Path(results) / entry.id / "result.json"
        if path.exists():
            try:
                found.append(json.loads(path.read_text(encoding="utf-8")))
            except OSError as error:
                raise StoreError(f"cannot read {path}: {error.strerror}") from None
            except ValueError:
                raise InputError(f"{path} is not JSON; run `lifelore reproduce {entry.id} --full` again") from None
    return found


def _overview(found: list[dict]) -> str:
    lines = ["| claim | of | verdict | mode |", "|---|---|---|---|"]
    where = {entry.id: entry.where for entry in entries()}
    for result in found:
        link = f"[{result['claim']}](#{_anchor(result['claim'])})"
        lines.append(f"| {link} | {where[result['claim']]} | **{result['verdict']}** | {result['mode']} |")
    counts = [f"{sum(r['verdict'] == v for r in found)} {v}" for v in VERDICTS]
    left = len(entries()) - len(found)
    lines += ["", f"{', '.join(counts)}; {left} of {len(entries())} claims have no result yet.", ""]
    return "\n".join(lines)


def _anchor(claim_id: str) -> str:
    return claim_id.lower().replace(".", "-")


def _section(result: Mapping, figures: str) -> str:
    claim_id = result["claim"]
    lines = [
        f'<a id="{_anchor(claim_id)}"></a>',
        "",
        f"## {claim_id} — {claim_of(claim_id).title}",
        "",
        f"**Thesis.** {result['thesis']}",
        "",
        f"**Verdict: {result['verdict']}.** {result['why']}",
        "",
        f"![{claim_of(claim_id).title}]({figures}/{claim_id}/figure.png)",
        "",
        "| ours | value | median | n |",
        "|---|---|---|---|",
        *(_measured_row(name, number) for name, number in result["measured"].items()),
        "",
        f"Mode {result['mode']}, seed {result['seed']}, {short(result['seconds'])} s of computing. "
        f"Settings: {_settings_in_words(result['settings'])}.",
        "",
    ]
    return "\n".join(lines)


def _measured_row(name: str, number: Mapping) -> str:
    value = number_in_words(number).rpartition(", n ")[0]
    median = "–" if number["median"] is None else short(number["median"])
    return f"| `{name}` | {value} | {median} | {number['n']} |"


def _settings_in_words(settings: Mapping) -> str:
    return ", ".join(f"`{key}` {json.dumps(value, ensure_ascii=False)}" for key, value in settings.items())


if __name__ == "__main__":
    print(write_report())
