"""Sizes of observation models of three signals, learnt in random applications and in the thesis's own.

An *application* is a problem with states, actions, rewards, types and policies, whose episodes are run offline as
§4.4.1 says. From the same episodes three models are learnt: of the return (a histogram with as many bins as there
are rewards, as §4.7.6 counts), of (s, a, r) and of (s, a, s′), each with a table for every type and policy.
Counted are the entries of the tables, those that any episode filled, and the bytes of the library's file.

Random applications set |R| against |S| freely; their rewards are either a function of (s, a, s′), as in §4.3.1, or
noisy. The telephone, the reserve and Pacman are the thesis's own; the reserve's pay is rounded, to have levels.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import MAX_STEPS, STRATEGIES, PacmanMaze, PacmanTask, step
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.domains.telephone.telephone import PATHS, Telephone, rewards_of
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.storage_cost import StorageSizes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.outcome_model import rows_of_samples
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal

Array = NDArray[np.float64]
Episode = tuple[NDArray[np.int64], Array]
"""States, actions and next states (n, 3), and rewards (n,), of one episode."""

SIGNALS = ("performance", "reward", "state-action-state")
RANDOM = "random"
REWARDS_OF = ("transition", "noise")
MOST_ENTRIES = 4_000_000
"""Tables of more entries are not built; their number follows from the sizes, as for those that are built."""
BRANCHES = 3
PACMAN_MOVES = 0.5
"""Share of moves that each of Pacman's four policies makes its own way; the others are random."""


@dataclass(frozen=True)
class Application:
    """Episodes of every type and policy.

    sizes : StorageSizes
        |Π|, N, |S|, |A| and |R|; bits of one stored number.
    rewards : (n_rewards,) float64
        All that a step may pay.
    episodes : list by type, policy and run
    """

    sizes: StorageSizes
    rewards: Array
    episodes: list[list[list[Episode]]]

    def sequences(self) -> Iterator[tuple[int, int, Episode]]:
        """Every episode with its type and policy."""
        for type_, of_type in enumerate(self.episodes):
            for policy, of_policy in enumerate(of_type):
                for episode in of_policy:
                    yield type_, policy, episode


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
    return Application(sizes, np.arange(n_rewards, dtype=float), _run_all(n_types, n_policies, run))


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
    return Application(sizes, rewards, _run_all(n_models, n_models, run))


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
    return Application(sizes, rewards, _run_all(n_targets, n_targets, run))


def pacman_application(generator: np.random.Generator, rows: int, columns: int, samples: int) -> Application:
    """Episodes of four policies, each fond of one direction, against every ghost; states are observations."""
    maze = PacmanMaze(rows, columns)
    foods = maze.draw_foods(generator)
    tasks = [PacmanTask(maze, foods, strategy) for strategy in STRATEGIES]

    def run(type_: int, policy: int) -> list[Episode]:
        return [_pacman_episode(tasks[type_], policy, generator) for _ in range(samples)]

    episodes = _run_all(len(tasks), 4, run)
    rewards = np.unique(np.concatenate([pay for of_type in episodes for runs in of_type for _, pay in runs]))
    sizes = StorageSizes(4, len(tasks), tasks[0].n_observations, 4, len(rewards))
    return Application(sizes, rewards, episodes)


def _pacman_episode(task: PacmanTask, policy: int, generator: np.random.Generator) -> Episode:
    params, seen = task.params, task.observation_of
    state = int(generator.choice(task.starts))
    steps, rewards, event = [], [], 0
    while not event & 1 and len(steps) < MAX_STEPS:
        act = policy if generator.random() < PACMAN_MOVES else int(generator.integers(4))
        after, reward, event = step(params, state, act, generator.random())
        steps.append((seen[state], act, seen[after]))
        rewards.append(reward)
        state = int(after)
    return np.array(steps, np.int64), np.array(rewards)


def _run_all(n_types: int, n_policies: int, run) -> list[list[list[Episode]]]:
    return [[run(type_, policy) for policy in range(n_policies)] for type_ in range(n_types)]


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


def stored(found: Application) -> dict:
    """Entries and bytes of the three learnt models of an application.

    ``table``: numbers in the model's table; ``filled``: cells of it that an episode filled; ``bytes``: of the
    library's file with this signal, None where the table is too large to build.
    """
    sizes = found.sizes
    returns = _returns(found)
    models = {
        "performance": HistogramOutcomes.from_rows(rows_of_samples(returns), sizes.n_rewards),
        "reward": _rewards_learnt(found) if _entries(sizes, "reward") <= MOST_ENTRIES else None,
        "state-action-state": _transitions_learnt(found)
        if _entries(sizes, "state-action-state") <= MOST_ENTRIES
        else None,
    }
    filled = _filled(found, returns)
    table = {name: _entries(sizes, name) if model is None else _stored(model) for name, model in models.items()}
    return {
        "states": sizes.n_states,
        "rewards": sizes.n_rewards,
        "actions": sizes.n_actions,
        "pairs": sizes.n_types * sizes.n_policies,
        "table": table,
        "filled": filled,
        "bytes": {name: None if model is None else _bytes(model, returns) for name, model in models.items()},
        "built": [name for name, model in models.items() if model is not None],
    }


def _entries(sizes: StorageSizes, name: str) -> int:
    """Entries of a table by its axes."""
    inner = {
        "performance": sizes.n_rewards,
        "reward": sizes.n_states * sizes.n_actions * sizes.n_rewards,
        "state-action-state": sizes.n_states**2 * sizes.n_actions,
    }
    return sizes.n_types * sizes.n_policies * inner[name]


def _stored(model) -> int:
    return model.counts.size if isinstance(model, HistogramOutcomes) else model.n_entries


def _returns(found: Application) -> Array:
    return np.array([[[pay.sum() for _, pay in runs] for runs in of_type] for of_type in found.episodes])


def _rewards_learnt(found: Application) -> StepRewardSignal:
    sizes = found.sizes
    steps = (
        (type_, policy, [(s, a, r) for (s, a, _), r in zip(rows.tolist(), pay.tolist(), strict=True)])
        for type_, policy, (rows, pay) in found.sequences()
    )
    return StepRewardSignal.from_sequences(
        steps, found.rewards, sizes.n_types, sizes.n_states, sizes.n_actions, n_policies=sizes.n_policies
    )


def _transitions_learnt(found: Application) -> TransitionSignal:
    sizes = found.sizes
    steps = ((type_, policy, rows) for type_, policy, (rows, _) in found.sequences())
    return TransitionSignal.from_sequences(
        steps, sizes.n_types, sizes.n_states, sizes.n_actions, n_policies=sizes.n_policies
    )


def _filled(found: Application, returns: Array) -> dict[str, int]:
    """Number of cells of each table that the episodes filled; of the performance, different returns."""
    rewards: set[tuple] = set()
    states: set[tuple] = set()
    for type_, policy, (rows, pay) in found.sequences():
        for (s, a, after), reward in zip(rows.tolist(), pay.tolist(), strict=True):
            rewards.add((type_, policy, s, a, reward))
            states.add((type_, policy, s, a, after))
    values = sum(len(np.unique(runs)) for of_type in returns for runs in of_type)
    return {"performance": values, "reward": len(rewards), "state-action-state": len(states)}


def _bytes(model, returns: Array) -> int:
    """Bytes of the library's file with this signal."""
    if isinstance(model, HistogramOutcomes):
        return len(PolicyLibrary(model).to_bytes())
    return len(PolicyLibrary.from_samples(returns, signal=model).to_bytes())
