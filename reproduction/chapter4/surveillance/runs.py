"""Policy reuse and its peers in the surveillance reserve, for C4.5 to C4.8.

Tasks come in groups of the thesis's number, ten. A group has tasks and noise of its own and, where models are
learnt, a library of its own; all methods of a comparison meet the same groups. Regret is expected library regret;
`realised` is the regret of one draw of the chosen policy's pay against another draw of the best policy's.

Rules know exact models, or models learnt from `samples` deployments a pair, and observe the pay of each
deployment; `peers.GIVEN` states what peers know. No method knows where the poachers are.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import NOISES, Surveillance
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.regret import library_regret
from reproduction.chapter4.reuse import many_tasks
from reproduction.chapter4.reuse.many_tasks import (
    EXACT,
    LEARNT,
    UNCERTAIN,
    grouped_mean,
    grouped_quantile,
)
from reproduction.chapter4.reuse.rules import NEAR_GREEDY, RULES_SHOWN
from reproduction.chapter4.surveillance.peers import kernel_of, make_peer, tuning_grid
from reproduction.engine.estimates import exact_share

Array = NDArray[np.float64]
SEEN, MIXED = "seen", "with unseen"
CASES = {
    "headline": {"model": LEARNT, "tasks": MIXED},
    "learnt": {"model": LEARNT, "tasks": SEEN},
    "exact": {"model": EXACT, "tasks": SEEN},
    "exact, with unseen": {"model": EXACT, "tasks": MIXED},
    "uncertain": {"model": UNCERTAIN, "tasks": SEEN},
    "uncertain, with unseen": {"model": UNCERTAIN, "tasks": MIXED},
}
"""The models and the tasks of a case: `MIXED` puts every second task's poachers at a cell that is no target."""
DOUBTING = ("uncertain", "uncertain, with unseen")
"""The cases whose rules doubt the models that those of "learnt" and "headline" take for the truth."""
DEFAULT_WORLD = {"layout": "X", "metric": "chebyshev", "noise": "deviation 20"}
RULES = RULES_SHOWN | NEAR_GREEDY


class Tasks(NamedTuple):
    """Tasks of one group.

    mean : (n_tasks, 68) float64, expected pay of each policy
    noise : (n_tasks, n_episodes) float64, standard normal, of the pay in each episode
    other_noise : (n_tasks, n_episodes) float64, of the best policy's pay that realised regret compares with
    seen : (n_tasks,) bool, whether the poachers are at a target
    """

    mean: Array
    noise: Array
    other_noise: Array
    seen: NDArray[np.bool_]


def check_reserves(settings: Mapping) -> None:
    """Refuse settings whose grid of reserves lacks the default."""
    for key, default in DEFAULT_WORLD.items():
        if default not in settings[f"{key}s"]:
            raise InputError(f"{key}s must include the default, {default}")


def worlds(settings: Mapping) -> list[dict[str, str]]:
    """Every reserve of the grid."""
    every = product(*(settings[f"{key}s"] for key in DEFAULT_WORLD))
    return [dict(zip(DEFAULT_WORLD, choices, strict=True)) for choices in every]


def reserve_cells(
    settings: Mapping, cases: Iterable[str], methods: Iterable[str], in_grid: Iterable[str]
) -> list[dict]:
    """`methods` in all `cases` of the default reserve; `in_grid`, with exact models on targets, in every other."""
    cells = [(name, case, DEFAULT_WORLD, settings["groups"]) for case, name in product(cases, methods)]
    others = [world for world in worlds(settings) if world != DEFAULT_WORLD]
    cells += [(name, "exact", world, settings["grid_groups"]) for world, name in product(others, in_grid)]
    return [{"method": name, "case": case, **world, "groups": groups} for name, case, world, groups in cells]


def draw_tasks(world: Surveillance, kind: str, n: int, n_episodes: int, seed: int, group: int) -> Tasks:
    """One group's tasks: the same places in the order of targets for every reserve, and the same noise."""
    generator = stream(seed, "tasks", group)
    cells = world.draw_cells(generator, n)
    seen = np.ones(n, bool)
    if kind == MIXED:
        seen[1::2] = False
        near = world.cells_near_hills
        unseen = near[(near[:, None] != world.targets).any(axis=-1).all(axis=1)]
        cells[~seen] = unseen[generator.integers(len(unseen), size=(~seen).sum())]
    noise = stream(seed, "noise", group).standard_normal((2, n, n_episodes))
    return Tasks(world.mean_at(cells), noise[0], noise[1], seen)


def library_of(world: Surveillance, model: str, samples: int, seed: int, group: int) -> PolicyLibrary:
    """Exact models, or Gaussian ones with shrunk deviations from `samples` deployments a pair."""
    if model == EXACT:
        return PolicyLibrary.from_means(world.mean, world.deviation)
    training = world.training_samples(stream(seed, "training deployments", group), samples)
    return PolicyLibrary.from_samples(training)


def play(
    name: str,
    library: PolicyLibrary,
    world: Surveillance,
    tasks: Tasks,
    generator: np.random.Generator,
    tuned: Mapping[str, float] | None = None,
    kernel: Array | None = None,
    doubting: tuple | None = None,
) -> tuple[NDArray[np.int64], Array | None]:
    """Policies that a rule or peer chooses, (n_tasks, n_episodes), and the belief's entropy where there is one.

    `doubting` names the streams of agents that doubt their models; None where models are taken for the truth.
    """
    n_tasks, n_episodes = tasks.noise.shape
    every = np.arange(n_tasks)

    def pays(episode: int, policies: NDArray[np.int64]) -> Array:
        return tasks.mean[every, policies] + world.deviation * tasks.noise[:, episode]

    if doubting is not None:
        played = many_tasks.play_doubting(RULES[name], library, pays, n_tasks, n_episodes, doubting)
        return played.policies, played.entropy
    if name in RULES:
        played = many_tasks.play_rule(RULES[name], library, pays, n_tasks, n_episodes, generator)
        return played.policies, played.entropy
    peer = make_peer(name, library, world, n_tasks, n_episodes, generator, kernel, **(tuned or {}))
    return many_tasks.play_baseline(peer, pays, n_episodes), None


def run_method(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """A rule or peer on all groups of one case and reserve.

    `cell`: ``method``, ``case``, ``layout``, ``metric``, ``noise``, ``groups``. Returns ``curve`` and
    ``entropy`` by episode; of every task ``sums``, ``ended`` and ``late``; ``at``, ``against_mean`` and
    ``realised`` regret after the episodes of ``settings["after"]``; ``seen``; and ``tuned``, the settings of
    least regret where there were some to choose.
    """
    name, case = cell["method"], CASES[cell["case"]]
    world = Surveillance(cell["layout"], cell["metric"], NOISES[cell["noise"]])
    size = (settings["tasks"], settings["episodes"])
    groups = [draw_tasks(world, case["tasks"], *size, seed, group) for group in range(cell["groups"])]
    tasks = Tasks(*(np.concatenate(arrays) for arrays in zip(*groups, strict=True)))
    batches = [tasks] if case["model"] == EXACT else groups
    libraries = [library_of(world, case["model"], settings["samples"], seed, g) for g in range(len(batches))]
    kernels = [kernel_of(name, library) for library in libraries]
    best: dict = {}
    for tuned in tuning_grid(name):
        played = []
        for group, (library, batch, kernel) in enumerate(zip(libraries, batches, kernels, strict=True)):
            doubting = (seed, "doubting", name, group) if case["model"] == UNCERTAIN else None
            generator = stream(seed, "chooser", name, group)
            played.append(play(name, library, world, batch, generator, tuned, kernel, doubting))
        found = _regrets(settings, world, tasks, np.concatenate([policies for policies, _ in played]))
        entropies = [entropy for _, entropy in played if entropy is not None]
        if entropies:
            found["entropy"] = np.concatenate(entropies).mean(axis=0).round(4).tolist()
        if not best or np.mean(found["sums"]) < np.mean(best["sums"]):
            best = {**found, "tuned": tuned}
    return {**cell, **best}


def _regrets(settings: Mapping, world: Surveillance, tasks: Tasks, policies: NDArray) -> dict:
    expected = library_regret(tasks.mean, policies)
    against_mean = expected - world.deviation * tasks.noise
    realised = against_mean + world.deviation * tasks.other_noise
    readings = {"at": expected, "against_mean": against_mean, "realised": realised}
    after = [k for k in settings["after"] if k <= expected.shape[1]]
    return {
        "curve": many_tasks.curve(expected),
        "sums": expected.sum(axis=1).round(2).tolist(),
        "ended": many_tasks.converged_after(expected).tolist(),
        "late": many_tasks.late_regret(expected).round(3).tolist(),
        "seen": tasks.seen.astype(int).tolist(),
        **{key: {str(k): regret[:, k - 1].round(2).tolist() for k in after} for key, regret in readings.items()},
    }


def by_group(result: Mapping, key: str) -> Array:
    """Numbers of every task, (n_groups, n_tasks)."""
    return np.array(result[key], float).reshape(result["groups"], -1)


def summary(result: Mapping) -> dict[str, Estimate]:
    """Sum of regret, when it ended (median and p90), regret late on (median), and the share of stuck tasks."""
    ended, late = by_group(result, "ended"), by_group(result, "late")
    stuck = late > many_tasks.STUCK
    own_models = CASES[result["case"]]["model"] == EXACT
    return {
        "cumulative": grouped_mean(by_group(result, "sums")),
        "ended_median": grouped_quantile(ended, 0.5),
        "ended_p90": grouped_quantile(ended, 0.9),
        "late_median": grouped_quantile(late, 0.5),
        "stuck": exact_share(stuck.ravel().tolist()) if own_models else grouped_mean(stuck),
    }


def row_of(result: Mapping) -> dict:
    """The keys of a cell and its summary, as rows hold them."""
    return {key: result[key] for key in ("method", "case", *DEFAULT_WORLD)} | many_tasks.plain(summary(result))


def by_seen(result: Mapping) -> dict[str, Estimate]:
    """Summed regret and share of stuck tasks, of tasks at targets and of others where there are some."""
    found, late = {}, by_group(result, "late") > many_tasks.STUCK
    sums, seen = by_group(result, "sums"), by_group(result, "seen") > 0
    for word, which in (("seen", seen), ("unseen", ~seen)):
        if which.any():
            # Every group has as many tasks of each kind.
            own = [values[which].reshape(len(sums), -1) for values in (sums, late)]
            found |= {f"cumulative_{word}": grouped_mean(own[0]), f"stuck_{word}": grouped_mean(own[1])}
    return found


def is_default(row: Mapping) -> bool:
    """Whether a row is of the default reserve."""
    return DEFAULT_WORLD.items() <= row.items()


def find(results: Sequence[Mapping], method: str, case: str, **world: str) -> Mapping:
    """The result of a method in a case and reserve, by default the default reserve."""
    wanted = {"method": method, "case": case, **DEFAULT_WORLD, **world}
    return next(result for result in results if wanted.items() <= result.items())


def name_of(method: str, case: str) -> str:
    """A method and a case in the name of a measure."""
    plain = f"{method}_{case}".replace("κ", "kappa")
    return plain.replace(", ", "_").replace(" ", "_").replace("-", "_")
