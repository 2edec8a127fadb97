"""`lifelore perceive`: objects, contact points and spatial relations in point clouds."""

import os
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lifelore.bridges.rosbag import is_bag

if TYPE_CHECKING:
    from lifelore.app.setting_keys import SettingKeys

Option = typer.Option
Files = dict[str, Any]
"""Fields of `agent.perceive.scene_files.SceneFiles`, as the options name them."""


def perceive(
    clouds: Annotated[
        list[str] | None, typer.Argument(metavar="CLOUD...", help="PCD, PLY, npz, npy, depth images or rosbags.")
    ] = None,
    up: Annotated[
        str,
        Option(
            metavar="table|z|X,Y,Z",
            show_default=False,
            help="Upwards: the table's normal, +z or a vector [table].",
        ),
    ] = "table",
    units: Annotated[
        str, Option(metavar="UNIT", show_default=False, help="Unit of the coordinates: m, cm, mm or inch [m].")
    ] = "m",
    labels: Annotated[
        str,
        Option(
            metavar="KIND", show_default=False, help="Label field: plain, parts (20–29: one object), auto [auto]."
        ),
    ] = "auto",
    topic: Annotated[str | None, Option(metavar="NAME", help="Topic of a rosbag with several.")] = None,
    intrinsics: Annotated[
        str | None, Option(metavar="FILE", help="Camera of a depth image: camera_info YAML, or JSON.")
    ] = None,
    colour: Annotated[
        str | None, Option(metavar="IMAGE", help="Colour image aligned with the depth image.")
    ] = None,
    masks: Annotated[
        str | None, Option(metavar="FILE", help="Masks of the objects: a label image (PNG), npz or npy.")
    ] = None,
    poses: Annotated[
        str | None, Option(metavar="FILE", help="Camera-to-world poses of clouds, views of one scene.")
    ] = None,
    register: Annotated[
        bool, Option("--register", help="Find the poses of the clouds, views of one scene.")
    ] = False,
    roi: Annotated[
        str | None, Option(metavar="BOX", help="Only points in XMIN,XMAX,YMIN,YMAX,ZMIN,ZMAX, metres.")
    ] = None,
    max_range: Annotated[
        float | None, Option(metavar="M", help="Only points within M metres of the camera.")
    ] = None,
    model: Annotated[
        str | None, Option(metavar="NAME|FILE", help="Relation model of learn-relations; default: shipped.")
    ] = None,
    memory: Annotated[str | None, Option(metavar="FILE|URL", help="Memory that holds the model NAME.")] = None,
    pddl: Annotated[
        str | None, Option(metavar="FILE", help="File for a planning problem; its domain beside it.")
    ] = None,
    goal: Annotated[
        str | None, Option(metavar="GOAL", help='Goal, such as "on(o2, o3) and not clear(o4)".')
    ] = None,
    plan: Annotated[
        bool, Option("--plan", help="Find a plan for the goal, with places (extra planning).")
    ] = False,
    min_confidence: Annotated[
        float | None, Option(metavar="P", help="Least probability of facts, 0 to 1 [0; planning 0.6].")
    ] = None,
    dot: Annotated[str | None, Option(metavar="FILE", help="File for the relations as a Graphviz graph.")] = None,
    plot: Annotated[
        str | None, Option(metavar="FILE", help="File NAME.png for a picture from the camera.")
    ] = None,
    log: Annotated[
        str | None, Option(metavar="FILE", help="File NAME.mcap or .rrd for a viewer (extra ros or view).")
    ] = None,
    watch: Annotated[
        str | None, Option(metavar="FOLDER", help="Perceive each new cloud of a folder until Ctrl-C.")
    ] = None,
    changes: Annotated[
        list[str] | None, Option("--set", metavar="KEY=VALUE", help="Change a rare setting; repeat it for more.")
    ] = None,
    settings: Annotated[bool, Option("--settings", help="List what --set takes, and perceive nothing.")] = False,
    as_json: Annotated[bool, Option("--json", help="One JSON document; with --watch one line a cloud.")] = False,
) -> int:
    """Find objects, contacts and relations in point clouds.

    Use it to turn a cloud into facts for a planner, a graph or a picture. Several clouds in one call are faster
    than a call for each; {name} in a FILE that is written stands for the name of the cloud without its suffix.
    A cloud that cannot be perceived gives one line on stderr and exit status 2; the others are still perceived.
    A goal without a plan is a result: --plan says why.
    """
    keys = setting_keys()
    if settings:
        keys.show(as_json)
        return 0
    rare = keys.read(changes or ())
    if (watch is None) == (not clouds):
        raise typer.BadParameter(
            "--watch perceives the new clouds of a folder: leave the clouds out" if clouds else
            "give one or more clouds, or --watch FOLDER"
        )  # fmt: skip
    # Before NumPy is loaded: for matrices of three columns more threads of BLAS are slower.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from lifelore.agent.perceive.perceive import PerceiveSettings, read_region, read_up
    from lifelore.agent.perceive.source_files import SourceFiles

    beside = SourceFiles(intrinsics, colour, rare.get("depth_scale"), masks, rare.get("table_mask"))
    chosen = PerceiveSettings(
        read_up(up),
        units,
        labels,
        _cut(rare.get("segment"), rare.get("colours")),
        model,
        memory,
        min_confidence,
        goal,
        beside,
        read_region(roi, max_range),
        rare.get("with_masks", False),
        _planner() if plan else None,
    )
    files: Files = {"pddl": pddl, "dot": dot, "plot": plot, "masks_out": rare.get("masks_out")}
    if log is not None:
        from lifelore.bridges.viewer_log import check_log, write_scene_log

        check_log(log)
        files |= {"log": log, "recorder": write_scene_log}
    if watch is not None and (poses is not None or register):
        raise typer.BadParameter("--watch perceives each cloud alone: leave --poses and --register out")
    if poses is not None and register:
        raise typer.BadParameter("--register finds the poses that --poses gives: leave one of them out")
    for cloud in clouds or [str(watch)]:
        _check_bag_options(cloud, topic, rare.get("index"))
    if clouds is None or not clouds:
        return _watched(str(watch), chosen, files, as_json)

    def source(cloud: str) -> Any:
        return _out_of_bag(cloud, topic, rare.get("index", 0), units, labels) if is_bag(cloud) else cloud

    views = poses is not None or register
    if len(clouds) > 1 and not views:
        return _several(clouds, source, chosen, files, as_json)
    from lifelore.agent.perceive.perceive import perceive as look
    from lifelore.agent.perceive.scene_files import SceneFiles
    from lifelore.app.console import print_json, progress_bar, to_stderr

    with progress_bar("perceiving") as progress:
        further: dict[str, Any] = vars(SceneFiles(**files).of(clouds[0]))
        further |= {"progress": progress, "notice": to_stderr}
        if views:
            from lifelore.agent.perceive.views import perceive_views

            document = perceive_views(clouds, chosen, poses=poses, read=source, **further)
        else:
            document = look(source(clouds[0]), chosen, **further)
    print_json(document) if as_json else _print_scene(clouds[0], document, files)
    return 0


def setting_keys() -> "SettingKeys":
    """The rare settings of `perceive`, by key."""
    from lifelore.app.setting_keys import SettingKeys

    return SettingKeys(RareSettings)


@dataclass(frozen=True)
class RareSettings:
    """What ``perceive --set`` changes.

    Parameters
    ----------
    segment : {"convexity", "clusters", "colour"}
        Segmentation of a cloud without labels.
    colours : int
        With segment=colour: clusters of colour; the smallest is background.
    index : int
        Number of a rosbag's cloud, from 0.
    depth_scale : float, optional
        Metres for each unit of depth; 0.001 for whole numbers, 1 for floats.
    table_mask : int, optional
        Number of the table's mask; without it, the plane without a mask is the table.
    masks_out : str, optional
        File NAME.png for a 16-bit image of the objects' numbers.
    with_masks : bool
        Whether JSON holds each object's pixels, or its points' numbers.
    """

    segment: str = "convexity"
    colours: int = 3
    index: int = 0
    depth_scale: float | None = None
    table_mask: int | None = None
    masks_out: str | None = None
    with_masks: bool = False


def _several(clouds: list[str], source: Callable[[str], Any], settings: Any, files: Files, as_json: bool) -> int:
    from lifelore.agent.perceive.perceive_many import perceive_many, scenes_document
    from lifelore.app.console import INTERRUPTED, print_json, progress_bar, stop_on_interrupt, to_stderr

    # Without --json each scene is printed at once; a progress bar would draw over it.
    with stop_on_interrupt() as stop, progress_bar("perceiving") if as_json else nullcontext() as progress:
        entries = perceive_many(
            clouds, settings, **files, read=source, stop=stop, progress=progress, notice=to_stderr
        )
        document = scenes_document(_printed(entry, files, as_json) for entry in entries)
    if as_json:
        print_json(document)
    return INTERRUPTED if stop.is_set() else 2 if document["failed"] else 0


def _watched(folder: str, settings: Any, files: Files, as_json: bool) -> int:
    from lifelore.agent.perceive.perceive_many import perceive_folder
    from lifelore.app.console import INTERRUPTED, print_json_line, stop_on_interrupt, to_stderr

    with stop_on_interrupt() as stop:
        entries = perceive_folder(folder, settings, **files, stop=stop, notice=to_stderr)
        to_stderr(f"watching {folder} for new clouds; Ctrl-C stops")
        for entry in entries:
            _printed(entry, files, as_json)
            if as_json:
                print_json_line(entry)
    return INTERRUPTED


def _printed(entry: dict[str, Any], files: Files, as_json: bool) -> dict[str, Any]:
    """The entry, after a failure is printed as one line on stderr, and a scene as a table unless as JSON."""
    from lifelore.app.console import to_stderr

    if "error" in entry:
        to_stderr(f"{entry['source']}: {entry['error']}")
    elif not as_json:
        print(f"{entry['source']}:", flush=True)
        _print_scene(entry["source"], entry, files)
    return entry


def _print_scene(cloud: str, document: Mapping[str, Any], files: Files) -> None:
    from lifelore.agent.perceive.scene_files import SceneFiles
    from lifelore.app.scene_table import print_scene

    print_scene(document, list(SceneFiles(**files).of(cloud).options.values()))


def _cut(segment: str | None, colours: int | None):
    if colours is not None and segment != "colour":
        from lifelore.core.errors import InputError

        raise InputError("colours belongs to segment=colour: set both, or leave colours out")
    if segment is None:
        return None
    from lifelore.perception.segmentation.object_segmentation import SegmentationSettings

    default = SegmentationSettings.colours
    return SegmentationSettings(method=segment, colours=default if colours is None else colours)  # type: ignore[arg-type]


def _planner():
    from lifelore.bridges.planner import library, solve

    library()  # refuse at once where the extra is missing
    return solve


def _check_bag_options(cloud: str, topic: str | None, index: int | None) -> None:
    if (topic is not None or index is not None) and not is_bag(cloud):
        from lifelore.core.errors import InputError

        raise InputError(f"topic and index choose a cloud of a rosbag, but '{cloud}' is no rosbag: leave them out")


def _out_of_bag(path: str, topic: str | None, index: int, units: str, labels: str):
    from lifelore.bridges.rosbag_cloud import read_bag_cloud

    return read_bag_cloud(path, topic, index, units=units, labels=labels)
