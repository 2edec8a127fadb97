"""What joins the agent and other people's systems: the runs in a robot's log, and learning from them.

>>> from lifelore import learn_from, live, recognise, way  # doctest: +SKIP
>>> learn_from("runs.csv", map="depot.yaml", memory="depot.db")  # doctest: +SKIP
>>> live(map="depot.yaml", goals="jobs.csv", memory="depot.db").report["summary"]  # doctest: +SKIP
>>> way("dock", "gate", map="depot.yaml", memory="depot.db").poses  # doctest: +SKIP
>>> recognise("depot_new.yaml", goals="jobs.csv", memory="depot.db").waypoints  # doctest: +SKIP
"""

from collections.abc import Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress

if TYPE_CHECKING:
    from lifelore.agent.learn_from.run_log import Run

PathText = str | PathLike[str]


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


def _text(path: PathText | None) -> str | None:
    return None if path is None else fspath(path)
