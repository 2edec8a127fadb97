"""C5.3: searches and bandits in noise mazes, with an action prior and without.

A cell is one maze with a held-out goal. A prior on *places* comes from other goals of the same maze, one on
*percepts* from other mazes, a goal in each; neither has met the goal in question. What is compared within a maze
meets the same starts, worlds and payoffs. Searches know the maze. A bandit here is one place of the maze: its arms
are the moves, and a pull says whether the move is on a shortest way, wrongly in some cases. Thesis: §3.8, §5.2.

Bandits are UCB1 and Thompson sampling, many problems at once. An action prior gives the probability that
each action is useful in a context. It enters as pseudo-pulls of every arm whose mean payoff is that probability.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.search.depth_first import depth_first, preferences
from lifelore.action.search.tree_search import SearchSettings, play, search_guidance
from lifelore.core.mdp import Tables
from lifelore.core.metrics import Estimate, difference_estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.noise_maze import noise_maze
from lifelore.interaction.baselines.arm_statistics import ArmBaseline, ArmStatistics
from lifelore.interaction.baselines.ucb1 import UCB1
from reproduction.chapter3.learning.grid_tasks import problem_of
from reproduction.engine.records import nested, values_of


class BetaThompson(ArmBaseline):
    """Thompson sampling of payoffs in {0, 1}: an arm's value is drawn from Beta(1 + paid, 1 + not paid)."""

    name: ClassVar[str] = "beta"

    def __init__(self, n_policies: int, **common: Any) -> None:
        super().__init__(n_policies, **common)
        self.arms = ArmStatistics.empty(self.rows, n_policies)

    def _scores(self) -> NDArray[np.float64]:
        paid = self.arms.pulls * self.arms.mean
        return self._generator.beta(1 + paid, 1 + np.maximum(self.arms.pulls - paid, 0.0))


BANDITS: dict[str, type[UCB1] | type[BetaThompson]] = {"ucb1": UCB1, "beta": BetaThompson}


def regret(
    name: str,
    theta: NDArray[np.float64],
    strength: ArrayLike,
    payoffs: NDArray[np.float64],
    means: NDArray[np.float64],
    generator: np.random.Generator,
) -> NDArray[np.float64]:
    """Regret of each problem over all pulls, (n_problems,): best mean payoff less that of the arm pulled, summed.

    Parameters
    ----------
    name : str
        Of `BANDITS`.
    theta : (n_problems, n_arms) float
        Mean payoff of the pseudo-pulls.
    strength : float or (n_problems, 1) float
        Pseudo-pulls of every arm; 0 for none.
    payoffs : (n_problems, n_pulls, n_arms) float
        Payoff of each arm at each pull, in {0, 1}.
    means : (n_problems, n_arms) float
        True mean payoff of each arm.
    generator : numpy generator
        Serves draws and ties.
    """
    player = BANDITS[name](theta.shape[1], n_tasks=len(theta), seed=generator)
    player.arms.pulls[:], player.arms.mean[:] = strength, theta
    every, lost = np.arange(len(theta)), np.zeros(len(theta))
    for paid in payoffs.swapaxes(0, 1):
        arm = player.select()
        player.update(arm, paid[every, arm])
        lost += means.max(axis=1) - means[every, arm]
    return lost


PLACE, PERCEPT = KINDS = ("place", "percept")
FORMS = ("proportion", "dirichlet", "softmax", "support")
GUIDES = ("tree and rollouts", "tree")
"""Parts of the search that the prior guides; without it, rollouts are uniform."""
ORDERS = ("preferred", "pruned")
"""Preferred actions first; or only those that the prior does not exclude, and all of them where that fails."""
DEFAULT = {"kind": PLACE, "form": "proportion"}
"""The thesis's prior over states, as the proportion of counts."""
NONE = {"kind": None, "form": "uniform"}
EVEN = {"kind": None, "form": "even"}
"""Without a prior; and for bandits, as many pseudo-pulls spread evenly."""


class Maze(NamedTuple):
    """One test: tables of the held-out goal, its best actions, the start, more starts, and the priors' rows.

    `probs_of` maps (kind, form) to the (n_states, n_actions) probabilities that the states read.
    """

    tables: Tables
    best: NDArray[np.bool_]
    start: int
    starts: NDArray[np.int64]
    probs_of: dict[tuple[str, str], NDArray[np.float64]]


def cells(settings: Mapping) -> list[dict]:
    """A maze each."""
    return [{"maze": number} for number in range(settings["mazes"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: every search and every bandit in it."""
    names = (seed, "C5.3", cell["maze"])
    maze = maze_of(settings, names)
    return {
        "search": list(_searches(settings, maze, names)),
        "depth_first": list(_depth_first_searches(settings, maze, names)),
        "bandit": list(_bandits(settings, maze, names)),
    }


def maze_of(settings: Mapping, names: tuple) -> Maze:
    """The maze of the streams `names`; more training tasks leave it as it is."""
    random = stream(*names, "test")
    world, n_tasks = _world(settings, random), settings["training_tasks"]
    goal, start = (int(state) for state in random.choice(world.n_states, 2, replace=False))
    others = np.delete(np.arange(world.n_states), goal)
    starts = random.choice(others, settings["starts"])
    goals = random.permutation(others)[:n_tasks]
    problem = problem_of(world, goal, ())
    lessons = {
        PLACE: [(np.arange(world.n_states), problem_of(world, int(other), ()).best) for other in goals],
        PERCEPT: [_percepts_elsewhere(settings, (*names, i)) for i in range(n_tasks)],
    }
    priors = {kind: ActionPrior(4, settings["alpha0"]) for kind in KINDS}
    for kind, prior in priors.items():
        for contexts, good in lessons[kind]:
            prior.update(contexts, good)
    contexts_of = {PLACE: np.arange(world.n_states), PERCEPT: world.percepts}
    probs_of = {
        (kind, form): _rows(settings, priors[kind], contexts_of[kind], form, (*names, kind))
        for kind, form in product(KINDS, FORMS)
    }
    return Maze(problem.tables, problem.best, start, starts, probs_of)


def _world(settings: Mapping, random: np.random.Generator) -> GridWorld:
    density = float(random.uniform(*sorted(settings["density"])))
    return noise_maze(random, settings["size"], density, discount=settings["discount"])


def _percepts_elsewhere(settings: Mapping, names: tuple) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    random = stream(*names, "training")
    world = _world(settings, random)
    return world.percepts, problem_of(world, int(random.integers(world.n_states)), ()).best


def _rows(settings: Mapping, prior: ActionPrior, contexts, form: str, names: tuple) -> NDArray[np.float64]:
    """Probabilities by state; ``dirichlet`` draws θ once for each context."""
    codes, row = np.unique(contexts, return_inverse=True)
    random = stream(*names, "dirichlet")
    return prior.probs(codes, form, generator=random, escape=settings["escape"])[row]


def _searches(settings: Mapping, maze: Maze, names: tuple) -> Iterator[dict]:
    """Monte-Carlo tree search: whether an episode reaches the goal, without a prior and each way with one."""
    numbers = (settings[name] for name in ("simulations", "depth", "exploration", "discount"))
    how = SearchSettings(*numbers)

    def reached(probs, guides: str) -> bool:
        guide = search_guidance(maze.tables, probs, rollout="prior" if guides == GUIDES[0] else "uniform")
        randoms = stream(*names, "world"), stream(*names, "search")
        return play(maze.tables, guide, maze.start, how, settings["max_steps"], *randoms).reached

    yield {**NONE, "guides": None, "reached": reached(None, GUIDES[1])}
    for ((kind, form), probs), guides in product(maze.probs_of.items(), GUIDES):
        yield {"kind": kind, "form": form, "guides": guides, "reached": reached(probs, guides)}


def _depth_first_searches(settings: Mapping, maze: Maze, names: tuple) -> Iterator[dict]:
    """Nodes that depth-first search expands in each order, the mean over the starts."""

    def expanded(probs, prune: float = 0.0) -> tuple[NDArray, NDArray]:
        orders = (preferences(probs, stream(*names, "order", n), prune) for n in range(len(maze.starts)))
        found = [depth_first(maze.tables, start, o) for start, o in zip(maze.starts.tolist(), orders, strict=True)]
        return np.array([f.expanded for f in found]), np.array([f.reached for f in found])

    plain, _ = expanded(np.full(maze.best.shape, 1 / maze.best.shape[1]))
    yield {**NONE, "order": None, "expanded": float(plain.mean())}
    for (kind, form), probs in maze.probs_of.items():
        for order, prune in zip(ORDERS, (0.0, settings["prune"]), strict=True):
            nodes, reached = expanded(probs, prune)
            mean = float(np.where(reached, nodes, nodes + plain).mean())
            yield {"kind": kind, "form": form, "order": order, "expanded": mean}


def _bandits(settings: Mapping, maze: Maze, names: tuple) -> Iterator[dict]:
    """Regret from each start of the arms, the mean over the places."""
    slip, horizon = settings["slip"], settings["pulls"]
    means = np.where(maze.best[maze.starts], 1 - slip, slip)
    payoffs = (stream(*names, "payoffs").random((len(means), horizon, means.shape[1])) < means[:, None]).astype(
        float
    )
    begun = list(_arms(settings, maze))
    theta = np.concatenate([theta for _, theta, _ in begun])
    strength = np.repeat([strength for *_, strength in begun], len(means))[:, None]
    luck, mean = np.tile(payoffs, (len(begun), 1, 1)), np.tile(means, (len(begun), 1))
    for name in BANDITS:
        lost = regret(name, theta, strength, luck, mean, stream(*names, "pulls", name))
        for (about, *_), own in zip(begun, lost.reshape(len(begun), -1).mean(axis=1), strict=True):
            yield {"index": name, **about, "regret": float(own)}


def _arms(settings: Mapping, maze: Maze) -> Iterator[tuple[dict, NDArray[np.float64], float]]:
    """Starts of the arms: mean payoffs and number of the pseudo-pulls of the moves at each place."""
    shape = (len(maze.starts), maze.best.shape[1])
    yield NONE, np.zeros(shape), 0.0
    yield EVEN, np.full(shape, 1 / shape[1]), settings["strength"]
    for (kind, form), probs in maze.probs_of.items():
        yield {"kind": kind, "form": form}, probs[maze.starts], settings["strength"]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Gain of tree search, ratio of nodes, ratios of regret, paired by maze; at the default."""
    return {
        "search_gain": _gain(results, DEFAULT, GUIDES[0]),
        "nodes_ratio": _nodes_ratio(results, DEFAULT, ORDERS[0]),
        **{f"{index}_ratio": _regret_ratio(results, index, DEFAULT) for index in BANDITS},
        **{f"{index}_even_ratio": _regret_ratio(results, index, DEFAULT, EVEN) for index in BANDITS},
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for every kind and form of the prior, part of the search that it guides, and use of its order."""
    for kind, form in product(KINDS, FORMS):
        prior = {"kind": kind, "form": form}
        for guides in GUIDES:
            yield {**prior, "guides": guides}, {"search_gain": _gain(results, prior, guides)}
        for use in ORDERS:
            yield {**prior, "order": use}, {"nodes_ratio": _nodes_ratio(results, prior, use)}
        yield prior, {f"{index}_ratio": _regret_ratio(results, index, prior) for index in BANDITS}


def _gain(results: Sequence[Mapping], prior: Mapping, guides: str) -> Estimate:
    found, ways = nested(results, "search"), ({**prior, "guides": guides}, {**NONE, "guides": None})
    return difference_estimate(*(values_of(found, "reached", **way) for way in ways))


def _nodes_ratio(results: Sequence[Mapping], prior: Mapping, order: str) -> Estimate:
    found, ways = nested(results, "depth_first"), ({**prior, "order": order}, {**NONE, "order": None})
    return ratio_estimate(*(values_of(found, "expanded", **way) for way in ways))


def _regret_ratio(results: Sequence[Mapping], index: str, prior: Mapping, other: Mapping = NONE) -> Estimate:
    found = nested(results, "bandit")
    return ratio_estimate(*(values_of(found, "regret", index=index, **way) for way in (prior, other)))
