"""Prints results of claims: the verdict, the conditions that decide, and where the figure is."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from reproduction.engine.claim import Claim
from reproduction.engine.claim_section import verdict_now
from reproduction.engine.condition_table import counted_rows, measured_in_words, measured_now
from reproduction.engine.registry import claim_of
from reproduction.engine.reproduce import result_folder
from reproduction.engine.second_reading import YES


def print_claims(results: Sequence[Mapping], out: str) -> None:
    """Print each result with its counted conditions, those not met first; `out` is the folder of the results."""
    console = Console()
    for result in results:
        claim = claim_of(result["claim"])
        heading = Text.assemble(
            f"{claim.id} {claim.title}: ", (verdict_now(result), "bold"), f" ({_beside(result)})"
        )
        console.print(heading, _conditions(claim, result), highlight=False)
        figure = result_folder(Path(out) / claim.id, result["mode"]) / "figure.png"
        console.print(f"{figure}\n", soft_wrap=True, highlight=False)


def _beside(result: Mapping) -> str:
    """What else is known of the verdict: the first reading's, and whether the run was a small one."""
    first = f"first reading: {result['verdict']}" if result.get("second") else "first reading"
    return first + ("; a quick run, no evidence" if result["mode"] == "quick" else "")


def _conditions(claim: Claim, result: Mapping) -> Table:
    measured, lines = measured_now(result), Table.grid(padding=(0, 2))
    for row in sorted(counted_rows(claim, result), key=lambda row: row.answer == YES):
        number = measured_in_words(row.condition, measured)
        lines.add_row(
            Text(f"  {row.answer}", "bold" if row.answer != YES else ""),
            Text(f"{claim.words_of(row.condition)}\nasked {row.asked}; measured {number}"),
        )
    return lines
