"""`lifelore live`: live through a stream of tasks in one world."""

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from lifelore.agent.live.goals.job_list import Job
    from lifelore.agent.live.life_settings import Place

Option = typer.Option


def live(
    context: typer.Context,
    domain: Annotated[
        str,
        Option(
            help="World: building, or the thesis's worlds lattice, noise and advice; or jobs with hidden types: "
            "tabletop, factory-customers, building-days."
        ),
    ] = "building",
    map: Annotated[
        str | None, Option(metavar="YAML", help="ROS map of the building; default: a generated office.")
    ] = None,
    watch: Annotated[
        str | None,
        Option(metavar="YAML", help="Like --map; between tasks, read the map again if its files have changed."),
    ] = None,
    tasks: Annotated[int | None, Option(help="Tasks to live through now [30; with --goals: its jobs].")] = None,
    cell: Annotated[float | None, Option(help="Side of a grid cell in metres [building: 0.5].")] = None,
    robot_radius: Annotated[float | None, Option(help="Radius of the robot in metres [building: 0.2].")] = None,
    destinations: Annotated[
        int,
        Option(
            help="Number of recurring places that goals are drawn from, and where goals were found is remembered; "
            "0: every place."
        ),
    ] = 0,
    learner: Annotated[
        str, Option(help="model (plans on a learnt model of the moves) or q (the thesis's Q-learning).")
    ] = "model",
    sensor: Annotated[
        str,
        Option(
            help="touch (a move is known once made, the goal once entered) or lidar (building: all places in line "
            "of sight within --range are seen; the goal is found at sight, then the robot drives there)."
        ),
    ] = "touch",
    range: Annotated[float | None, Option(help="Range of the lidar in metres [5].")] = None,
    prior: Annotated[
        str, Option(help="Action prior conditioned on the observation or the state, or none.")
    ] = "observation",
    agent: Annotated[
        str | None,
        Option(
            help="Agent: lore, model, prior, scratch, undirected, rmax, frontier, or all [lore]; jobs with hidden "
            "types: full, no-perception, no-prior, no-reuse or scratch [full]."
        ),
    ] = None,
    compare: Annotated[
        bool | None,
        Option(
            "--compare/--alone", help="Live scratch beside the agent [up to 100,000 places], or the agent alone."
        ),
    ] = None,
    robot: Annotated[
        str, Option(help="Name of the robot in memory; processes of one name take different tasks.")
    ] = "robot",
    refresh: Annotated[
        bool, Option("--refresh", help="Before each task, recall what other robots and processes have stored.")
    ] = False,
    building: Annotated[
        str | None,
        Option(metavar="NAME", help="Name of the building; default: recognise it, or name it after its map."),
    ] = None,
    start: Annotated[
        str | None,
        Option(
            metavar="X,Y|NAME|ROW,COL",
            help="Place in which every episode starts; default: any. building: X,Y in metres of the map's frame, "
            "or a name in memory; other domains: ROW,COL.",
        ),
    ] = None,
    goal: Annotated[
        str | None,
        Option(
            metavar="X,Y|NAME|ROW,COL",
            help="Goal of every task; default: drawn for each task. Written as for --start.",
        ),
    ] = None,
    goals: Annotated[
        str | None,
        Option(
            metavar="CSV",
            help="building: job list with columns time (optional), name, x, y in metres; one task a job.",
        ),
    ] = None,
    again: Annotated[
        bool, Option("--again", help="Start an interrupted job list with its first job, not its first unfinished.")
    ] = False,
    memory: Annotated[
        str | None, Option(metavar="FILE|URL", help="Memory: SQLite file or postgresql:// URL; default: your own.")
    ] = None,
    labels: Annotated[
        bool, Option("--labels", help="tabletop: the points of the pictures carry the objects' labels.")
    ] = False,
    spare: Annotated[
        int,
        Option(help="Jobs with hidden types: further tasks, in contexts that the agent is curious about."),
    ] = 0,
    change: Annotated[
        float,
        Option(
            help="factory-customers: probability that another customer comes between two episodes of a task; the "
            "agent knows it and follows."
        ),
    ] = 0.0,
    episodes: Annotated[
        int | None,
        Option(
            help="Maximum episodes of a task [model: 100 or more, q: 1000]; of jobs with hidden types all [8]."
        ),
    ] = None,
    max_steps: Annotated[
        int | None, Option(help="Maximum steps of an episode [building: 2000, else 1000].")
    ] = None,
    out: Annotated[
        str | None, Option(metavar="DIR", help="Folder for summary.json, pictures and exports.")
    ] = None,
    l2log: Annotated[
        str | None, Option(metavar="DIR", help="Folder for a log of every episode in L2Logger's format.")
    ] = None,
    csv: Annotated[
        str | None,
        Option(metavar="FILE", help="CSV in long format: run, task, agent, episode, measure, value."),
    ] = None,
    seed: Annotated[
        int,
        Option(
            help="Draws the world, the tasks and the agents' choices. Robots of one seed meet the same tasks, "
            "whatever their names."
        ),
    ] = 0,
    jobs: Annotated[int, Option(help="Threads; results do not depend on their number.")] = 2,
    density: Annotated[float | None, Option(help="noise: share of obstacles, in (0, 1).")] = None,
    discount: Annotated[float | None, Option(help="Discount γ [building: 0.99, else 0.95].")] = None,
    goal_reward: Annotated[float | None, Option(help="Reward at the goal [100].")] = None,
    wall_reward: Annotated[float | None, Option(help="Reward of a move into a wall [-10].")] = None,
    alpha0: Annotated[float, Option(help="Pseudo-count α⁰ of the prior.")] = 0.1,
    weight: Annotated[float, Option(help="Weight w(π) of each finished task in the prior.")] = 1.0,
    form: Annotated[str, Option(help="q: proportion, dirichlet, softmax, support or tempered.")] = "proportion",
    ties: Annotated[str, Option(help="q: how the greedy step breaks ties, uniform or prior.")] = "uniform",
    learning_rate: Annotated[float, Option(help="q: learning rate α.")] = 0.5,
    epsilon: Annotated[float, Option(help="q: exploration rate ε of the first episode.")] = 1.0,
    epsilon_decay: Annotated[float, Option(help="q: factor of ε after each episode.")] = 0.98,
    epsilon_floor: Annotated[float, Option(help="q: least ε.")] = 0.01,
    serve: Annotated[
        bool, Option("--serve", help="Serve the pages while the life runs; /life draws it as it goes (extra web).")
    ] = False,
    port: Annotated[int | None, Option(help="Port of --serve; 0: any free port [8321].")] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> int:
    """Live through tasks in one world and learn from each.

    Use it to see what an agent gains from its earlier tasks, in your own map or in a generated office. Memory
    stores what the agent learnt after each task: the next run continues the life, in this building or in another
    one.
    """
    from lifelore.agent.long_lived.families.by_name import CHANGING, FAMILIES
    from lifelore.core.errors import InputError

    if domain in FAMILIES:
        from lifelore.app.long_life_command import live_long_life

        return live_long_life(context)
    if change:
        raise InputError(f"--change applies to {', '.join(CHANGING)} alone, not to {domain}; leave it out")
    if labels or spare:
        name = "--labels" if labels else "--spare"
        raise InputError(
            f"{name} applies to jobs with hidden types alone ({', '.join(FAMILIES)}), not to {domain}"
        )
    from contextlib import nullcontext

    from lifelore.agent.live.life import live as live_through
    from lifelore.agent.live.life_settings import (
        LearningSettings,
        LifeSettings,
        MemorySettings,
        PriorSettings,
        SensorSettings,
    )
    from lifelore.agent.live.output.l2_log import LifeLog
    from lifelore.agent.live.output.long_table import LongTable
    from lifelore.agent.live.output.report import check_folder, write_portfolio
    from lifelore.app.console import INTERRUPTED, print_json, progress_bar, stop_on_interrupt
    from lifelore.app.life_table import print_life
    from lifelore.app.pages_beside import pages_beside
    from lifelore.domains.worlds import WorldSettings

    settings = LifeSettings(
        world=WorldSettings(
            domain,
            _map(map, watch),
            cell=cell,
            robot_radius=robot_radius,
            discount=discount,
            goal_reward=goal_reward,
            wall_reward=wall_reward,
            seed=seed,
            density=density,
        ),
        learning=LearningSettings(
            learner, episodes, max_steps, learning_rate, epsilon, epsilon_decay, epsilon_floor
        ),
        prior=PriorSettings(prior, alpha0, weight, form, ties),
        memory=MemorySettings(memory, robot, building, refresh),
        sensor=SensorSettings(sensor, range),
        agent=agent or "lore",
        compare=compare,
        tasks=30 if tasks is None else tasks,
        destinations=destinations,
        start=_place("start", start, domain),
        jobs=jobs,
        goal=_place("goal", goal, domain),
        goals=() if goals is None else _jobs(goals, tasks),
        watch=watch is not None,
        again=again,
    )
    new_folders = _missing_folders(memory, out)
    if out is not None:
        check_folder(out)
    log = None if l2log is None else LifeLog(l2log, domain)
    with (
        pages_beside(serve, port, memory),
        LongTable(csv, seed) if csv is not None else nullcontext() as table,
        stop_on_interrupt() as stop,
        progress_bar("living") as progress,
    ):

        def show(done: int, total: int, label: str) -> None:
            # Before the first task, when no setting can be refused any more: a mistyped path is seen at once.
            for folder in new_folders if done == 0 else ():
                _notify(f"new folder {folder}")
            progress(done, total, label)

        def record(task: dict, results: dict) -> None:
            if log:
                log.add(task, results)
            if table:
                table.add_results(task, results)

        life = live_through(settings, progress=show, stop=stop, watch=record, notify=_notify)
        written = write_portfolio(life, out) if out is not None else []
    if as_json:
        print_json(life.report)
    else:
        print_life(life.report, written)
    return INTERRUPTED if life.stopped else 0


def _missing_folders(memory: str | None, out: str | None) -> list[Path]:
    """The folders that a life will create."""
    from lifelore.memory.location import locate

    place = locate(memory)
    folders = ([place.parent] if isinstance(place, Path) else []) + ([Path(out)] if out else [])
    return [folder for folder in folders if not os.path.exists(folder)]  # also a name too long for a file


def _map(map: str | None, watch: str | None) -> str | None:
    from lifelore.core.errors import InputError

    if map is not None and watch is not None and map != watch:
        raise InputError(f"watch and map exclude each other, got {watch} and {map}; give one of them")
    return map if watch is None else watch


def _notify(line: str) -> None:
    print(line, file=sys.stderr)


def _place(argument: str, text: str | None, domain: str) -> "Place | None":
    """A point in metres or a name in buildings, else a cell (row, column)."""
    if text is None:
        return None
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
