"""`lifelore learn-from`: learn from the runs of a real robot."""

from typing import Annotated

import typer

Option = typer.Option


def learn_from(
    runs: Annotated[
        str, typer.Argument(metavar="RUNS", help="CSV with time, x, y and outcome, or a rosbag with poses.")
    ],
    map: Annotated[str, Option(metavar="YAML", help="ROS map in whose frame the poses are.")],
    topic: Annotated[str | None, Option(help="rosbag: topic of the poses; default: the only one.")] = None,
    reached_goal: Annotated[
        bool, Option("--reached-goal", help="Each run that has no outcome goal or failed ended at its goal.")
    ] = False,
    cell: Annotated[float | None, Option(help="Side of a grid cell in metres [0.5].")] = None,
    robot_radius: Annotated[float | None, Option(help="Radius of the robot in metres [0.2].")] = None,
    weight: Annotated[float, Option(help="Weight w(π) of a run by a robot that makes no detours.")] = 1.0,
    building: Annotated[str | None, Option(help="Name of the building; default: recognise it.")] = None,
    robot: Annotated[str, Option(help="Name of the robot in memory.")] = "robot",
    memory: Annotated[
        str | None, Option(metavar="FILE|URL", help="Memory: SQLite file or postgresql:// URL; default: your own.")
    ] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Learn moves and a prior from runs of a real robot.

    Use it to teach memory what your robot tried and bumped into, before or beside lives in simulation. A run is
    learnt once, in whatever file it comes again. The columns run, heading and outcome are optional; an outcome is
    bump, goal or failed.
    """
    from lifelore.agent.learn_from.learn_from import LearnFromSettings
    from lifelore.agent.learn_from.learn_from import learn_from as learn
    from lifelore.agent.live.life_settings import MemorySettings, PriorSettings
    from lifelore.app.console import print_json, progress_bar
    from lifelore.domains.worlds import WorldSettings

    settings = LearnFromSettings(
        WorldSettings("building", map, cell=cell, robot_radius=robot_radius),
        MemorySettings(memory, robot, building),
        PriorSettings(weight=weight),
        reached_goal,
    )
    with progress_bar("learning") as progress:
        report = learn(_runs(runs, topic), settings, runs, progress)
    print_json(report) if as_json else _print(report)


def _runs(path: str, topic: str | None):
    from lifelore.agent.learn_from.run_log import read_runs, run_of_poses
    from lifelore.bridges.rosbag import is_bag
    from lifelore.core.errors import InputError

    if is_bag(path):
        from lifelore.bridges.rosbag_poses import read_bag_poses

        return [run_of_poses(path, *read_bag_poses(path, topic))]
    if topic is not None:
        raise InputError(f"topic applies to rosbags, got '{topic}' for {path}; leave it out")
    return read_runs(path)


def _print(report: dict) -> None:
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    building = report["building"]
    console.print(
        f"building {building['name']}" if building["recognised"] else f"a new building: {building['name']}"
    )
    console.print(
        f"{report['new']} of {report['runs']} runs are new; {report['to_goal']} reached their goal; "
        f"{report['moves']:,} moves and {report['bumps']:,} bumps from {report['poses']:,} poses"
    )
    if report["competence"] is not None:
        console.print(f"estimated competence {report['competence']:.2f}")
    if report["new_obstacles"]:
        places = "; ".join(f"{x:.2f},{y:.2f} {move}" for x, y, move in report["new_obstacles"][:5])
        console.print(f"{len(report['new_obstacles'])} bumps where the map is free, such as {places}")
    for warning in report["warnings"]:
        console.print(f"warning: {warning}")
