"""`lifelore live`: live through a stream of tasks in one world."""

from typing import Annotated

import typer

Option = typer.Option


def live(
    domain: Annotated[str, Option(help="World: building, or the thesis's worlds lattice and noise.")] = "building",
    map: Annotated[
        str | None, Option(metavar="YAML", help="ROS map of the building; default: a generated office.")
    ] = None,
    tasks: Annotated[int, Option(help="Tasks to live through now.")] = 30,
    cell: Annotated[float | None, Option(help="Side of a grid cell in metres [building: 0.5].")] = None,
    robot_radius: Annotated[float | None, Option(help="Radius of the robot in metres [building: 0.2].")] = None,
    destinations: Annotated[
        int, Option(help="Number of recurring places that goals are drawn from; 0: every place.")
    ] = 0,
    learner: Annotated[
        str, Option(help="model (plans on a learnt model of the moves) or q (the thesis's Q-learning).")
    ] = "model",
    prior: Annotated[
        str, Option(help="Action prior conditioned on the observation or the state, or none.")
    ] = "observation",
    agent: Annotated[
        str, Option(help="Agent: lore, model, prior, scratch, undirected, rmax, frontier, or all.")
    ] = "lore",
    robot: Annotated[
        str, Option(help="Name of the robot in memory; robots that run at the same time need different names.")
    ] = "robot",
    start: Annotated[
        str | None, Option(metavar="ROW,COL", help="Cell in which every episode starts; default: any cell.")
    ] = None,
    memory: Annotated[
        str | None, Option(metavar="FILE|URL", help="Memory: SQLite file or postgresql:// URL; default: your own.")
    ] = None,
    episodes: Annotated[
        int | None, Option(help="Maximum episodes of a task [model: 100 or more, q: 1000].")
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
    seed: Annotated[int, Option(help="Draws the world, the tasks and the agents' choices.")] = 0,
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
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> int:
    """Live through a stream of tasks in one world and learn from each task for the next ones.

    Use it to see what an agent gains from its earlier tasks, in your own map or in a generated office. Memory
    stores what the agent learnt after each task: the next run continues the life, in this building or in another
    one.
    """
    from contextlib import nullcontext

    from lifelore.agent.live.l2_log import LifeLog
    from lifelore.agent.live.life import live as live_through
    from lifelore.agent.live.life_settings import LearningSettings, LifeSettings, MemorySettings, PriorSettings
    from lifelore.agent.live.long_table import LongTable
    from lifelore.agent.live.report import check_folder, write_portfolio
    from lifelore.app.console import INTERRUPTED, print_json, progress_bar, stop_on_interrupt
    from lifelore.app.life_table import print_life
    from lifelore.domains.worlds import WorldSettings

    settings = LifeSettings(
        world=WorldSettings(
            domain,
            map,
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
        memory=MemorySettings(memory, robot),
        agent=agent,
        tasks=tasks,
        destinations=destinations,
        start=_row_column(start),
        jobs=jobs,
    )
    if out is not None:
        check_folder(out)
    log = None if l2log is None else LifeLog(l2log, domain)
    with (
        LongTable(csv, seed) if csv is not None else nullcontext() as table,
        stop_on_interrupt() as stop,
        progress_bar("living") as progress,
    ):

        def watch(task: dict, results: dict) -> None:
            if log:
                log.add(task, results)
            if table:
                table.add_results(task, results)

        life = live_through(settings, progress=progress, stop=stop, watch=watch)
        written = write_portfolio(life, out) if out is not None else []
    if as_json:
        print_json(life.report)
    else:
        print_life(life.report, written)
    return INTERRUPTED if life.stopped else 0


def _row_column(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    from lifelore.core.errors import InputError

    try:
        row, column = (int(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"start must be ROW,COL, two whole numbers, got '{text}'") from None
    return row, column
