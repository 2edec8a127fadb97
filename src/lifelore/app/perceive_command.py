"""`lifelore perceive`: from a point cloud to what bears on what."""

import os
import sys
from typing import Annotated

import typer

Option = typer.Option


def perceive(
    cloud: Annotated[str, typer.Argument(metavar="CLOUD", help="PCD, PLY, npz, npy or a rosbag.")],
    up: Annotated[
        str, Option(metavar="table|z|X,Y,Z", help="Where up is: the table's normal, +z, or a vector.")
    ] = "table",
    units: Annotated[str, Option(help="Of the coordinates: m or mm.")] = "m",
    labels: Annotated[
        str, Option(help="The label field: plain ids, parts (20–29 are one object), or auto.")
    ] = "auto",
    topic: Annotated[str | None, Option(help="Of a rosbag's clouds; needed where it has several.")] = None,
    index: Annotated[int | None, Option(help="Which cloud of a rosbag, from 0 [0].")] = None,
    segment: Annotated[
        str | None, Option(help="A cloud without labels is cut by clusters or by colour [clusters].")
    ] = None,
    colours: Annotated[
        int | None, Option(help="--segment colour: clusters of colour, the smallest is background [3].")
    ] = None,
    model: Annotated[
        str | None, Option(metavar="NAME|FILE", help="A relation model of learn-relations; default: shipped.")
    ] = None,
    memory: Annotated[str | None, Option(metavar="FILE|URL", help="Where the model NAME is kept.")] = None,
    pddl: Annotated[
        str | None, Option(metavar="FILE", help="Write a planning problem, its domain beside it.")
    ] = None,
    dot: Annotated[str | None, Option(metavar="FILE", help="Write the relations as a Graphviz graph.")] = None,
    plot: Annotated[
        str | None, Option(metavar="FILE", help="Draw the scene as its camera saw it; NAME.png.")
    ] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Find objects, contact points and relations in a cloud."""
    from lifelore.agent.perceive import PerceiveSettings
    from lifelore.agent.perceive import perceive as look
    from lifelore.app.console import print_json, progress_bar

    told = PerceiveSettings(direction(up), units, labels, _cut(segment, colours), model, memory)
    with progress_bar("perceiving") as progress:
        source = _source(cloud, topic, index, units, labels)
        document = look(source, told, pddl=pddl, dot=dot, plot=plot, progress=progress, notice=to_stderr)
    if as_json:
        print_json(document)
    else:
        from lifelore.app.scene_table import print_scene

        print_scene(document, [path for path in (pddl, dot, plot) if path])


def to_stderr(line: str) -> None:
    """What a person should know beside the answer."""
    print(f"lifelore: {line}", file=sys.stderr)


def _cut(segment: str | None, colours: int | None):
    if colours is not None and segment != "colour":
        from lifelore.core.errors import InputError

        raise InputError("colours belongs to --segment colour: add it, or leave --colours out")
    if segment is None:
        return None
    from lifelore.perception.segmentation import SegmentationSettings

    default = SegmentationSettings.colours
    return SegmentationSettings(method=segment, colours=default if colours is None else colours)  # type: ignore[arg-type]


def _source(cloud: str, topic: str | None, index: int | None, units: str, labels: str):
    """A cloud out of a rosbag, or the file itself."""
    if _is_bag(cloud):
        return _out_of_bag(cloud, topic, index or 0, units, labels)
    if topic is not None or index is not None:
        from lifelore.core.errors import InputError

        raise InputError(f"topic and index choose a cloud of a rosbag, and '{cloud}' is none: leave them out")
    return cloud


def _is_bag(path: str) -> bool:
    return path.endswith((".bag", ".mcap", ".db3")) or os.path.isfile(os.path.join(path, "metadata.yaml"))


def _out_of_bag(path: str, topic: str | None, index: int, units: str, labels: str):
    from lifelore.bridges.rosbag_cloud import read_bag_cloud

    return read_bag_cloud(path, topic, index, units=units, labels=labels)


def direction(text: str):
    """Where up is, of the words of a person."""
    if "," not in text:
        return text
    from lifelore.core.errors import InputError

    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"up must be table, z or X,Y,Z, three numbers, got '{text}'") from None
