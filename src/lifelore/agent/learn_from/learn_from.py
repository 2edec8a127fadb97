"""Learns from runs of a real robot: moves, their times, bumps and the action prior (`learn-from`).

A run is stored once, in whatever file it comes again. Moves that a robot made, and bumps into walls of the map,
become transitions of the building. Moves with their times, and bumps where the map is free, become observations of
`Travel`, where bumps age and passes reopen a place. The moves of a run that reached its goal also count in the
observation prior, weighted by the robot's competence as for demonstrations (thesis §3.4.8).
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.competence import competence_by_steps
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.agent.learn_from.learnt_runs import DRIVER, LearntRun, has_clock
from lifelore.agent.learn_from.localisation_noise import localisation_noise
from lifelore.agent.learn_from.log_fit import Reachable, Shift, shifted_runs
from lifelore.agent.learn_from.log_report import checked_log, log_report
from lifelore.agent.learn_from.run_log import Run
from lifelore.agent.learn_from.tried_moves import tried_moves
from lifelore.agent.live.buildings.recognition import Place, recognised_place
from lifelore.agent.live.life_settings import MemorySettings, PriorSettings
from lifelore.agent.live.lore import Lore
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.planning.planning import optimal_q
from lifelore.core.protocols import Progress
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import Memory, open_memory
from lifelore.memory.location import locate


def learn_from(
    runs: Sequence[Run],
    *,
    map: str | Path,
    memory: str | Path | None = None,
    robot: str = "robot",
    building: str | None = None,
    cell: float | None = None,
    robot_radius: float | None = None,
    weight: float = 1.0,
    reached_goal: bool = False,
    shift: Shift | None = None,
    dry_run: bool = False,
    source: str = "runs",
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Learn from runs and store what was learnt, each run in one transaction.

    Parameters
    ----------
    runs : sequence of Run
    map : str or Path
        YAML of the ROS map in whose frame the poses are.
    memory : str or Path, optional
        SQLite file or URL; None: the user's own.
    robot, building : str
        Name of the robot that drove, and of the building, which otherwise is recognised.
    cell, robot_radius : float, optional
        Metres; 0.5 and 0.2.
    weight : float
        Weight w(π) of a run by a robot of competence 1, ≥ 0.
    reached_goal : bool
        Take each run without an outcome goal or failed for a run that ended at its goal.
    shift : (x, y, yaw), optional
        Metres and radians that lay the log on the map: a point p becomes R(yaw) · p + (x, y).
    dry_run : bool
        Report, and store nothing.
    source : str
        Name of the log. `forget_source` forgets the runs that were learnt from it.
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each run.

    Returns
    -------
    dict
        JSON data: ``source``, ``building``, ``runs``, ``new`` (runs that memory did not have), ``to_goal``,
        ``poses``, ``moves``, ``bumps``, ``new_obstacles`` (bumps where the map is free: x, y in metres of the
        cell, move), ``outside`` (poses where the robot cannot be), ``noise`` (metres, standard deviation of the
        poses' jitter), ``gaps``, ``contradictions`` (moves through walls of the map, not learnt), ``undirected``
        (bumps without a direction, not learnt), ``competence`` (w in [0, 1]; None without a run to a goal),
        ``clock`` (times are seconds since 1970; if not, runs count as driven now), ``dry_run``, ``warnings``.

    Raises
    ------
    InputError
        More than 2 % of the poses lie outside, the noise is too large, or a setting or the map breaks its rule.
        Nothing is stored.
    StoreError
        Memory cannot store a run; earlier runs stay stored.
    """
    if map is None:
        raise InputError("map must be given: runs are in metres of the frame of a building's map")
    if shift is not None and not (len(shift) == 3 and np.isfinite(shift).all()):
        raise InputError(f"shift must be three numbers x, y (metres) and yaw (radians), got {shift}")
    MemorySettings(robot=robot, building=building)  # checks them
    prior = PriorSettings(weight=weight)
    settings = WorldSettings("building", map, cell=cell, robot_radius=robot_radius)
    runs = runs if shift is None else shifted_runs(runs, shift)
    occupancy = map_from_settings(settings)
    world, noise = world_from_settings(settings, occupancy), localisation_noise(runs)
    outside = checked_log(runs, Reachable.of(floor_of(occupancy, world)), noise, world.frame.cell, source)
    with _opened(memory, dry_run) as opened:
        place = recognised_place(settings, world, occupancy, opened, building)
        learnt = [_learnt(place.world, run, noise, reached_goal) for run in runs]
        competence = _competence(place.world, [one for one in learnt if one.goal is not None])
        report = log_report(place, learnt, source, outside, noise)
        report["clock"] = all(has_clock(run.time) for run in runs)
        report["competence"] = competence
        report["dry_run"] = dry_run
        # A run that was forgotten has a tombstone, and comes again under the next number.
        numbers = [opened.times_forgotten(robot, one.process) for one in learnt]
        if dry_run:
            known = (opened.is_known(robot, one.process, seq) for one, seq in zip(learnt, numbers, strict=True))
            report["new"] = len(learnt) - sum(known)
            return report
        _store_building(place, prior.alpha0, robot, opened)
        report["new"] = 0
        for done, (one, seq) in enumerate(zip(learnt, numbers, strict=True), start=1):
            records = one.records(place, prior.alpha0, weight * (competence or 0.0))
            goal = None if one.goal is None else place.world.cells[one.goal].tolist()
            task = {"run": one.run.name, "goal": goal, "world": place.world.fingerprint, "source": source}
            report["new"] += opened.contribute(robot, records, process=one.process, seq=seq, task=task)
            if progress:
                progress(done, len(learnt), f"run {one.run.name}")
    return report


def _store_building(place: Place, alpha0: float, robot: str, memory: Memory) -> None:
    """Store the building and what carries over from its earlier map; both stay if the runs are forgotten."""
    lore = Lore.recalled(place.world, alpha0, memory, place.grid)
    if records := [record for record in (*place.news, lore.model_news()) if len(record.slots)]:
        task = {"world": place.world.fingerprint}
        memory.contribute(robot, records, process=uuid4().hex, seq=0, task=task)


def forget_source(memory: Memory, source: str, robot: str | None = None) -> int:
    """Forget the runs that were learnt from a source, of one robot or of all, for ever; return their number.

    They are learnt again if `learn_from` meets them again. The map of the building stays.

    Raises
    ------
    NotFoundError
        No run was learnt from this source.
    """
    count = memory.forget_tasks(lambda by, task: task.get("source") == source and robot in (None, by))
    if not count:
        tasks = (task for name in memory.robots() for task in memory.task_descriptions(name))
        known = sorted({task["source"] for task in tasks if "source" in task})
        raise NotFoundError(
            f"source {source!r} has taught nothing here; known sources: {', '.join(known) or 'none'}"
        )
    return count


@contextmanager
def _opened(where: str | Path | None, dry_run: bool) -> Iterator[Memory]:
    """The memory; in a dry run it is only read, or an empty one that is deleted where there is none."""
    place = locate(where)
    if dry_run and isinstance(place, Path) and not place.exists():
        with TemporaryDirectory() as folder, open_memory(Path(folder) / "dry.db") as memory:
            yield memory
    else:
        with open_memory(where, read_only=dry_run) as memory:
            yield memory


def _learnt(world: GridWorld, run: Run, noise: float, reached_goal: bool) -> LearntRun:
    goal = int(world.states_at(run.points[-1:])[0])
    at_goal = run.reached_goal or (reached_goal and not run.outcome[-1])
    return LearntRun(run, tried_moves(world, run, noise), goal if at_goal and goal >= 0 else None)


def _competence(world: GridWorld, to_goal: Sequence[LearntRun]) -> float | None:
    """The robot's competence w in [0, 1] from its runs to goals; None without one."""

    @cache
    def best(goal: str) -> NDArray[np.bool_]:
        q = optimal_q(world.task(int(goal)).tables(), world.discount)
        return actions_to_count(q, "all", ended=np.arange(world.n_states) == int(goal))

    return competence_by_steps([one.demonstration(with_bumps=True) for one in to_goal], best).get(DRIVER)
