"""`lifelore learn-from`: learn from the runs of a real robot."""

from collections import Counter
from typing import Annotated

import typer

from lifelore.app.options import AsJson, Building, Cell, Robot, RobotRadius, Where

Option = typer.Option


def learn_from(
    runs: Annotated[
        str, typer.Argument(metavar="RUNS", help="CSV with time, x, y and outcome, or a rosbag with poses.")
    ],
    map: Annotated[str, Option(metavar="YAML", help="ROS map in whose frame the poses are.")],
    topic: Annotated[
        str | None, Option(help="rosbag: topic of the poses; default: /tf from map to base, else the only one.")
    ] = None,
    bumps: Annotated[
        str | None, Option(metavar="TOPIC", help="rosbag: topic of a bumper; default: /bump, /bumper.")
    ] = None,
    reached_goal: Annotated[
        bool, Option("--reached-goal", help="Each run that has no outcome goal or failed ended at its goal.")
    ] = False,
    shift: Annotated[
        str | None, Option(metavar="X,Y,YAW", help="Lay the log on the map: turn by YAW, then add X, Y.")
    ] = None,
    dry_run: Annotated[bool, Option("--dry-run", help="Report what would be learnt; store nothing.")] = False,
    out: Annotated[
        str | None, Option(metavar="DIR", help="Folder for nav2's masks and route graph of all that is known.")
    ] = None,
    cell: Cell = None,
    robot_radius: RobotRadius = None,
    weight: Annotated[float, Option(help="Weight w(π) of a run by a robot that makes no detours.")] = 1.0,
    building: Building = None,
    robot: Robot = "robot",
    memory: Where = None,
    as_json: AsJson = False,
) -> None:
    """Learn moves and a prior from runs of a real robot.

    Use it to teach memory what your robot drove, how long it took and what it bumped into. A run is
    learnt once, in whatever file it comes again. The columns run, heading and outcome are optional; an outcome is
    bump, goal or failed. Of a rosbag, /tf, /tf_static, poses, bumps and the goals of nav2's
    /navigate_to_pose are read. To undo it: lifelore memory forget --source RUNS.
    """
    from lifelore.app.console import print_json, progress_bar
    from lifelore.core.errors import InputError
    from lifelore.verbs import learn_from as learn

    if dry_run and out is not None:
        raise InputError(f"out does not apply to a dry run, got {out!r}; leave one of the two out")
    if out is not None:
        from lifelore.agent.live.output.report import check_folder

        check_folder(out)
    with progress_bar("learning") as progress:
        report = learn(
            runs,
            map=map,
            memory=memory,
            robot=robot,
            building=building,
            cell=cell,
            robot_radius=robot_radius,
            topic=topic,
            bumps=bumps,
            weight=weight,
            reached_goal=reached_goal,
            shift=_shift(shift),
            dry_run=dry_run,
            progress=progress,
        )
    if out is not None:
        from lifelore.agent.live.output.known_building import write_known_building
        from lifelore.domains.worlds import WorldSettings

        world = WorldSettings("building", map, cell=cell, robot_radius=robot_radius)
        report["files"] = write_known_building(out, world, memory, building)
    print_json(report) if as_json else _print(report)


def _shift(text: str | None) -> tuple[float, float, float] | None:
    from lifelore.core.errors import InputError

    if text is None:
        return None
    try:
        x, y, yaw = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(
            f"shift must be X,Y,YAW in metres and radians, got {text!r}; for example --shift=-5,2,0"
        ) from None
    return x, y, yaw


def _print(report: dict) -> None:
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    building = report["building"]
    console.print(
        f"building {building['name']}" if building["recognised"] else f"a new building: {building['name']}"
    )
    if report["dry_run"]:
        console.print("dry run: nothing is stored")
    console.print(
        f"{report['new']} of {report['runs']} runs are new; {report['to_goal']} reached their goal; "
        f"{report['moves']:,} moves and {report['bumps']:,} bumps from {report['poses']:,} poses"
    )
    if report["competence"] is not None:
        console.print(f"estimated competence {report['competence']:.2f}")
    if report["new_obstacles"]:
        bumps = Counter(f"{x:.2f},{y:.2f} {move}" for x, y, move in report["new_obstacles"])
        places = "; ".join(f"{place} × {times}" for place, times in bumps.most_common(5))
        console.print(f"{bumps.total()} bumps where the map is free, such as {places}")
    if not report["clock"]:
        console.print("times of the log are no seconds since 1970: its runs count as driven at this hour")
    for warning in report["warnings"]:
        console.print(f"warning: {warning}")
    if report["new"] and not report["dry_run"]:
        console.print(f"to undo it: lifelore memory forget --source '{report['source']}'")
