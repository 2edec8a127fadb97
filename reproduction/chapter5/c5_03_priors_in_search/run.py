"""C5.3: searches and bandits in noise mazes, with an action prior and without.

A cell is one maze with a held-out goal. A prior on *places* comes from other goals of the same maze, one on
*percepts* from other mazes, a goal in each; neither has met the goal in question. What is compared within a maze
meets the same starts, worlds and payoffs. A bandit here is one place of the maze: its arms are the moves, and a
pull says whether the move is on a shortest way, wrongly in some cases. Thesis: §3.8, §5.2.
"""

from collections.abc import Iterator, Mapping
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.search import bandit
from lifelore.action.search.depth_first import depth_first, iterative_deepening, preferences
from lifelore.action.search.tree_search import SearchSettings, play, search_guidance
from lifelore.core.errors import InputError
from lifelore.core.mdp import Tables
from lifelore.core.planning.planning import best_actions, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.noise_maze import noise_maze

PLACE, PERCEPT = KINDS = ("place", "percept")
TREE, BOTH = GUIDES = ("tree", "tree and rollouts")
"""Parts of the search that the prior guides; without it, rollouts are uniform."""
MOST, MEAN = "most tried", "best mean"
WAYS = ((BOTH, MOST), (TREE, MOST), (BOTH, MEAN))
"""The guided part and the move that follows a search: the default, and each choice alone made otherwise."""
PLAIN = "uniform"
PRUNED = "pruned"
UCB1, BETA, GAUSSIAN = INDICES = ("ucb1", "beta", "gaussian")
FLAT, EVEN = "flat", "even"
"""Starts of a bandit without the prior: no pseudo-counts, and as many spread evenly."""
SEARCH_FORM = "support"
ORDER_FORM = ARMS_FORM = "proportion"
"""Form whose order is pruned and deepened, and whose arms start at other strengths too."""
BLOCKS = 20
"""Points of a stored curve of regret."""


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
        **cell,
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
    tables, best = _solved(world, goal)
    lessons = {
        PLACE: [(np.arange(world.n_states), _solved(world, int(other))[1]) for other in goals],
        PERCEPT: [_percepts_elsewhere(settings, (*names, i)) for i in range(n_tasks)],
    }
    priors = {kind: ActionPrior(4, settings["alpha0"]) for kind in KINDS}
    for kind, prior in priors.items():
        for contexts, good in lessons[kind]:
            prior.update(contexts, good)
    contexts_of = {PLACE: np.arange(world.n_states), PERCEPT: world.percepts}
    probs_of = {
        (kind, form): _rows(settings, priors[kind], contexts_of[kind], form, (*names, kind))
        for kind, form in product(KINDS, settings["forms"])
    }
    return Maze(tables, best, start, starts, probs_of)


def _world(settings: Mapping, random: np.random.Generator) -> GridWorld:
    density = float(random.uniform(*settings["density"]))
    return noise_maze(random, settings["size"], density, discount=settings["discount"])


def _solved(world: GridWorld, goal: int) -> tuple[Tables, NDArray[np.bool_]]:
    tables = world.task(goal).tables()
    best = best_actions(optimal_q(tables, world.discount))
    best[goal] = False  # every action ties at the goal: nothing was chosen there
    return tables, best


def _percepts_elsewhere(settings: Mapping, names: tuple) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    random = stream(*names, "training")
    world = _world(settings, random)
    return world.percepts, _solved(world, int(random.integers(world.n_states)))[1]


def _rows(settings: Mapping, prior: ActionPrior, contexts, form: str, names: tuple) -> NDArray[np.float64]:
    """Probabilities by state; ``dirichlet`` draws θ once for each context."""
    codes, row = np.unique(contexts, return_inverse=True)
    random = stream(*names, "dirichlet")
    beta = settings["tempering"] if form == "tempered" else 1.0
    return prior.probs(codes, form, generator=random, beta=beta, escape=settings["escape"])[row]


def _searches(settings: Mapping, maze: Maze, names: tuple) -> Iterator[dict]:
    """Monte-Carlo tree search: an episode each way."""
    ways: list[tuple] = [(None, PLAIN, None, move) for move in (MOST, MEAN)]
    ways += [(*which, *way) for which, way in product(maze.probs_of, WAYS)]
    for simulations, (kind, form, guides, move) in product(settings["simulations"], ways):
        probs = None if kind is None else maze.probs_of[kind, form]
        guide = search_guidance(maze.tables, probs, rollout="prior" if guides == BOTH else "uniform")
        numbers = settings["depth"], settings["exploration"], settings["discount"]
        how = SearchSettings(simulations, *numbers, by_mean=move == MEAN)
        randoms = stream(*names, "world"), stream(*names, "search")
        played = play(maze.tables, guide, maze.start, how, settings["max_steps"], *randoms)
        about = {"kind": kind, "form": form, "guides": guides, "move": move, "simulations": simulations}
        yield {**about, "reached": played.reached, "steps": played.steps, "collisions": played.collisions}


def _depth_first_searches(settings: Mapping, maze: Maze, names: tuple) -> Iterator[dict]:
    """Depth-first search in each order, pruned and deepened in one; means over the starts."""
    flat = np.full(maze.best.shape, 1 / maze.best.shape[1])

    def means(search, probs, prune=0.0) -> dict:
        orders = (preferences(probs, stream(*names, "order", n), prune) for n in range(len(maze.starts)))
        found = [search(maze.tables, start, o) for start, o in zip(maze.starts.tolist(), orders, strict=True)]
        sums = {"expanded": [f.expanded for f in found], "reached": [f.reached for f in found]}
        sums["moves"] = [len(f.actions) for f in found]
        return {key: float(np.mean(values)) for key, values in sums.items()}

    for search_name, search in (("depth first", depth_first), ("deepening", iterative_deepening)):
        yield {"search": search_name, "kind": None, "form": PLAIN, **means(search, flat)}
        for (kind, form), probs in maze.probs_of.items():
            if search is depth_first or form == ORDER_FORM:
                yield {"search": search_name, "kind": kind, "form": form, **means(search, probs)}
    for (kind, form), probs in maze.probs_of.items():
        if form == ORDER_FORM:
            yield {"search": PRUNED, "kind": kind, "form": form, **means(depth_first, probs, settings["prune"])}


def _bandits(settings: Mapping, maze: Maze, names: tuple) -> Iterator[dict]:
    """Regret from each start of the arms, the mean over the places; its curve where it is drawn."""
    slip, horizon = settings["slip"], settings["pulls"]
    means = np.where(maze.best[maze.starts], 1 - slip, slip)
    random = stream(*names, "payoffs")
    shape = (len(means), horizon, means.shape[1])
    yes_no = (random.random(shape) < means[:, None]).astype(float)
    noise = float(np.sqrt(slip * (1 - slip)))  # as much as a payoff of yes or no has
    normal = means[:, None] + noise * random.standard_normal(shape)
    index_of = {UCB1: bandit.ucb1, BETA: bandit.beta_thompson, GAUSSIAN: bandit.gaussian_thompson(noise)}
    begun = list(_arms(settings, maze))
    every = bandit.Arms(*(np.concatenate(part) for part in zip(*(arms for _, arms in begun), strict=True)))
    at = np.unique(np.linspace(0, horizon - 1, BLOCKS).astype(int))
    for name, index in index_of.items():
        payoffs = np.tile(normal if name == GAUSSIAN else yes_no, (len(begun), 1, 1))
        pulled = bandit.play(index, every, payoffs, stream(*names, "pulls", name))
        lost = bandit.regret(pulled, np.tile(means, (len(begun), 1))).reshape(len(begun), len(means), horizon)
        for (about, _), curve in zip(begun, lost.mean(axis=1), strict=True):
            found = {"index": name, **about, "regret": float(curve[-1])}
            drawn = about["form"] in (FLAT, EVEN, ARMS_FORM) and about["strength"] in (0.0, settings["strength"])
            yield {**found, "curve": np.round(curve[at], 4).tolist()} if drawn else found


def _arms(settings: Mapping, maze: Maze) -> Iterator[tuple[dict, bandit.Arms]]:
    """Starts of the arms: pseudo-counts of the moves at each place before the first pull."""
    shape = (len(maze.starts), maze.best.shape[1])
    flat = np.full(shape, 1 / shape[1])
    strength = settings["strength"]
    yield {"kind": None, "form": FLAT, "strength": 0.0}, bandit.flat_arms(*shape)
    yield {"kind": None, "form": EVEN, "strength": strength}, bandit.prior_arms(flat, strength)
    for (kind, form), probs in maze.probs_of.items():
        other = [s for s in settings["other_strengths"] if form == ARMS_FORM]
        for pseudo_pulls in (strength, *other):
            about = {"kind": kind, "form": form, "strength": pseudo_pulls}
            yield about, bandit.prior_arms(probs[maze.starts], pseudo_pulls)


def check(settings: Mapping) -> None:
    missing = [form for form in (SEARCH_FORM, ORDER_FORM) if form not in settings["forms"]]
    if missing:
        raise InputError(f"forms must include the defaults, {SEARCH_FORM} and {ORDER_FORM}; add {missing[0]}")
    density = settings["density"]
    if density[0] > density[1]:
        raise InputError(f"density must be two shares of obstacles, rising, got {density}")
