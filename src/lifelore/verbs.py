"""Verbs for a robot in a building, with paths, names and flat keywords, as on the command line.

>>> from lifelore import learn_from, live, recognise, way  # doctest: +SKIP
>>> learn_from("runs.csv", map="depot.yaml", memory="depot.db")  # doctest: +SKIP
>>> live(map="depot.yaml", goals="jobs.csv", memory="depot.db").report["summary"]  # doctest: +SKIP
>>> way("dock", "gate", map="depot.yaml", memory="depot.db").poses  # doctest: +SKIP
>>> recognise("depot_new.yaml", goals="jobs.csv", memory="depot.db").waypoints  # doctest: +SKIP
"""

from collections.abc import Callable, Sequence
from difflib import get_close_matches
from os import PathLike, fspath
from threading import Event
from typing import TYPE_CHECKING, Any

from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress

if TYPE_CHECKING:
    from lifelore.agent.learn_from.run_log import Run
    from lifelore.agent.live.life import Life, Watcher
    from lifelore.agent.live.life_settings import LifeSettings

PathText = str | PathLike[str]


def live(
    settings: "LifeSettings | None" = None,
    *,
    progress: Progress | None = None,
    stop: Event | None = None,
    watch: "Watcher | None" = None,
    notify: Callable[[str], None] | None = None,
    **keys: Any,
) -> "Life":
    """Live through tasks in one world and store what is learnt in memory.

    Parameters
    ----------
    settings : LifeSettings, optional
        All settings, in place of `keys`.
    progress : callable, optional
        Called as ``progress(done, total, label)`` before the first task and after each task.
    stop : threading.Event, optional
        Set it to stop early: the task in progress is dropped, the finished tasks stay.
    watch : callable, optional
        Called as ``watch(task, results)`` after memory has stored a task: the report's entry, and the results by
        agent.
    notify : callable, optional
        Called with a line of text that a person should read.
    **keys
        Settings by key: those of ``lifelore live --settings``, and ``map``, ``tasks``, ``goal``,
        ``goals`` (a job list's path), ``agent``, ``robot``, ``memory`` and ``seed``. A point is a pair of metres.

    Returns
    -------
    Life
        Its ``report`` is the JSON document of ``lifelore live``.

    Raises
    ------
    InputError, NotFoundError
        A key is unknown, or a setting or the map breaks its rule.
    StoreError
        Memory cannot store a task; earlier tasks stay stored.

    Examples
    --------
    >>> life = live(map="depot.yaml", tasks=30, memory="depot.db")  # doctest: +SKIP
    """
    from lifelore.agent.live.life import live as live_through

    if settings is not None and keys:
        raise InputError(f"settings holds all settings, got also {', '.join(keys)}; give one of the two")
    chosen = settings or _life_settings(keys)
    return live_through(chosen, progress=progress, stop=stop, watch=watch, notify=notify)


def learn_from(
    runs: "PathText | Sequence[Run]",
    *,
    map: PathText,
    memory: PathText | None = None,
    robot: str = "robot",
    cell: float | None = None,
    robot_radius: float | None = None,
    topic: str | None = None,
    bumps: str | None = None,
    progress: Progress | None = None,
    **more: Any,
) -> dict[str, Any]:
    """Learn what a real robot drove and bumped into, each run once.

    Parameters
    ----------
    runs : str or Path, or sequence of Run
        CSV file with ``time``, ``x`` and ``y``, a rosbag (extra ``ros``), or runs.
    map : str or Path
        YAML of the ROS map in whose frame the poses are.
    memory : str or Path, optional
        SQLite file or URL; None: the user's own.
    robot : str
        Name of the robot in memory.
    cell, robot_radius : float, optional
        Metres; 0.5 and 0.2.
    topic, bumps : str, optional
        Topics of a rosbag with the poses, and with a bumper.
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each run.
    **more
        ``building``, ``weight``, ``reached_goal``, ``shift`` and ``dry_run``, see ``lifelore learn-from --help``.

    Returns
    -------
    dict
        The JSON document of ``lifelore learn-from``.

    Raises
    ------
    InputError
        The log does not fit the map, or a file or setting breaks its rule. Nothing is stored.
    StoreError
        Memory cannot store a run; earlier runs stay stored.

    Examples
    --------
    >>> learn_from("runs.csv", map="depot.yaml", memory="depot.db")["new"]  # doctest: +SKIP
    20
    """
    from lifelore.agent.learn_from.learn_from import learn_from as learn

    keys: dict[str, Any] = {"map": _text(map), "memory": _text(memory), "robot": robot, "cell": cell}
    keys |= {"robot_radius": robot_radius, "progress": progress, **more}
    if isinstance(runs, str | PathLike):
        return learn(runs_of(fspath(runs), topic, bumps), source=fspath(runs), **keys)
    return learn(runs, **keys)


def runs_of(path: str, topic: str | None = None, bumps: str | None = None) -> "list[Run]":
    """The runs of a CSV file or a rosbag; topics are for rosbags, see `bridges.rosbag_poses`.

    Raises
    ------
    InputError, NotFoundError
        The file breaks a rule of its format, or a topic does not exist or apply.
    """
    from lifelore.agent.learn_from.run_log import Run, cut_runs, read_runs
    from lifelore.bridges.rosbag import is_bag

    if is_bag(path):
        from lifelore.bridges.rosbag_poses import read_bag_log

        log = read_bag_log(path, topic, bumps)
        return cut_runs(Run(path, log.time, log.points, log.heading, log.outcome), log.ends)
    for name, value in (("topic", topic), ("bumps", bumps)):
        if value is not None:
            raise InputError(f"{name} applies to rosbags, got '{value}' for {path}; leave it out")
    return read_runs(path)


def _life_settings(keys: dict[str, Any]) -> "LifeSettings":
    from lifelore.agent.live.goals.job_list import read_jobs
    from lifelore.agent.live.life_settings import LIFE_KEYS, LifeSettings
    from lifelore.core.keyed_settings import arguments_by_key, keys_of

    known = list(keys_of(LifeSettings, LIFE_KEYS))
    for key in keys:
        if key not in known:
            near = ", ".join(get_close_matches(key, known, 3)) or "lifelore live --settings lists them"
            raise InputError(f"no setting has the key '{key}'; near: {near}")
    given = keys | {name: _text(keys[name]) for name in ("map", "memory") if name in keys}
    if isinstance(keys.get("goals"), str | PathLike):
        given["goals"] = read_jobs(keys["goals"])
    return LifeSettings(**arguments_by_key(LifeSettings, given, LIFE_KEYS))


def _text(path: PathText | None) -> str | None:
    return None if path is None else fspath(path)
