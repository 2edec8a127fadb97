"""`lifelore live`: the main job."""

from typing import Annotated

import typer

Option = typer.Option


def live(
    domain: Annotated[str, Option(help="building, or the thesis's worlds: lattice, noise.")] = "building",
    map: Annotated[str | None, Option(metavar="YAML", help="ROS map; without it a generated office.")] = None,
    tasks: Annotated[int, Option(help="Tasks to live through now.")] = 30,
    cell: Annotated[float | None, Option(help="Side of a grid cell, metres [building: 0.5].")] = None,
    robot_radius: Annotated[float | None, Option(help="Metres [building: 0.2].")] = None,
    destinations: Annotated[int, Option(help="Goals lie among so many recurring places; 0: anywhere.")] = 0,
    learner: Annotated[
        str, Option(help="model (plans on what it learnt) or q (the thesis's Q-learning).")
    ] = "model",
    prior: Annotated[str, Option(help="Action prior by observation, by state, or none.")] = "observation",
    agent: Annotated[
        str, Option(help="lore, model, prior, scratch, undirected, rmax, frontier, or all.")
    ] = "lore",
    robot: Annotated[str, Option(help="Name in memory; one for each robot that runs at a time.")] = "robot",
    start: Annotated[
        str | None, Option(metavar="ROW,COL", help="Every episode starts here; else anywhere.")
    ] = None,
    memory: Annotated[str | None, Option(metavar="FILE|URL", help="SQLite file or postgresql:// URL.")] = None,
    episodes: Annotated[int | None, Option(help="Episodes of a task [model: 100 or more, q: 1000].")] = None,
    max_steps: Annotated[int | None, Option(help="Steps of an episode [building: 2000, else 1000].")] = None,
    out: Annotated[
        str | None, Option(metavar="DIR", help="Write summary.json, pictures and exports here.")
    ] = None,
    l2log: Annotated[
        str | None, Option(metavar="DIR", help="Log every episode here in L2Logger's format.")
    ] = None,
    seed: Annotated[int, Option(help="Same seed, same life.")] = 0,
    jobs: Annotated[int, Option(help="Threads; results do not depend on them.")] = 2,
    density: Annotated[float | None, Option(help="noise: share of obstacles in (0, 1).")] = None,
    discount: Annotated[float | None, Option(help="γ [building: 0.99, else 0.95].")] = None,
    goal_reward: Annotated[float | None, Option(help="[100]")] = None,
    wall_reward: Annotated[float | None, Option(help="[-10]")] = None,
    alpha0: Annotated[float, Option(help="Pseudo-count α⁰ of the prior.")] = 0.1,
    weight: Annotated[float, Option(help="Weight w(π) of each finished task in the prior.")] = 1.0,
    form: Annotated[str, Option(help="q: proportion, dirichlet, softmax, support or tempered.")] = "proportion",
    ties: Annotated[str, Option(help="q: ties in argmax broken uniform or by the prior.")] = "uniform",
    learning_rate: Annotated[float, Option(help="q: α.")] = 0.5,
    epsilon: Annotated[float, Option(help="q: ε of the first episode.")] = 1.0,
    epsilon_decay: Annotated[float, Option(help="q: factor an episode.")] = 0.98,
    epsilon_floor: Annotated[float, Option(help="q: ε never falls below.")] = 0.01,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> int:
    """Live through a stream of tasks in one world, each better because of the earlier ones.

    What is learnt is kept in memory, one transaction a finished task: run it again and the life goes on, in this
    building or another one.
    """
    settings = {k: v for k, v in locals().items() if k not in ("out", "l2log", "as_json", "start")}
    from lifelore.agent.live.l2_log import LifeLog
    from lifelore.agent.live.life import live as live_through
    from lifelore.agent.live.life_settings import LifeSettings
    from lifelore.agent.live.report import check_folder, write_portfolio
    from lifelore.app.console import INTERRUPTED, print_json, progress_bar, stop_on_interrupt
    from lifelore.app.life_table import print_life

    told = LifeSettings(**settings, start=_row_column(start))
    if out is not None:
        check_folder(out)
    watch = None if l2log is None else LifeLog(l2log, domain).add
    with stop_on_interrupt() as stop, progress_bar("living") as progress:
        life = live_through(told, progress=progress, stop=stop, watch=watch)
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
