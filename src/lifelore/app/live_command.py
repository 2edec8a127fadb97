"""`lifelore live`: live through a stream of tasks in one world."""

import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lifelore.app.options import AsJson, MapFile, Where

if TYPE_CHECKING:
    from lifelore.agent.live.goals.job_list import Job
    from lifelore.agent.live.life import Life
    from lifelore.agent.live.life_settings import LifeSettings, Place
    from lifelore.agent.live.output.l2_log import LifeLog
    from lifelore.app.setting_keys import SettingKeys

Option = typer.Option

OPTIONS = ("domain", "map", "tasks", "goal", "goals", "agent", "robot", "memory", "out", "log", "csv", "seed")
"""Options of `live` that are settings too."""


def live(
    context: typer.Context,
    domain: Annotated[
        str,
        Option(
            help="World: building, or the thesis's worlds lattice, noise and advice; or jobs with hidden types: "
            "tabletop, factory-customers, building-days."
        ),
    ] = "building",
    map: MapFile = None,
    tasks: Annotated[int | None, Option(help="Tasks to live through now [30; hidden types: 20].")] = None,
    goal: Annotated[
        str | None,
        Option(
            metavar="X,Y|NAME|ROW,COL",
            help="Goal of every task; in a building, the robot drives there. Default: each task hides one.",
        ),
    ] = None,
    goals: Annotated[
        str | None,
        Option(metavar="CSV", help="building: job list with time (optional), name, x, y; the robot drives there."),
    ] = None,
    agent: Annotated[
        str | None,
        Option(
            help="lore, model, prior, scratch, undirected, rmax, frontier, or all [lore]; hidden types: full, "
            "no-perception, no-prior, no-reuse or scratch [full]."
        ),
    ] = None,
    robot: Annotated[
        str, Option(help="Name of the robot in memory; processes of one name take different tasks.")
    ] = "robot",
    memory: Where = None,
    out: Annotated[
        str | None, Option(metavar="DIR", help="Folder for summary.json, pictures and exports.")
    ] = None,
    log: Annotated[
        str | None,
        Option(
            metavar="FILE|DIR",
            help="building: NAME.mcap or .rrd for map, ways, costs, events; extra ros or view. Folder: episodes, "
            "for L2Logger.",
        ),
    ] = None,
    csv: Annotated[
        str | None, Option(metavar="FILE", help="CSV in long format: run, task, agent, episode, measure, value.")
    ] = None,
    seed: Annotated[
        int, Option(help="Draws world, tasks and choices; robots of one seed meet the same tasks.")
    ] = 0,
    changes: Annotated[
        list[str] | None, Option("--set", metavar="KEY=VALUE", help="Change another setting; repeat it for more.")
    ] = None,
    settings: Annotated[
        bool, Option("--settings", help="List what --set takes in this domain, and live no life.")
    ] = False,
    as_json: AsJson = False,
) -> int:
    """Live through tasks in one world and learn from each.

    Known goals (--goal, --goals) are driven to, hidden ones are searched for. Memory stores what was learnt; the
    next run continues the life.
    """
    from lifelore.agent.long_lived.families.by_name import FAMILIES
    from lifelore.core.errors import NotFoundError
    from lifelore.domains.worlds import domain_names

    if domain not in (known := (*domain_names(), *FAMILIES)):
        raise NotFoundError(f"domain must be one of {', '.join(known)}, got {domain!r}")
    keys = setting_keys(domain)
    if settings:
        keys.show(as_json)
        return 0
    given = {name: value for name in OPTIONS if (value := context.params[name]) is not None}
    values = given | keys.read(changes or ())
    if domain in FAMILIES:
        from lifelore.app.long_life_command import live_long_life

        return live_long_life(keys, values, as_json)
    return _live_life(keys, values, as_json)


def setting_keys(domain: str) -> "SettingKeys":
    """The settings of a life in this domain, by key."""
    from lifelore.agent.live.life_settings import LIFE_KEYS, LifeSettings
    from lifelore.agent.long_lived.families.by_name import FAMILIES
    from lifelore.agent.long_lived.long_life import live_long
    from lifelore.app.setting_keys import SettingKeys

    life = SettingKeys(LifeSettings, LIFE_KEYS)
    long_life = SettingKeys(live_long, {"location": "memory", "family": "domain"})
    if domain in FAMILIES:
        own, other, where = long_life, life, f"does not apply to domain {domain}; leave it out"
    else:
        hidden = f"jobs with hidden types alone ({', '.join(FAMILIES)})"
        own, other, where = life, long_life, f"applies to {hidden}, not to {domain}; leave it out"
    foreign = {key: where for key in other.settings if key not in own.settings}
    return replace(own, elsewhere=foreign | {key: f"is an option: --{key}" for key in OPTIONS})


def _live_life(keys: "SettingKeys", values: dict[str, Any], as_json: bool) -> int:
    """Live in a world with the settings of `values`, by key."""
    from contextlib import nullcontext

    from lifelore.agent.live.life import live as live_through
    from lifelore.agent.live.life_settings import LifeSettings
    from lifelore.agent.live.output.long_table import LongTable
    from lifelore.agent.live.output.report import check_folder, write_portfolio
    from lifelore.app.console import INTERRUPTED, print_json, progress_bar, stop_on_interrupt
    from lifelore.app.life_table import print_life

    domain, out, csv = values["domain"], values.get("out"), values.get("csv")
    places = {name: _place(name, values[name], domain) for name in ("start", "goal") if name in values}
    jobs = {"goals": _jobs(values["goals"], values.get("tasks"))} if "goals" in values else {}
    settings = LifeSettings(**keys.arguments(values | places | jobs))
    new_folder = out is not None and not os.path.exists(out)  # also a name too long for a file
    if out is not None:
        check_folder(out)
    log = _opened_log(values["log"], settings) if "log" in values else None
    with (
        LongTable(csv, values["seed"]) if csv is not None else nullcontext() as table,
        stop_on_interrupt() as stop,
        progress_bar("living") as progress,
    ):

        def show(done: int, total: int, label: str) -> None:
            # Before the first task, when no setting can be refused any more: a mistyped path is seen at once.
            if new_folder and done == 0:
                _notify(f"new folder {out}")
            progress(done, total, label)

        def record(task: dict, results: dict) -> None:
            for one in (table, log):
                if one:
                    one.add_results(task, results)

        life = live_through(settings, progress=show, stop=stop, watch=record, notify=_notify)
        written = write_portfolio(life, out) if out is not None else []
        if "log" in values and log is None:
            written.append(_write_log(life, values["log"]))
    if as_json:
        print_json(life.report)
    else:
        print_life(life.report, written)
    return INTERRUPTED if life.stopped else 0


def _opened_log(path: str, settings: "LifeSettings") -> "LifeLog | None":
    """The log of a folder, which grows with the life; None for a file, which is written at its end."""
    from lifelore.agent.live.output.l2_log import LifeLog
    from lifelore.bridges.viewer_log import check_log
    from lifelore.core.errors import InputError

    if Path(path).suffix:
        if settings.world.domain != "building":
            raise InputError(
                f"log as a file applies to domain building, got {settings.world.domain}; give a folder, named "
                "without a dot, for episodes, or leave it out"
            )
        return check_log(path)
    if settings.driven:
        raise InputError(f"log as a folder holds episodes of searches, got {path} with known goals; leave it out")
    return LifeLog(path, settings.world.domain)


def _write_log(life: "Life", path: str) -> str:
    from lifelore.agent.live.output.logged_life import logged_life
    from lifelore.bridges.viewer_log import write_life_log
    from lifelore.core.atomic_write import refused_writes

    with refused_writes(path, "log"):
        write_life_log(path, logged_life(life))
    return path


def _notify(line: str) -> None:
    print(line, file=sys.stderr)


def _place(argument: str, text: str, domain: str) -> "Place | None":
    """A point in metres or a name in buildings, else a cell (row, column)."""
    from lifelore.agent.live.goals.destinations import destination_from_text
    from lifelore.core.errors import InputError

    if domain == "building":
        place = destination_from_text(argument, text)
        return place.point or place.name
    try:
        row, column = (int(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"{argument} must be ROW,COL, two whole numbers, got '{text}'") from None
    return row, column


def _jobs(path: str, tasks: int | None) -> "tuple[Job, ...]":
    from lifelore.agent.live.goals.job_list import read_jobs
    from lifelore.core.errors import InputError

    if tasks is not None:
        raise InputError(f"tasks does not apply with goals, whose jobs are the tasks, got {tasks}; leave it out")
    return read_jobs(path)
