"""C5.4: early regret in the second half of lives, and its ratios between priors."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter5.c5_04_learnt_type_prior.run import (
    AGENTS,
    CONTEXT,
    LEARNT,
    LIBRARY,
    NO_DECAY,
    TRUE,
    WORLDS,
)

BLOCKS = 20
"""Parts of a life in the curves of the rows."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Mean early regret of each agent in each world, and ratios, paired by life."""
    found: dict[str, Estimate] = {}
    for world in WORLDS:
        late = {
            result["agent"]: np.array(result["early"])[:, settings["tasks"] // 2 :].mean(axis=1)
            for result in results
            if result["world"] == world
        }
        for agent in AGENTS:
            found[f"early_regret_{agent.replace(' ', '_')}_{world}"] = mean_estimate(late[agent])
        for agent in (LEARNT, CONTEXT, TRUE):
            found[f"{agent}_over_library_{world}"] = ratio_estimate(late[agent], late[LIBRARY])
        found[f"decay_over_none_{world}"] = ratio_estimate(late[CONTEXT], late[NO_DECAY])
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row an agent and world: mean early regret over lives in parts of the life, with its standard error."""
    found = []
    for result in results:
        early = np.array(result["early"])
        parts = np.array_split(early, min(BLOCKS, early.shape[1]), axis=1)
        means = np.array([part.mean(axis=1) for part in parts])
        error = means.std(axis=1, ddof=1) / len(early) ** 0.5 if len(early) > 1 else np.zeros(len(means))
        found.append(
            {"world": result["world"], "agent": result["agent"],
             "mean": means.mean(axis=1).round(2).tolist(), "error": error.round(2).tolist()}
        )  # fmt: skip
    return found
