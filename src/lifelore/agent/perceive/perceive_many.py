"""Perceives many clouds in one process: a list of clouds, or each new cloud of a folder.

The relation model and the kernels are loaded once, so a further cloud takes a fraction of the time of a new
process. A cloud that cannot be perceived does not stop the others.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from threading import Event
from typing import Any, Unpack

from lifelore.agent.perceive.cloud_folder import new_clouds
from lifelore.agent.perceive.perceive import (
    DEFAULT,
    PerceiveSettings,
    Source,
    check_settings,
    files_read,
    model_of,
    perceived,
)
from lifelore.agent.perceive.scene_files import FileNames, SceneFiles, check_names, check_scene_files
from lifelore.agent.perceive.source_files import NO_SOURCE_FILES
from lifelore.core.errors import InputError, LifeloreError
from lifelore.core.protocols import Progress

Entry = dict[str, Any]
"""``{"source", …}`` with the document of `perceive`; or ``{"source", "error"}``."""


def perceive_many(
    sources: Sequence[str],
    settings: PerceiveSettings = DEFAULT,
    *,
    read: Callable[[str], Source] | None = None,
    stop: Event | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
    **files: Unpack[FileNames],
) -> Iterator[Entry]:
    """Perceive clouds one after another, each when the iterator reaches it.

    Parameters
    ----------
    sources : sequence of str
        Files that `read_cloud` reads, or sources of `read`.
    settings : PerceiveSettings
    read : callable, optional
        Maps one of `sources` to a source for `perceive` (for example a cloud of a rosbag).
    stop : Event, optional
        Set it to stop before the next cloud.
    progress : Progress, optional
        Called as each of the `perceive.STAGES` of each cloud begins.
    notice : callable, optional
        As for `perceive`; each line begins with the name of the cloud.
    pddl, dot, plot, masks_out, log, recorder : optional
        As for `perceive`; ``{name}`` stands for the name of each cloud's file without its suffix.

    Returns
    -------
    iterator of dict
        For each of `sources` in order: ``{"source", …}`` with the document of `perceive`, or ``{"source",
        "error"}`` with one line if the cloud cannot be perceived or its files cannot be written.

    Raises
    ------
    InputError, NotFoundError
        Before the first cloud: a setting breaks its rule, the model does not exist, or a file to write has no
        ``{name}``, cannot be written, or is the same for two clouds.
    """
    asked = SceneFiles(**files)
    check_settings(settings, asked.pddl)
    if len(sources) > 1:
        settings.beside.check_for_many()
    check_names(asked)
    named = [asked.of(source) for source in sources]
    check_scene_files(named, files_read(sources, settings))
    model = model_of(settings, notice)

    def each() -> Iterator[Entry]:
        for number, (source, own) in enumerate(zip(sources, named, strict=True)):
            if stop is not None and stop.is_set():
                return
            step = None if progress is None else _step_of(progress, number, len(sources), source)
            noticed = None if notice is None else _named(notice, source)
            yield _entry(source, partial(_perceived, source, read, model, settings, own, step, noticed))

    return each()


def _perceived(source: str, read: Callable[[str], Source] | None, *arguments: Any) -> dict[str, Any]:
    return perceived(source if read is None else read(source), *arguments)


def perceive_folder(
    folder: str | os.PathLike[str],
    settings: PerceiveSettings = DEFAULT,
    *,
    stop: Event,
    notice: Callable[[str], None] | None = None,
    **files: Unpack[FileNames],
) -> Iterator[Entry]:
    """Perceive each new cloud of a folder when its file is complete, until `stop` is set; see `new_clouds`.

    Parameters
    ----------
    folder : path
    settings, notice
        As for `perceive_many`.
    stop : Event
        Set it to stop after the current cloud.
    pddl, dot, plot, masks_out, log, recorder : optional
        As for `perceive_many`. A new version of a cloud overwrites the files of the version before.

    Returns
    -------
    iterator of dict
        As of `perceive_many`, in the order in which the clouds become complete.

    Raises
    ------
    InputError, NotFoundError
        Before the first cloud: as `perceive_many`, or the folder does not exist. Later: the folder has
        disappeared.
    """
    asked = SceneFiles(**files)
    check_settings(settings, asked.pddl)
    if settings.beside != NO_SOURCE_FILES:
        raise InputError(
            "watch perceives clouds alone: leave out intrinsics, colour, depth_scale, masks and table_mask"
        )
    check_names(asked)
    check_scene_files([asked], files_read([], settings))
    model = model_of(settings, notice)
    owner: dict[str, str] = {}

    def document(path: str) -> Entry:
        own = asked.of(path)
        if own.paths:
            check_scene_files([own], files_read([path], settings))
            _claim(owner, path, own)
        return perceived(path, model, settings, own, None, None if notice is None else _named(notice, path))

    return (_entry(path, partial(document, path)) for path in new_clouds(folder, stop))


def scenes_document(entries: Iterable[Entry]) -> dict[str, list[Entry]]:
    """``{"scenes": […], "failed": […]}``: entries of `perceive_many` with a document, and those with an error."""
    parts: dict[str, list[Entry]] = {"scenes": [], "failed": []}
    for entry in entries:
        parts["failed" if "error" in entry else "scenes"].append(entry)
    return parts


def _entry(source: str, document: Callable[[], dict[str, Any]]) -> Entry:
    try:
        return {"source": source, **document()}
    except LifeloreError as error:
        return {"source": source, "error": str(error).removeprefix(f"{Path(source)}: ")}
    except MemoryError:
        return {"source": source, "error": "does not fit into memory: reduce the number of points"}


def _claim(owner: dict[str, str], source: str, files: SceneFiles) -> None:
    """Record that `files` and `source` itself belong to `source`; refuse to overwrite files of another cloud."""
    written = [os.path.realpath(path) for path in files.paths]
    for path in written:
        other = owner.get(path, source)
        if other != source and os.path.exists(other):
            raise InputError(f"'{source}' would overwrite '{other}' or a file of it, {path}: rename one of them")
    owner.update(dict.fromkeys([*written, os.path.realpath(source)], source))


def _step_of(progress: Progress, number: int, total: int, source: str) -> Progress:
    def step(done: int, stages: int, stage: str) -> None:
        progress(number * stages + done, total * stages, f"{Path(source).name}, {stage}")

    return step


def _named(notice: Callable[[str], None], source: str) -> Callable[[str], None]:
    return lambda line: notice(f"{source}: {line}")
