"""`lifelore way`: a path in metres between two places of a building, from memory."""

from typing import Annotated

import typer

from lifelore.app.options import AsJson, Building, Cell, MapFile, RobotRadius, Where

Option = typer.Option


def way(
    start: Annotated[
        str, Option("--from", metavar="X,Y|NAME", help="Start: metres in the map's frame, or a known name.")
    ],
    goal: Annotated[
        str, Option("--to", metavar="X,Y|NAME", help="Destination: metres in the map's frame, or a known name.")
    ],
    map: MapFile = None,
    memory: Where = None,
    csv: Annotated[
        str | None, Option("--csv", metavar="FILE", help="File for the path: x, y (metres), heading (radians).")
    ] = None,
    spacing: Annotated[
        float | None, Option(help="Largest distance between two poses in metres; default: only the corners.")
    ] = None,
    at: Annotated[
        str | None,
        Option(metavar="TIME", help="Start by the robot's clock, 2024-05-13T08:30; default: the newest drive."),
    ] = None,
    cell: Cell = None,
    robot_radius: RobotRadius = None,
    footprint: Annotated[
        str | None,
        Option(metavar="[[X,Y],…]", help="Outline of the robot in metres, as in nav2; default: a disc."),
    ] = None,
    building: Building = None,
    seed: Annotated[int, Option(help="Without a map: seed of the generated office.")] = 0,
    as_json: AsJson = False,
) -> None:
    """Find the quickest clear path between two places.

    Use it after `live` or `learn-from`. The way leads over the free space of the map, and around moves that were
    slow or refused at this time; ground that was never driven costs half as much again. The path keeps the robot's
    radius from all that the map does not show as free. The document of --json has the keys of nav_msgs/Path.
    """
    from lifelore.agent.live.goals.destinations import destination_from_text
    from lifelore.agent.way import clock_from_text, write_poses
    from lifelore.agent.way import way as find_way
    from lifelore.app.console import print_json
    from lifelore.domains.buildings.footprint import Footprint

    found = find_way(
        destination_from_text("from", start),
        destination_from_text("to", goal),
        map=map,
        memory=memory,
        cell=cell,
        robot_radius=robot_radius,
        seed=seed,
        spacing=spacing,
        building=building,
        clock=None if at is None else clock_from_text(at),
        footprint=None if footprint is None else Footprint.from_text(footprint),
    )
    if csv is not None:
        write_poses(csv, found.poses)
    if as_json:
        print_json(found.to_dict())
        return
    undriven = f" ({found.undriven} never driven)" if found.undriven else ""
    print(
        f"{found.length:.2f} m from {found.start} to {found.goal} over {found.places} places{undriven}, "
        f"about {found.seconds:.0f} s, {len(found.poses)} poses"
    )
    if len(found.contradicted):
        x, y = found.contradicted[0]
        print(
            f"a shorter remembered way is not used: the map lacks {len(found.contradicted)} of its moves, "
            f"the first near {x:.2f},{y:.2f}"
        )
    if csv is not None:
        print(f"wrote {csv}")
        return
    for x, y, heading in found.poses.tolist():
        print(f"{x:.3f} {y:.3f} {heading:+.3f}")
