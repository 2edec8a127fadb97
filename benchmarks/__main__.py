"""`lifelore bench`: run benchmarks against other methods in one process."""

from typing import Annotated

import typer


def bench(
    name: Annotated[
        str,
        typer.Argument(
            help="Speed: kernels, start, buildings, capacity, large_memory, merge, priors, factory, separator, "
            "perceive, reuse, long_user, serve, soak, log. Benefit: fleet, customer_fleet, courier, recognition, "
            "lidar, destinations, tabletop_lives, worlds, contexts, raw_frames, segmentation, relations, plans, "
            "puzzles, views, registration, pictures, lived_relations, deep, deep_layouts, novelty, "
            "changing_types, bands, perfect_information, advice_classes, long_lived_worlds, changing_customers. "
            "Statistics: evaluation."
        ),
    ],
    repeats: Annotated[int, typer.Option(help="Interleaved rounds; the medians are reported.")] = 7,
    map: Annotated[
        str | None,
        typer.Option(
            metavar="YAML",
            help="courier, recognition, lidar, long_lived_worlds: a ROS map; default: generated offices.",
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Measure speed and benefit beside other methods.

    The methods take turns in one process, and ratios compare paired rounds. Use it to check a claim about speed or
    benefit on your machine.
    """
    from benchmarks import bench as run
    from lifelore.app.console import print_json, progress_bar

    with progress_bar("measuring") as progress:
        result = run(name, repeats=repeats, map=map, progress=progress)
    print_json(result) if as_json else _print(result)


def _print(result: dict) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    rows = Table("measure", "value", "unit", "ratio", "to", title=f"bench {result['bench']}")
    for row in result["rows"]:
        rows.add_row(row["name"], _number(row["value"]), row["unit"], _number(row["ratio"]), row["ratio_to"] or "")
    goals = Table("condition", "goal", "measured", "met")
    for goal in result["goals"]:
        met = "–" if goal["met"] is None else "yes" if goal["met"] else "no"
        goals.add_row(goal["name"], str(goal["goal"]), _number(goal["measured"]), met)
    console.print(rows)
    console.print(goals)
    for note in result.get("notes", ()):
        console.print(note)


def _number(value) -> str:
    return "–" if value is None else f"{value:,.3g}" if isinstance(value, float) else str(value)
