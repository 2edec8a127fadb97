"""`lifelore recognise`: which building a new map shows, and where the waypoints are now."""

from typing import TYPE_CHECKING, Annotated

import typer

from lifelore.app.options import AsJson, Cell, RobotRadius, Where

if TYPE_CHECKING:
    from lifelore.agent.recognise import Recognition

Option = typer.Option


def recognise(
    map: Annotated[str, typer.Argument(metavar="NEW.yaml", help="The new ROS map.")],
    goals: Annotated[
        str | None,
        Option(metavar="CSV", help="Job list in metres of the remembered frame; default: all names in memory."),
    ] = None,
    out: Annotated[
        str | None, Option(metavar="CSV", help="File for the job list with coordinates of the new map.")
    ] = None,
    memory: Where = None,
    old: Annotated[
        str | None, Option(metavar="OLD.yaml", help="Compare with this earlier map in place of memory.")
    ] = None,
    building: Annotated[
        str | None, Option(metavar="NAME", help="Name of the building: compare with this one, less strictly.")
    ] = None,
    cell: Cell = None,
    robot_radius: RobotRadius = None,
    as_json: AsJson = False,
) -> None:
    """Find your waypoints in a new map.

    Use it when a building was mapped again, or its map was saved again. The remembered frame is that of the first
    map on which a robot lived or drove, or that of --old. Memory is only read.
    """
    from lifelore.agent.recognise import recognise as find
    from lifelore.app.console import print_json

    found = find(map, memory, goals, old=old, building=building, cell=cell, robot_radius=robot_radius)
    if out is not None:
        found.write_jobs(out, goals)
    if as_json:
        print_json(found.to_dict())
        return
    _print(found)
    if out is not None:
        print(f"wrote {out}")


def _print(found: "Recognition") -> None:
    from math import degrees

    dx, dy, turn = found.pose
    print(f"{found.building}: {int(100 * found.walls)} % of the walls agree")
    print(f"the map lies at {dx:z.2f} m, {dy:z.2f} m in the remembered frame, turned by {degrees(turn):z.2f}°")
    if not found.waypoints:
        print("memory knows no places by name here; give a job list (--goals)")
    for one in found.waypoints:
        where = f"{one.point[0]:.2f},{one.point[1]:.2f}"
        print(f"{one.name or 'point'} {where} {one.state}{_hint(one.reason, one.nearest, one.away)}")


def _hint(reason: str | None, nearest: tuple[float, float] | None, away: float) -> str:
    if nearest is None:
        return ""
    return f": {reason}; the nearest free place is {nearest[0]:.2f},{nearest[1]:.2f}, {away:.2f} m away"
