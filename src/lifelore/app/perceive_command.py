"""`lifelore perceive`: from a point cloud to what bears on what."""

import os
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
    index: Annotated[int, Option(help="Which cloud of a rosbag, from 0.")] = 0,
    segment: Annotated[str, Option(help="A cloud without labels is cut by clusters or by colour.")] = "clusters",
    colours: Annotated[int, Option(help="--segment colour: clusters of colour, the smallest is background.")] = 3,
    model: Annotated[
        str | None, Option(metavar="NAME|FILE", help="A relation model of learn-relations; default: shipped.")
    ] = None,
    memory: Annotated[str | None, Option(metavar="FILE|URL", help="Where the model NAME is kept.")] = None,
    pddl: Annotated[
        str | None, Option(metavar="FILE", help="Write a planning problem, its domain beside it.")
    ] = None,
    dot: Annotated[str | None, Option(metavar="FILE", help="Write the relations as a Graphviz graph.")] = None,
    plot: Annotated[str | None, Option(metavar="FILE", help="Draw the scene as its camera saw it (PNG).")] = None,
    as_json: Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Find objects, contact points and relations in a cloud."""
    from lifelore.agent.perceive import PerceiveSettings
    from lifelore.agent.perceive import perceive as look
    from lifelore.app.console import print_json
    from lifelore.perception.segmentation import SegmentationSettings

    cut = SegmentationSettings(method=segment, colours=colours)  # type: ignore[arg-type]
    told = PerceiveSettings(_direction(up), units, labels, cut, model, memory)
    source = _out_of_bag(cloud, topic, index, units, labels) if _is_bag(cloud) else cloud
    document = look(source, told, pddl=pddl, dot=dot, plot=plot)
    if as_json:
        print_json(document)
    else:
        from lifelore.app.scene_table import print_scene

        print_scene(document, [path for path in (pddl, dot, plot) if path])


def _is_bag(path: str) -> bool:
    return path.endswith((".bag", ".mcap", ".db3")) or os.path.isfile(os.path.join(path, "metadata.yaml"))


def _out_of_bag(path: str, topic: str | None, index: int, units: str, labels: str):
    from lifelore.bridges.rosbag_cloud import read_bag_cloud

    return read_bag_cloud(path, topic, index, units=units, labels=labels)


def _direction(text: str):
    if "," not in text:
        return text
    from lifelore.core.errors import InputError

    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"up must be table, z or X,Y,Z, three numbers, got '{text}'") from None
