"""Advises agents with unknown goals step by step, from the walks of experts in the same world (`lifelore advise`).

Thesis: §3.7.
"""

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from lifelore.action.advice.advice import WatchedAgent
from lifelore.action.advice.advisor import BETTER, AdviceSettings, Advisor
from lifelore.action.advice.agent_classes import ClassAdvisor, classes_with_goals
from lifelore.action.advice.behaviour_models import Behaviour, Tabulated
from lifelore.action.advice.goal_model import GoalModel, Trajectory, extend_goal_models
from lifelore.agent.advise.expert_trajectories import goal_models, goals_of_ends, state_after, trajectories
from lifelore.agent.advise.step_lines import NO_ACTION, StepLine, read_classes, read_steps, state_number
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.json_lines import Lines, lines_of, read_objects
from lifelore.domains.advice.explorers import EXPLORERS, explorer_probs
from lifelore.domains.grids.grid_world import MOVES, GridWorld
from lifelore.domains.worlds import WorldSettings, domain_names, world_from_settings

METHODS = ("better", "thesis", "classes")


@dataclass(frozen=True)
class AdviseSettings:
    """The world, the experts, and when to advise.

    Parameters
    ----------
    world : str
        A ROS map (YAML), or a world's name and seed, ``"advice:3"``.
    experts : str
        File of JSON lines, see `step_lines`.
    goals : str, optional
        File of JSON lines ``{"state": …}``; default: the ends of the experts' walks, near ends joined.
    method : {"better", "thesis", "classes"}
        One goal at a time, dropping goals that the agent has passed; one prior over all goals (§3.7.1); or one
        goal at a time by class of agent, which the lines of the experts name (``"class": "staff"``).
    kappa : float
        Least gain of advice, κ, in nats.
    window : int
        Number of last steps of an agent that count as evidence.
    share : float, optional
        Largest share of an agent's steps that are advised; default 0.4, and no limit for ``thesis``.
    cell, robot_radius : float, optional
        Metres, for maps: 0.5 and 0.2.
    shown : str, optional
        Method ``classes``: the class of agents whose lines show none, by a uniform or a name tag.
    """

    world: str
    experts: str
    goals: str | None = None
    method: str = "better"
    kappa: float = 0.5
    window: int = 300
    share: float | None = None
    cell: float | None = None
    robot_radius: float | None = None
    shown: str | None = None

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise NotFoundError(f"method must be one of {', '.join(METHODS)}, got '{self.method}'")
        if self.shown is not None and self.method != "classes":
            raise InputError(
                f"shown applies to method classes, got '{self.shown}' for {self.method}; leave it out"
            )


class _Known(NamedTuple):
    """An agent that steps: its evidence, the class that it showed last, and whether it is advised now."""

    agent: WatchedAgent
    shown: str | None
    advised: bool


class AdviceSession:
    """Gives advice step by step, for any number of agents at the same time.

    Parameters
    ----------
    settings : AdviseSettings

    Attributes
    ----------
    world : GridWorld
    goals : list of int
        States of the goals that advice leads to.
    n_experts : int
        Number of expert walks.
    classes : tuple of str
        Classes of the experts, with method ``classes``; else none.
    """

    def __init__(self, settings: AdviseSettings) -> None:
        self.world = world_of(settings)
        experts = settings.experts
        walks = trajectories(read_steps(lines_of(experts), self.world, experts), self.world)
        if not walks:
            raise InputError(f"{experts} must hold at least one step with an action, got none")
        self.n_experts = len(walks)
        self.goals = _goals(settings, walks, self.world)
        self.classes: tuple[str, ...] = ()
        self._class_advisor: ClassAdvisor | None = None
        # By the class that an agent shows; None: no class.
        self._advisors: dict[str | None, Advisor] = {}
        if settings.method == "classes":
            known = self._class_advisor = _class_advisor(settings, self.goals, self.world)
            self.classes = known.names
            self._advisors |= {name: known.showing(name) for name in known.names}
            self._advisors[None] = self._advisors[settings.shown] if settings.shown else known.advisor
        else:
            self._advisors[None] = _advisor(settings, walks, self.goals, self.world)
        self._agents: dict[str | int, _Known] = {}

    def answer(self, step: StepLine) -> dict[str, Any]:
        """Advice for the agent in the state after its step; see `advise`."""
        known = self._agents.get(step.agent) or _Known(self._advisors[None].watch(), None, False)
        shown = step.shown or known.shown
        agent, advisor = known.agent, self._advisors[shown]
        if step.action != NO_ACTION:
            advisor.observe(agent, step.state, step.action, known.advised)
        advice = advisor.consider(agent, state_after(self.world, step))
        self._agents[step.agent] = _Known(agent, shown, advice.advise)
        answer = {
            "agent": step.agent,
            "advise": advice.advise,
            "theta": advice.theta.tolist() if advice.theta.any() else None,
            "p_normal": advice.p_normal,
            "gain": advice.gain,
        }
        if self._class_advisor is not None:
            answer["classes"] = self._class_advisor.probs(agent)
        return answer


def advise(lines: Lines, settings: AdviseSettings, name: str = "input") -> Iterator[dict[str, Any]]:
    """Advice for each line ``{"agent", "state", "action"}``, as soon as the line arrives.

    With method ``classes`` a line may show the agent's ``class``, which holds until it shows another.

    Yields
    ------
    dict
        ``agent``; ``advise``, whether to advise the agent now; ``theta``, the advised probabilities of the moves
        (north, south, east, west) in the state after its step, None where no expert was; ``p_normal``, P(M | H)
        of the experts' models; ``gain`` of the advice in nats; with method ``classes`` also ``classes``, the
        probability of each.

    Raises
    ------
    InputError
        A file or line breaks its rule; the message names the line.
    NotFoundError
        The world or a file does not exist.
    """
    desk = AdviceSession(settings)
    for step in read_steps(lines, desk.world, name, desk.classes):
        yield desk.answer(step)


def world_of(settings: AdviseSettings) -> GridWorld:
    """The world of a map, or of a world's name and seed."""
    return world_from_settings(world_settings(settings))


def world_settings(settings: AdviseSettings) -> WorldSettings:
    """The settings of the world of a map, or of a world's name and seed.

    Raises
    ------
    InputError, NotFoundError
        The seed is no number, or no world has this name.
    """
    if settings.world.endswith((".yaml", ".yml")) or os.sep in settings.world:
        return WorldSettings("building", settings.world, settings.cell, settings.robot_radius)
    domain, _, seed = settings.world.partition(":")
    if not seed.isdecimal() and ":" in settings.world:
        raise InputError(f"world must be a map's YAML, or NAME:SEED with a whole number, got '{settings.world}'")
    if domain not in domain_names():
        raise NotFoundError(f"world must be a map's YAML or one of {', '.join(domain_names())}, got '{domain}'")
    return WorldSettings(domain, None, settings.cell, settings.robot_radius, seed=int(seed or 0))


def _goals(settings: AdviseSettings, walks: list[Trajectory], world: GridWorld) -> list[int]:
    if settings.goals is None:
        return goals_of_ends(walks, world)
    goals, name = [], settings.goals
    for number, document in read_objects(lines_of(name), name):
        try:
            goals.append(state_number(document, world))
        except InputError as error:
            raise InputError(f"{name} line {number}: {error}") from None
    if not goals:
        raise InputError(f"{name} must name at least one goal, got none")
    return sorted(set(goals))


def _advisor(settings: AdviseSettings, walks: list[Trajectory], goals: list[int], world: GridWorld) -> Advisor:
    chosen = _advice_settings(settings)
    if settings.method == "thesis":
        return Advisor.of_thesis([GoalModel.from_trajectories(walks, world.n_states, len(MOVES))], chosen)
    models = extend_goal_models(goal_models(walks, goals, world), world.neighbour)
    return Advisor(models, non_expert_models(world, [model.goals[0] for model in models]), chosen)


def _class_advisor(settings: AdviseSettings, goals: list[int], world: GridWorld) -> ClassAdvisor:
    """Goal models of each class, classes by name."""
    name = settings.experts
    class_of = read_classes(lines_of(name), name)
    steps = list(read_steps(lines_of(name), world, name))
    names = sorted(set(class_of.values()))
    if settings.shown is not None and settings.shown not in names:
        raise NotFoundError(f"shown must be a class of the experts, {', '.join(names)}, got '{settings.shown}'")
    experts: dict[str, list[GoalModel]] = {}
    for name in names:
        walks = trajectories((step for step in steps if class_of[step.agent] == name), world)
        experts[name] = goal_models(walks, goals, world)
    ends = [model.goals[0] for models in experts.values() for model in models]
    others = non_expert_models(world, ends)
    return classes_with_goals(experts, world.neighbour, _advice_settings(settings), others=others)


def _advice_settings(settings: AdviseSettings) -> AdviceSettings:
    base = AdviceSettings() if settings.method == "thesis" else BETTER
    chosen = replace(base, kappa=settings.kappa, window=settings.window)
    if settings.share is not None:
        chosen = replace(chosen, share=settings.share)
    return chosen


def non_expert_models(world: GridWorld, goals: list[int]) -> list[Behaviour | list[Behaviour]]:
    """Models of agents that do not know the paths: the explorers, and a bug algorithm for each goal."""
    without_goal = [Tabulated(explorer_probs(world, explorer)) for explorer in EXPLORERS if explorer != "bug"]
    return [*without_goal, [Tabulated(explorer_probs(world, "bug", goal)) for goal in goals]]
