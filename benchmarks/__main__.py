"""``python -m benchmarks``: list the benchmarks, or run one; ``make bench NAME=kernels`` does the same."""

import argparse
import json
import sys
from pathlib import Path
from typing import NoReturn

from benchmarks import BENCHES, bench
from lifelore.app.console import print_json, progress_bar
from lifelore.core.errors import LifeloreError

STORED = Path(__file__).with_name("results")


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """End with status 2 and one line."""
        self.exit(2, f"benchmarks: {message}\n")


def main(arguments: list[str] | None = None) -> int:
    """Status of the process: 0, or 2 after a mistake that one line on stderr names."""
    parser = _Parser(prog="python -m benchmarks", description="Measure speed beside other programs.")
    parser.add_argument("name", nargs="?", help="the benchmark; without it, all are listed")
    parser.add_argument("--repeats", type=int, default=7, help="interleaved rounds; medians are reported")
    parser.add_argument("--json", action="store_true", help="one JSON document on stdout and nothing else")
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", nargs="?", const=STORED,
        help="also write FOLDER/NAME.json; default benchmarks/results",
    )  # fmt: skip
    asked = parser.parse_args(arguments)
    if asked.name is None:
        print("\n".join(f"{name:10} {what}" for name, what in BENCHES.items()))
        return 0
    try:
        with progress_bar("measuring") as progress:
            result = bench(asked.name, repeats=asked.repeats, progress=progress)
    except LifeloreError as error:
        print(f"benchmarks: {error}", file=sys.stderr)
        return 2
    if asked.out:
        asked.out.mkdir(parents=True, exist_ok=True)
        (asked.out / f"{asked.name}.json").write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    print_json(result) if asked.json else _print(result)
    return 0


def _print(result: dict) -> None:
    from rich.console import Console
    from rich.table import Table

    rows = Table("measure", "value", "unit", "ratio", "to", title=result["bench"])
    for row in result["rows"]:
        rows.add_row(row["name"], _number(row["value"]), row["unit"], _number(row["ratio"]), row["ratio_to"] or "")
    goals = Table("condition", "goal", "measured", "met")
    for goal in result["goals"]:
        met = "–" if goal["met"] is None else "yes" if goal["met"] else "no"
        goals.add_row(goal["name"], str(goal["goal"]), _number(goal["measured"]), met)
    Console().print(rows, goals)


def _number(value) -> str:
    return "–" if value is None else f"{value:,.3g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    sys.exit(main())
