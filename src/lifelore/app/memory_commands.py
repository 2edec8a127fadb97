"""`lifelore memory …`: show, export, import, merge and forget the content of a memory."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from lifelore.app.console import print_json, say
from lifelore.app.options import AsJson, Building, Cell, RobotRadius, Where

if TYPE_CHECKING:
    from lifelore.memory import Memory

memory = typer.Typer(
    help="Show, export, import, merge or forget memories.",
    no_args_is_help=True,
)


@memory.command()
def show(where: Where = None, as_json: AsJson = False) -> None:
    """List robots, the buildings that they know, and records."""
    from lifelore.app.memory_table import print_memory
    from lifelore.memory import open_memory

    with open_memory(where, create=False) as opened:
        overview = opened.show()
        overview["buildings"] = (
            _buildings(opened) if any(one["kind"] == "building" for one in overview["lore"]) else []
        )
    print_json(overview) if as_json else print_memory(overview)


@memory.command()
def export(
    path: Annotated[str, typer.Argument(metavar="FILE")], where: Where = None, as_json: AsJson = False
) -> None:
    """Write all contributions to one portable file.

    Use it for backups, or to move a memory.
    """
    from lifelore.memory import open_memory

    with open_memory(where, create=False) as opened:
        count = opened.export_to(path)
    say({"exported": count, "file": path}, f"{count} contributions written to {path}", as_json)


@memory.command()
def nav2(
    map: Annotated[str, typer.Argument(metavar="YAML", help="ROS map of the building.")],
    out: Annotated[str, typer.Option(metavar="DIR", help="Folder for the files.")],
    where: Where = None,
    cell: Cell = None,
    robot_radius: RobotRadius = None,
    building: Building = None,
    as_json: AsJson = False,
) -> None:
    """Write nav2's masks and route graph of a building.

    Use it after memory has changed, for instance by `learn-from`: the robot's costmaps then show it.
    """
    from lifelore.agent.live.output.known_building import write_known_building
    from lifelore.domains.worlds import WorldSettings

    settings = WorldSettings("building", map, cell=cell, robot_radius=robot_radius)
    written = write_known_building(out, settings, where, building)
    say({"out": out, "files": written}, f"{len(written)} files written to {out}", as_json)


@memory.command("import", help="Add exported files, all or none, as `merge` does.")
@memory.command()
def merge(
    others: Annotated[list[str], typer.Argument(metavar="FILE|URL…")],
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Add the content of other memories or exported files, all or none.

    Use it to share the knowledge of several robots. The others are not changed. Contributions that are stored
    already or were forgotten are skipped. The result does not depend on order and grouping. A building that is
    new here is joined to a building that it shows; the frame of the building that was here before stays.
    """
    from lifelore.agent.live.buildings.merged_buildings import described, merge_memories
    from lifelore.memory import open_memory
    from lifelore.memory.location import describe, locate

    with open_memory(where) as opened:
        each, buildings = merge_memories(opened, others)
    totals = {name: sum(counts[name] for counts in each) for name in each[0]}
    counts_text = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in totals.items())
    document: dict[str, Any] = dict(totals)
    if len(others) > 1:
        counts_text += f", from {len(others)} memories"
        named = zip(others, each, strict=True)
        document["sources"] = [{"source": describe(locate(other))} | counts for other, counts in named]
    if buildings:
        document["buildings"] = buildings
    say(document, "\n".join([f"contributions: {counts_text}", *map(described, buildings)]), as_json)


@memory.command()
def forget(
    robot: Annotated[str | None, typer.Argument(help="Robot whose contributions are deleted.")] = None,
    building: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Building whose map and transitions are deleted; the priors stay."),
    ] = None,
    source: Annotated[
        str | None, typer.Option(metavar="RUNS", help="Log whose runs are deleted, as named to learn-from.")
    ] = None,
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Delete a robot, a building or the runs of a log for ever.

    No later import restores them. learn-from learns the runs of a log again.
    """
    from lifelore.agent.learn_from.learn_from import forget_source
    from lifelore.agent.live.buildings.building_memory import forget_building
    from lifelore.core.errors import InputError
    from lifelore.memory import open_memory

    if (robot is None and source is None) == (building is None):
        raise InputError(
            "forget needs a robot, --source RUNS (of one robot or of all) or --building NAME; "
            "see: lifelore memory show"
        )
    with open_memory(where, create=False) as opened:
        if building is not None:
            done = forget_building(opened, building)
            say(done, f"building {building} forgotten: {done['records']} records", as_json)
            return
        if source is not None:
            count = forget_source(opened, source, robot)
            say({"forgotten": count, "source": source}, f"{count} runs of {source} forgotten", as_json)
            return
        count = opened.forget(str(robot))
    say({"forgotten": count, "robot": robot}, f"{count} contributions of {robot} forgotten", as_json)


def _buildings(opened: "Memory") -> list[dict]:
    from lifelore.agent.live.buildings.building_memory import buildings_in

    return buildings_in(opened)
