"""`lifelore bench`: speed as ratios, measured side by side in one run."""

from typing import Annotated

import typer


def bench(
    name: Annotated[
        str,
        typer.Argument(
            help="Speed: kernels, start, buildings, capacity, merge, priors, factory, separator, perceive, reuse. "
            "Worth: courier, relations, pictures, deep."
        ),
    ],
    repeats: Annotated[int, typer.Option(help="Interleaved rounds; medians are reported.")] = 7,
    map: Annotated[str | None, typer.Option(metavar="YAML", help="courier: a ROS map; else offices.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Measure beside peers, in one process; ratios are of pairs."""
    from lifelore.app.console import print_json, progress_bar
    from lifelore.experiments.bench import bench as run

    with progress_bar("measuring") as progress:
        result = run(name, repeats=repeats, map=map, progress=progress)
    print_json(result) if as_json else _print(result)


def _print(result: dict) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    rows = Table("what", "value", "unit", "ratio", "to", title=f"bench {result['bench']}")
    for row in result["rows"]:
        rows.add_row(row["name"], _number(row["value"]), row["unit"], _number(row["ratio"]), row["ratio_to"] or "")
    goals = Table("goal", "asked", "measured", "met")
    for goal in result["goals"]:
        met = "–" if goal["met"] is None else "yes" if goal["met"] else "no"
        goals.add_row(goal["name"], str(goal["goal"]), _number(goal["measured"]), met)
    console.print(rows)
    console.print(goals)


def _number(value) -> str:
    return "–" if value is None else f"{value:,.3g}" if isinstance(value, float) else str(value)
