"""`lifelore live` in domains of jobs with hidden types, and `lifelore explain`."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from lifelore.app.options import AsJson, Robot, Where

if TYPE_CHECKING:
    from lifelore.app.setting_keys import SettingKeys

Option = typer.Option

FOREIGN = ("map", "goal", "goals", "out", "log", "csv")
"""Options of `lifelore live` that do not apply to these domains."""


def live_long_life(keys: "SettingKeys", values: dict[str, Any], as_json: bool) -> int:
    """Live through jobs with hidden types, with the settings of `values`, by key."""
    from lifelore.agent.long_lived.families.by_name import family_named
    from lifelore.agent.long_lived.long_life import live_long
    from lifelore.app.console import INTERRUPTED, print_json, progress_bar, stop_on_interrupt
    from lifelore.core.errors import InputError
    from lifelore.memory.location import default_path

    if foreign := [f"--{name}" for name in FOREIGN if name in values]:
        names = ", ".join(foreign)
        pictures = (
            "; --json prints all numbers, and lifelore serve draws the life at /life" if "out" in values else ""
        )
        raise InputError(f"{names} does not apply to domain {values['domain']}; leave it out{pictures}")
    memory = values.get("memory")
    family = family_named(values["domain"], values["seed"])
    stored = {"memory": default_path() if memory is None else memory}
    arguments: dict[str, Any] = keys.arguments(values | stored) | {"family": family}
    with stop_on_interrupt() as stop, progress_bar("living") as progress:
        report = live_long(**arguments, progress=progress, stop=stop)
    if as_json:
        print_json(report)
    else:
        _print_report(report, values["robot"])
    return INTERRUPTED if stop.is_set() else 0


def _print_report(report: dict[str, Any], robot: str) -> None:
    """Print a line a task, the share of the best possible return, and how to ask for more."""
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    table = Table("task", "context", "first return", "last return", "best possible", "learnt by", "")
    for task in report["tasks"]:
        new = ", ".join(["spare time"] * task["spare"] + ["a new type"] * task["new_type"])
        returns = (f"{value:.2f}" for value in (task["returns"][0], task["returns"][-1], task["best_return"]))
        table.add_row(str(task["task"]), str(task["context"]), *returns, task["learnt"], new)
    console.print(table)
    for half, found in report["summary"].items():
        console.print(
            f"{half}: {found['first_episode_below_best']:.2f} points below the best possible return in first "
            f"episodes, {found['last_episode_below_best']:.2f} in last ones; {found['new_types']} new types"
        )
    if report["tasks"] and report["agent"] == "full":
        console.print(f"lifelore explain {report['tasks'][-1]['task']} --robot {robot} says why it acted so")


def explain(
    task: Annotated[int, typer.Argument(help="Number of the task.")],
    robot: Robot = "robot",
    memory: Where = None,
    as_json: AsJson = False,
) -> None:
    """Say why the agent acted as it did in a task.

    The words are those of the agent: the scene, its belief, the return that it expected, and what it noticed.
    """
    from lifelore.agent.any_tasks.task_result import explained_task
    from lifelore.agent.long_lived.explanation import explained
    from lifelore.agent.long_lived.long_life import stored_task
    from lifelore.app.console import print_json

    document = stored_task(task, robot, memory)
    if as_json:
        print_json(document)
    elif "policies" in document:
        print(explained_task(document))
    else:
        print("\n".join(explained(document)))
