"""C5.4: lives of tasks whose types are popular by Zipf's law, under five priors. Thesis: §5.2.

Lives run side by side, task by task: all agents of a life meet the same contexts, types and noise. Early regret
is that of a task's first episodes; it is judged in the second half of the life.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.types.type_prior import HALF_LIVES, TypePrior
from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.beliefs.belief import log_prior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.regret import library_regret
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.selection import default_rule

Array = NDArray[np.float64]

STEADY, CONTEXTS, DRIFT = "steady", "contexts", "drift"
WORLDS = (STEADY, CONTEXTS, DRIFT)
LIBRARY, LEARNT, CONTEXT, NO_DECAY, TRUE = "library", "learnt", "context", "no decay", "true"
AGENTS = (LIBRARY, LEARNT, CONTEXT, NO_DECAY, TRUE)
"""The prior of each agent: the library's, learnt in all contexts alike, learnt by context, that without decay,
and the true popularity."""


def cells(settings: Mapping) -> list[dict]:
    """Every agent in every world of tasks."""
    return [{"world": world, "agent": agent} for world in WORLDS for agent in AGENTS]


def popularity(settings: Mapping, world: str, n_types: int, random: np.random.Generator) -> Array:
    """Probability of each type, (n_tasks, n_contexts, n_types), in one life."""
    shape = settings["tasks"], settings["contexts"], n_types
    exponent = settings["exponent" if world == STEADY else "exponent_in_context"]
    by_rank: Array = np.arange(1.0, n_types + 1) ** -exponent
    by_rank /= by_rank.sum()
    if world == STEADY:
        return np.broadcast_to(by_rank[random.permutation(n_types)], shape)
    every = settings["steady_for"] if world == DRIFT else settings["tasks"]
    spans = -(-settings["tasks"] // every)
    orders = np.array([[random.permutation(n_types) for _ in range(shape[1])] for _ in range(spans)])
    return by_rank[orders][np.arange(settings["tasks"]) // every]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Early regret of each task of each life, (n_lives, n_tasks)."""
    reserve = Surveillance()
    library = PolicyLibrary.from_means(reserve.mean, reserve.deviation)
    n_lives, n_tasks, n_episodes = settings["lives"], settings["tasks"], settings["episodes"]
    contexts = np.empty((n_lives, n_tasks), np.int64)
    types, popular = np.empty_like(contexts), np.empty((n_lives, n_tasks, library.n_types))
    noise = np.empty((n_lives, n_tasks, n_episodes))
    for life in range(n_lives):
        random = stream(seed, "C5.4", "life", cell["world"], life)
        contexts[life] = random.integers(settings["contexts"], size=n_tasks)
        everywhere = popularity(settings, cell["world"], library.n_types, random)
        popular[life] = everywhere[np.arange(n_tasks), contexts[life]]
        below = popular[life].cumsum(axis=1) < random.random(n_tasks)[:, None]
        types[life] = np.minimum(below.sum(axis=1), library.n_types - 1)
        noise[life] = random.standard_normal((n_tasks, n_episodes))
    half_lives = (np.inf,) if cell["agent"] == NO_DECAY else HALF_LIVES
    learnt = [TypePrior(library.prior, half_lives=half_lives) for _ in range(n_lives)]
    reuse = ReuseAlgorithm(library, n_lives, dynamics=TypeDynamics.static(), models="plug-in")
    rule, every = default_rule(library), np.arange(n_lives)
    generator = stream(seed, "C5.4", "chooser", cell["world"])
    early = np.empty((n_lives, n_tasks))
    for task in range(n_tasks):
        date = task // settings["tasks_a_date"]
        seen = np.zeros(n_lives, np.int64) if cell["agent"] == LEARNT else contexts[:, task]
        if cell["agent"] == LIBRARY:
            priors = np.tile(library.prior, (n_lives, 1))
        elif cell["agent"] == TRUE:
            priors = popular[:, task]
        else:
            priors = np.array([own.prior(int(c), date) for own, c in zip(learnt, seen, strict=True)])
        reuse.log_belief[:] = log_prior(priors)
        mean = reserve.mean[types[:, task]]
        policies = np.empty((n_lives, n_episodes), np.int64)
        for t in range(n_episodes):
            policies[:, t], _ = reuse.select(every, rule, generator)
            pays = mean[every, policies[:, t]] + reserve.deviation * noise[:, task, t]
            reuse.update(every, policies[:, t], pays)
        if cell["agent"] not in (LIBRARY, TRUE):
            for own, context, belief in zip(learnt, seen, reuse.belief(every), strict=True):
                own.learn(int(context), belief / belief.sum(), date)
        early[:, task] = library_regret(mean, policies)[:, : min(settings["early"], n_episodes)].sum(axis=1)
    return {**cell, "early": early.round(3).tolist()}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Ratios of early regret, paired by life."""

    def ratio(world: str, agent: str, other: str) -> Estimate:
        late = {
            result["agent"]: np.array(result["early"])[:, settings["tasks"] // 2 :].mean(axis=1)
            for result in results
            if result["world"] == world
        }
        return ratio_estimate(late[agent], late[other])

    return {
        "learnt_over_library_steady": ratio(STEADY, LEARNT, LIBRARY),
        "context_over_learnt_contexts": ratio(CONTEXTS, CONTEXT, LEARNT),
        "decay_over_none_drift": ratio(DRIFT, CONTEXT, NO_DECAY),
        "decay_over_none_steady": ratio(STEADY, CONTEXT, NO_DECAY),
    }
