"""Random applications and the thesis's own, with episodes of every type and policy.

An *application* is a problem with states, actions, rewards, types and policies, whose episodes are run offline as
§4.4.1 says. Random applications set |R| against |S| freely; their rewards are either a function of (s, a, s′), as
in §4.3.1, or noisy. The telephone, the reserve and Pacman are the thesis's own; the reserve's pay is rounded, to
have levels.
"""

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import MAX_STEPS, STRATEGIES, PacmanMaze, PacmanTask, step
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.domains.telephone.telephone import PATHS, Telephone, rewards_of
from lifelore.interaction.library.offline_runs import OfflineRuns
from lifelore.interaction.library.storage_cost import StorageSizes

Array = NDArray[np.float64]
Episode = tuple[NDArray[np.int64], Array]
"""States, actions and next states (n, 3), and rewards (n,), of one episode."""
RANDOM = "random"
BRANCHES = 3
PACMAN_MOVES = 0.5
"""Share of moves that each of Pacman's four policies makes its own way; the others are random."""


class Application(NamedTuple):
    """Episodes of every type and policy.

    sizes : StorageSizes
        |Π|, N, |S|, |A| and |R|; bits of one stored number.
    rewards : (n_rewards,) float64
        All that a step may pay.
    runs : OfflineRuns
        The return of each run; its signal is the `Episode`.
    """

    sizes: StorageSizes
    rewards: Array
    runs: OfflineRuns


def with_returns(episodes: list[list[list[Episode]]]) -> OfflineRuns:
    """Episodes by type, policy and run, with the return of each."""
    returns = [[[pay.sum() for _, pay in of_policy] for of_policy in of_type] for of_type in episodes]
    return OfflineRuns(np.array(returns), episodes)


def _run_pairs(n_types: int, n_policies: int, run: Callable[[int, int], list[Episode]]) -> OfflineRuns:
    return with_returns([[run(type_, policy) for policy in range(n_policies)] for type_ in range(n_types)])


def random_application(
    generator: np.random.Generator, n_states: int, n_rewards: int, rewards_of: str, settings: Mapping
) -> Application:
    """Random dynamics for each type, `BRANCHES` successors a state and action; random policies; rewards 0, 1, …"""
    n_types, n_policies, n_actions = settings["types"], settings["policies"], settings["actions"]
    shape = (n_types, n_states, n_actions, BRANCHES)
    following = generator.integers(n_states, size=shape)
    cumulative = generator.dirichlet(np.ones(BRANCHES), shape[:3]).cumsum(axis=-1)
    paid = generator.integers(n_rewards, size=(n_types, n_states, n_actions, n_states))
    acts = generator.integers(n_actions, size=(n_policies, n_states))

    def run(type_: int, policy: int) -> list[Episode]:
        state = generator.integers(n_states, size=settings["episodes"])
        steps, rewards = [], []
        for _ in range(settings["horizon"]):
            act = acts[policy, state]
            branch = (generator.random(len(state))[:, None] >= cumulative[type_, state, act][:, :-1]).sum(axis=1)
            after = following[type_, state, act, branch]
            pay = paid[type_, state, act, after]
            if rewards_of == "noise":
                noise = generator.normal(0, 0.1 * n_rewards, len(state)).round().astype(np.int64)
                pay = np.clip(pay + noise, 0, n_rewards - 1)
            steps.append(np.stack([state, act, after], axis=1))
            rewards.append(pay.astype(np.float64))
            state = after
        return list(zip(np.stack(steps, axis=1), np.stack(rewards, axis=1), strict=True))

    sizes = StorageSizes(n_policies, n_types, n_states, n_actions, n_rewards)
    return Application(sizes, np.arange(n_rewards, dtype=float), _run_pairs(n_types, n_policies, run))


def telephone_application(generator: np.random.Generator, n_models: int, samples: int) -> Application:
    """Calls of every caller with every language model; a policy has one action."""
    phone = Telephone(n_models)
    every = [np.array([(s, 0, s2) for s, s2 in pairwise(path)]) for path in PATHS]
    paid = [np.array(rewards_of(path)) for path in PATHS]
    rewards = np.unique(np.concatenate(paid))

    def run(type_: int, policy: int) -> list[Episode]:
        calls = phone.sample(generator, np.full(samples, type_), policy)
        return [(every[call], paid[call]) for call in calls]

    sizes = StorageSizes(n_models, n_models, phone.transition_probs.shape[-1], 1, len(rewards))
    return Application(sizes, rewards, _run_pairs(n_models, n_models, run))


def reserve_application(
    generator: np.random.Generator, n_targets: int, resolution: float, samples: int
) -> Application:
    """Deployments from the base (state 0) to the first `n_targets` targets (states 1, 2, …), pay rounded."""
    world = Surveillance()
    pays = world.training_samples(generator, samples)[:n_targets, :n_targets]
    levels = np.round(pays / resolution).astype(np.int64)
    rewards = np.arange(levels.min(), levels.max() + 1) * resolution

    def run(type_: int, policy: int) -> list[Episode]:
        flight = np.array([(0, 0, policy + 1)])
        return [(flight, np.array([rewards[level - levels.min()]])) for level in levels[type_, policy]]

    sizes = StorageSizes(n_targets, n_targets, n_targets + 1, 1, len(rewards))
    return Application(sizes, rewards, _run_pairs(n_targets, n_targets, run))


def pacman_application(generator: np.random.Generator, rows: int, columns: int, samples: int) -> Application:
    """Episodes of four policies, each fond of one direction, against every ghost; states are observations."""
    maze = PacmanMaze(rows, columns)
    foods = maze.draw_foods(generator)
    tasks = [PacmanTask(maze, foods, strategy) for strategy in STRATEGIES]

    def run(type_: int, policy: int) -> list[Episode]:
        return [_pacman_episode(tasks[type_], policy, generator) for _ in range(samples)]

    runs = _run_pairs(len(tasks), 4, run)
    rewards = np.unique(np.concatenate([pay for _, _, (_, pay) in runs.sequences()]))
    sizes = StorageSizes(4, len(tasks), tasks[0].n_observations, 4, len(rewards))
    return Application(sizes, rewards, runs)


def _pacman_episode(task: PacmanTask, policy: int, generator: np.random.Generator) -> Episode:
    state, seen = int(generator.choice(task.starts)), task.observation_of
    steps, rewards, event = [], [], 0
    while not event & 1 and len(steps) < MAX_STEPS:
        act = policy if generator.random() < PACMAN_MOVES else int(generator.integers(4))
        after, reward, event = step(task.params, state, act, generator.random())
        steps.append((seen[state], act, seen[after]))
        rewards.append(reward)
        state = int(after)
    return np.array(steps, np.int64), np.array(rewards)


def application(settings: Mapping, cell: Mapping, number: int, seed: int) -> Application:
    """The application of a cell, its `number`-th draw."""
    generator = stream(seed, "C4.9", *(f"{key} {value}" for key, value in cell.items()), number)
    kind, samples = cell["kind"], settings["samples"]
    if kind == "telephone":
        return telephone_application(generator, cell["models"], samples)
    if kind == "surveillance":
        return reserve_application(generator, cell["targets"], cell["resolution"], samples)
    if kind == "pacman":
        return pacman_application(generator, cell["rows"], cell["columns"], samples)
    return random_application(generator, cell["states"], cell["rewards"], cell["rewards_of"], settings)
