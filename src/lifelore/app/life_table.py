"""Prints the summary of a life as a table."""

import sys

from rich.console import Console
from rich.table import Table

SHOWN = (
    ("steps_to_80", "steps to 80 %"),
    ("episodes_to_80", "episodes"),
    ("collisions", "collisions"),
    ("first_return", "first return"),
)

SHOWN_DRIVEN = (("seconds", "seconds"), ("metres", "metres"), ("refusals", "refusals"), ("replans", "new routes"))

LISTED = 20
"""Maximum number of driven jobs that are listed, the last ones."""


def print_life(report: dict, written: list[str]) -> None:
    """Print means of each agent over the first and last third of the tasks, then the ratios to scratch."""
    # A pipe or file has no width, and four intervals in a row need a hundred columns.
    width = None if sys.stdout.isatty() else 110
    console = Console(width=width)
    tasks, memory = report["tasks"], report["memory"]
    place = report["map"] or report["domain"]
    noun, verb = ("job", "driven") if report["how"] == "driven" else ("goal", "searched")
    console.print(
        f"{len(tasks)} {noun}{'s' * (len(tasks) != 1)} {verb} in {place}, {report['n_states']:,} places, "
        f"{report['seconds']:.1f} s; "
        f"this robot has finished {memory['tasks_after']} tasks in all"
    )
    if report["building"]:
        console.print(_building_line(report["building"]))
    if tasks and report["how"] == "driven":
        _print_driven(console, report)
    elif tasks:
        console.print(_thirds(report["summary"]["agents"], SHOWN), soft_wrap=False)
        for name, ratios in report["summary"].items():
            if name != "agents":
                console.print(_ratio_line(name, ratios))
    for path in written:
        console.print(f"wrote {path}")


def _print_driven(console: Console, report: dict) -> None:
    """The last jobs, then means of each agent, and memory compared with the map alone."""
    if not report["settings"]["busy"]:
        console.print("in simulation, nothing slows or blocks the robot; --set busy=true changes that")
    for task in report["tasks"][-LISTED:]:
        console.print(_job_line(task))
    console.print(_thirds(report["summary"]["agents"], SHOWN_DRIVEN), soft_wrap=False)
    compared = report["summary"].get("lore_vs_map_only", {}).get("all")
    if compared:
        own, other = compared["seconds"].values()
        refused, others = compared["refusals"].values()
        console.print(
            f"all jobs: {own:,.0f} s with memory, {other:,.0f} s on the map alone "
            f"({_ratio(compared['seconds_ratio'])}); refusals {refused:,} and {others:,}"
        )


def _job_line(task: dict) -> str:
    """A job with the drive of the agent that remembers, and the seconds of the one that does not."""
    first, *rest = task["agents"].values()
    x, y = task["position"]
    where = " ".join(part for part in (task["clock"], task.get("name"), f"{x:g},{y:g}") if part)
    drive = f"driven {first['metres']:.1f} m in {first['seconds']:.0f} s"
    if not first["reached"]:
        drive = f"no way left after {first['metres']:.1f} m and {first['seconds']:.0f} s"
    parts = [drive]
    for count, noun in ((first["refusals"], "refusal"), (first["replans"], "new route")):
        if count:
            parts.append(f"{count} {noun}" + "s" * (count > 1))
    parts += [f"map alone {other['seconds']:.0f} s" for other in rest]
    return f"job {task['index']}: {where}: " + ", ".join(parts)


def _building_line(building: dict) -> str:
    """Whether the map was recognised, and on which grounds."""
    if not building["recognised"]:
        return f"a new building: {building['name']} ({building['reason']})"
    grounds = []
    if building["agreement"] is not None:
        grounds.append(f"{int(100 * building['agreement'])} % of places agree")
    if building["walls"] is not None:
        grounds.append(f"{int(100 * building['walls'])} % of walls")
    return f"recognised as {building['name']}" + "".join(f", {ground}" for ground in grounds)


def _thirds(agents: dict, shown: tuple[tuple[str, str], ...]) -> Table:
    table = Table("agent", "third", title="means and 95 % intervals over the first and last third")
    for _, title in shown:
        table.add_column(title, justify="right")
    for name, thirds in agents.items():
        for which in ("first", "last"):
            cells = [_number(thirds[which][measure]) for measure, _ in shown]
            table.add_row(name if which == "first" else "", which, *cells, end_section=which == "last")
    return table


def _number(estimate: dict) -> str:
    text = _short(estimate["value"])
    if estimate["ci95"]:
        low, high = estimate["ci95"]
        text += f" [{_short(low)}, {_short(high)}]"
    return text


def _short(x: float) -> str:
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if abs(x) >= size:
            return f"{x / size:,.1f}{letter}"
    if 0.05 <= abs(x) < 9.95 and not float(x).is_integer():
        return f"{x:.1f}"
    return f"{round(x) or 0:,}"  # no "-0"


def _ratio_line(name: str, ratios: dict) -> str:
    steps, hits = ratios["steps_to_80_ratio"], ratios["collisions_ratio"]
    who = name.removesuffix("_vs_scratch")
    return (
        f"{who} compared with scratch, last third: steps to 80 % {_ratio(steps)}, collisions {_ratio(hits)}, "
        f"first return {round(ratios['jumpstart']['value']) or 0:+,}"
    )


def _ratio(estimate: dict) -> str:
    if estimate["value"] is None:
        return "–"
    interval = estimate["ci95"]
    between = f" [{interval[0]:.3f}, {interval[1]:.3f}]" if interval else ""
    return f"×{estimate['value']:.3f}{between}"
