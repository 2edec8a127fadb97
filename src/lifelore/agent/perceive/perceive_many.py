"""`perceive` for many clouds in one process: a list of them, or each new cloud that appears in a folder.

The relation model is loaded once, and kernels stay warm: a further cloud takes a fraction of a process's time. A
cloud that cannot be perceived stops none of the others.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from threading import Event
from typing import Any

from lifelore.agent.perceive.cloud_folder import new_clouds
from lifelore.agent.perceive.perceive import DEFAULT, PerceiveSettings, Source, files_read, model_of, perceived
from lifelore.agent.perceive.scene_files import (
    NAME,
    SceneFiles,
    check_files_of_scenes,
    check_names,
    check_scene_files,
    named_files,
)
from lifelore.core.errors import InputError, LifeloreError
from lifelore.core.protocols import Progress
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.cloud_scale import check_units
from lifelore.perception.clouds.label_rule import check_rule
from lifelore.perception.segmentation.table_frame import check_up

Entry = dict[str, Any]
"""``{"source", …}`` with the document of `perceive`; or ``{"source", "error"}``."""


def perceive_many(
    sources: Sequence[str],
    settings: PerceiveSettings = DEFAULT,
    *,
    pddl: str | None = None,
    dot: str | None = None,
    plot: str | None = None,
    read: Callable[[str], Source] | None = None,
    stop: Event | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
) -> Iterator[Entry]:
    """Perceive clouds one after another, each when the iterator is asked for it.

    Parameters
    ----------
    sources : sequence of str
        Files of any kind that `read_cloud` knows, and what `read` knows.
    settings : PerceiveSettings
    pddl, dot, plot : str, optional
        As for `perceive`; ``{name}`` stands for the name of each cloud's file without its suffix.
    read : callable, optional
        Gives for one of `sources` what `perceive` shall take in its place (a cloud out of a rosbag, say).
    stop : Event, optional
        No further cloud is begun once it is set.
    progress : Progress, optional
        Called as each of the `perceive.STAGES` of each cloud begins.
    notice : callable, optional
        As for `perceive`; each line begins with its cloud.

    Returns
    -------
    iterator of dict
        For each of `sources` in order ``{"source", …}`` with the document of `perceive`; or, with one line,
        ``{"source", "error"}`` where this cloud cannot be perceived or its files cannot be written.

    Raises
    ------
    InputError, NotFoundError
        At once, before any cloud: a setting breaks its rule, there is no such model, or the names of the files to
        write are without ``{name}``, cannot be written, or stand for two clouds.
    """
    _check_words(settings)
    files = [named_files(source, pddl, dot, plot) for source in sources]
    if pddl or dot or plot:
        check_names(SceneFiles(pddl, dot, plot))
        _check_twins(sources)
    check_files_of_scenes(files, files_read(sources, settings))
    model = model_of(settings)

    def each() -> Iterator[Entry]:
        for number, (source, own) in enumerate(zip(sources, files, strict=True)):
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
    pddl: str | None = None,
    dot: str | None = None,
    plot: str | None = None,
    notice: Callable[[str], None] | None = None,
) -> Iterator[Entry]:
    """Perceive each new cloud of a folder when it is whole, until `stop` is set; see `new_clouds`.

    Parameters
    ----------
    folder : path
    settings, pddl, dot, plot, notice
        As for `perceive_many`. A new version of a cloud writes over the files of the one before it.
    stop : Event
        The cloud in work is finished first.

    Returns
    -------
    iterator of dict
        As of `perceive_many`, in the order in which the clouds become whole.

    Raises
    ------
    InputError, NotFoundError
        At once: as `perceive_many`, or there is no such folder. Later: the folder has gone.
    """
    _check_words(settings)
    if pddl or dot or plot:
        check_names(SceneFiles(pddl, dot, plot))
    check_scene_files(named_files(NAME, pddl, dot, plot), files_read([], settings))
    model = model_of(settings)
    arrivals = new_clouds(
        folder, lambda path: read_cloud(path, units=settings.units, labels=settings.labels), stop
    )
    owner: dict[str, str] = {}

    def perceived_of(path: str, cloud: Source | LifeloreError) -> Entry:
        if isinstance(cloud, LifeloreError):
            raise cloud
        own = named_files(path, pddl, dot, plot)
        if own.paths:
            check_scene_files(own, files_read([path], settings))
            _claim(owner, path, own)
        return perceived(cloud, model, settings, own, None, None if notice is None else _named(notice, path))

    return (_entry(path, partial(perceived_of, path, cloud)) for path, cloud in arrivals)


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
        return {"source": source, "error": "does not fit into memory: thin the cloud out"}


def _check_words(settings: PerceiveSettings) -> None:
    """Refuse, once, what every cloud would be refused for."""
    check_units(settings.units)
    check_rule(settings.labels)
    check_up(settings.up)


def _check_twins(sources: Sequence[str]) -> None:
    """Refuse two clouds whose files would have one name."""
    first: dict[str, str] = {}
    for source in sources:
        other = first.setdefault(Path(source).stem, source)
        if Path(other) != Path(source):
            raise InputError(
                f"'{other}' and '{source}' would be written to one file, their name being"
                f" '{Path(source).stem}': rename one of them, or perceive them one by one"
            )


def _claim(owner: dict[str, str], source: str, files: SceneFiles) -> None:
    """Note that `files` and `source` itself belong to `source`; refuse to write what another cloud owns."""
    written = [os.path.realpath(path) for path in files.paths]
    for path in written:
        other = owner.get(path, source)
        if other != source and os.path.exists(other):
            raise InputError(f"'{source}' would write over '{other}' or a file of it, {path}: rename one of them")
    owner.update(dict.fromkeys([*written, os.path.realpath(source)], source))


def _step_of(progress: Progress, number: int, total: int, source: str) -> Progress:
    def step(done: int, stages: int, stage: str) -> None:
        progress(number * stages + done, total * stages, f"{Path(source).name}, {stage}")

    return step


def _named(notice: Callable[[str], None], source: str) -> Callable[[str], None]:
    return lambda line: notice(f"{source}: {line}")
