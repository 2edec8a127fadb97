"""Learns transitions and the action prior from runs of a real robot, and stores them in memory (`learn-from`).

A run is stored once, in whatever file it comes again. Moves that a robot made and bumps become transitions of the
building. The moves of a run that reached its goal also count in the observation prior, weighted by the robot's
competence as for demonstrations (thesis §3.4.8).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.competence import competence_by_steps
from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.agent.learn_from.run_log import Run
from lifelore.agent.learn_from.tried_moves import TriedMoves, tried_moves
from lifelore.agent.live.buildings.recognition import Place, recognised_place
from lifelore.agent.live.life_settings import MemorySettings, PriorSettings
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import optimal_q
from lifelore.core.protocols import Progress
from lifelore.domains.grids.grid_world import MOVE_NAMES, GridWorld
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import Memory, open_memory

MOST_OUTSIDE, MANY_OUTSIDE = 0.5, 0.1
"""Share of poses on no place of the building from which a log is refused, and from which it gives a warning."""
MANY_CONTRADICTIONS = 0.05
"""Share of the moves that the map separates, from which a log gives a warning."""


@dataclass(frozen=True)
class LearnFromSettings:
    """Settings of `learn_from`.

    Parameters
    ----------
    world : WorldSettings
        The building, with its map.
    memory : MemorySettings
        Its `robot` is the robot that drove.
    prior : PriorSettings
        α⁰ and the weight of a run by a robot of competence 1.
    reached_goal : bool
        Take each run without an outcome goal or failed for a run that ended at its goal.
    """

    world: WorldSettings
    memory: MemorySettings = field(default_factory=MemorySettings)
    prior: PriorSettings = field(default_factory=PriorSettings)
    reached_goal: bool = False

    def __post_init__(self) -> None:
        if self.world.domain != "building" or self.world.map is None:
            raise InputError("map must be given: runs are in metres of the frame of a building's map")


@dataclass(frozen=True)
class _LearntRun:
    """A run as moves in the building; the goal is the state in which it ended, None if that is no goal."""

    run: Run
    tried: TriedMoves
    goal: int | None

    def demonstration(self, robot: str, with_bumps: bool) -> Demonstration:
        steps = np.array([self.tried.states, self.tried.actions, self.tried.targets], np.int64).reshape(3, -1)
        states, actions, targets = steps
        made = np.full(len(states), True) if with_bumps else targets != states
        return Demonstration(str(self.goal), robot, states[made], actions[made])


def learn_from(
    runs: Sequence[Run], settings: LearnFromSettings, source: str = "runs", progress: Progress | None = None
) -> dict[str, Any]:
    """Learn from runs and store what was learnt, each run in one transaction.

    Returns
    -------
    dict
        JSON data: ``source``, ``building``, ``runs``, ``new`` (runs that memory did not have), ``to_goal``,
        ``poses``, ``moves``, ``bumps``, ``new_obstacles`` (bumps where the map is free: x, y in metres of the
        cell, move), ``outside`` (poses on no place of the building), ``gaps``, ``contradictions`` (moves through
        walls of the map, not learnt), ``undirected`` (bumps without a direction, not learnt), ``competence`` (w in
        [0, 1]; None without a run to a goal), ``warnings``.

    Raises
    ------
    InputError
        Most poses lie outside the building, or a setting or the map breaks its rule. Nothing is stored.
    StoreError
        Memory cannot store a run; earlier runs stay stored.
    """
    occupancy = map_from_settings(settings.world)
    world = world_from_settings(settings.world, occupancy)
    with open_memory(settings.memory.location) as memory:
        place = recognised_place(settings.world, world, occupancy, memory, settings.memory.building)
        learnt = [_learnt(place.world, run, settings.reached_goal) for run in runs]
        report = _report(place, learnt, source)
        weights = _competence(place.world, learnt, settings.memory.robot)
        report["competence"] = weights.get(settings.memory.robot)
        report["new"] = _store(place, learnt, weights, settings, memory, progress)
    return report


def _learnt(world: GridWorld, run: Run, reached_goal: bool) -> _LearntRun:
    goal = int(world.states_at(run.points[-1:])[0])
    at_goal = run.reached_goal or (reached_goal and not run.outcome[-1])
    return _LearntRun(run, tried_moves(world, run), goal if at_goal and goal >= 0 else None)


def _competence(world: GridWorld, learnt: Sequence[_LearntRun], robot: str) -> dict[str, float]:
    @cache
    def best(goal: str) -> NDArray[np.bool_]:
        q = optimal_q(world.task(int(goal)).tables(), world.discount)
        return actions_to_count(q, "all", ended=np.arange(world.n_states) == int(goal))

    return competence_by_steps([one.demonstration(robot, True) for one in learnt if one.goal is not None], best)


def _store(
    place: Place,
    learnt: Sequence[_LearntRun],
    weights: dict[str, float],
    settings: LearnFromSettings,
    memory: Memory,
    progress: Progress | None,
) -> int:
    """Store each run; return the number of those that memory did not have."""
    scope, robot = prior_scope(place.world, "observation"), settings.memory.robot
    lore = Lore.recalled(place.world, scope, settings.prior.alpha0, memory, place.grid)
    new, unstored = 0, list(place.news)
    for done, one in enumerate(learnt, start=1):
        for state, action, target in zip(one.tried.states, one.tried.actions, one.tried.targets, strict=True):
            lore.model.target[state, action] = target
            for seen in (state, target):
                lore.model.percept[seen] = place.world.percepts[seen]
        records = [*unstored, lore.model_news()]
        if one.goal is not None:
            news = ActionPrior(len(MOVE_NAMES), settings.prior.alpha0, scope.key)
            scaled = {robot: weights[robot] * settings.prior.weight}
            shown = [one.demonstration(robot, False)]
            count_demonstrations(news, shown, lambda demonstration: scope.contexts[demonstration.states], scaled)
            records.append(news.to_record({"prior": scope.kind, "actions": list(MOVE_NAMES)}))
        records = [record for record in records if len(record.slots)]
        if memory.contribute(robot, records, process=f"run {one.run.digest}", seq=0, task=_task(place, one)):
            new, unstored = new + 1, []
        if progress:
            progress(done, len(learnt), f"run {one.run.name}")
    return new


def _task(place: Place, one: _LearntRun) -> dict[str, Any]:
    goal = None if one.goal is None else place.world.cells[one.goal].tolist()
    return {"run": one.run.name, "goal": goal, "world": place.world.fingerprint}


def _report(place: Place, learnt: Sequence[_LearntRun], source: str) -> dict[str, Any]:
    tried = [one.tried for one in learnt]
    poses, outside = sum(len(one.run.time) for one in learnt), sum(one.outside for one in tried)
    if outside > MOST_OUTSIDE * poses:
        raise InputError(
            f"{source}: {outside:,} of {poses:,} poses lie on no place of this map; record x and y in metres of "
            "the map's frame, or give the map on which the robot drove"
        )
    bumps = sum(state == target for one in tried for state, target in zip(one.states, one.targets, strict=True))
    moves = sum(len(one.states) for one in tried) - bumps
    contradictions = sum(one.contradictions for one in tried)
    report = {
        "source": source,
        "building": place.report,
        "runs": len(learnt),
        "to_goal": sum(one.goal is not None for one in learnt),
        "poses": poses,
        "moves": moves,
        "bumps": bumps,
        "new_obstacles": [
            [*(round(float(x), 3) for x in place.world.positions(np.array([state]))[0]), MOVE_NAMES[action]]
            for one in tried
            for state, action in one.new_obstacles
        ],
        "outside": outside,
        "gaps": sum(one.gaps for one in tried),
        "contradictions": contradictions,
        "undirected": sum(one.undirected for one in tried),
    }
    report["warnings"] = list(_warnings(report))
    return report


def _warnings(report: dict[str, Any]):
    if report["outside"] > MANY_OUTSIDE * report["poses"]:
        yield f"{report['outside']:,} of {report['poses']:,} poses lie on no place of this map"
    if report["contradictions"] > MANY_CONTRADICTIONS * max(report["moves"], 1):
        yield (
            f"{report['contradictions']:,} moves go through walls of the map and were not learnt; the log and the "
            "map may have different frames"
        )
    if not report["moves"]:
        yield "no move was learnt: the poses are too far apart, or the robot stayed in its cells"
    if not report["to_goal"]:
        yield "no run ended with the outcome goal, so the action prior learnt nothing"
