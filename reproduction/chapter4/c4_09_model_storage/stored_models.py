"""Sizes of observation models of three signals, learnt from the episodes of an application.

From the same episodes three models are learnt: of the return (a histogram with as many bins as there are rewards,
as §4.7.6 counts), of (s, a, r) and of (s, a, s′), each with a table for every type and policy. Counted are the
entries of the tables, those that any episode filled, and the bytes of each model's arrays. A compressed file would
also depend on the last bits of numbers, which differ between processors.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.outcome_model import rows_of_samples
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal
from reproduction.chapter4.c4_09_model_storage.applications import Application

PERFORMANCE, REWARD, TRANSITION = SIGNALS = ("performance", "reward", "state-action-state")
MOST_ENTRIES = 4_000_000
"""Tables of more entries are not built; their number follows from the sizes, as for those that are built."""


class StoredModel(Protocol):
    """A model that can be written into a file."""

    def to_arrays(self) -> dict[str, NDArray[Any]]: ...


def stored(found: Application) -> dict:
    """Entries and bytes of the three learnt models of an application.

    ``table``: numbers in the model's table; ``filled``: cells of it that an episode filled, of the performance
    different returns; ``bytes``: of the model's arrays, None where the table is too large to build.
    """
    sizes, returns = found.sizes, found.runs.outcomes
    pairs, steps = sizes.n_types * sizes.n_policies, sizes.n_states * sizes.n_actions
    table = {
        PERFORMANCE: pairs * sizes.n_rewards,
        REWARD: pairs * steps * sizes.n_rewards,
        TRANSITION: pairs * steps * sizes.n_states,
    }
    performance = HistogramOutcomes.from_rows(rows_of_samples(returns), sizes.n_rewards)
    signals = {name: _learnt(found, name) for name in (REWARD, TRANSITION) if table[name] <= MOST_ENTRIES}
    table |= {PERFORMANCE: performance.counts.size} | {name: model.n_entries for name, model in signals.items()}
    size = {name: array_bytes(model) for name, model in {PERFORMANCE: performance, **signals}.items()}
    return {
        "states": sizes.n_states,
        "rewards": sizes.n_rewards,
        "actions": sizes.n_actions,
        "pairs": pairs,
        "table": table,
        "filled": _filled(found),
        "bytes": {name: size.get(name) for name in SIGNALS},
        "built": list(size),
    }


def array_bytes(model: StoredModel) -> int:
    """Bytes of a model's arrays, not compressed."""
    return sum(array.nbytes for array in model.to_arrays().values())


def _learnt(found: Application, name: str) -> StepRewardSignal | TransitionSignal:
    """The model of (s, a, r) or of (s, a, s′)."""
    sizes, sequences = found.sizes, found.runs.sequences()
    axes = (sizes.n_types, sizes.n_states, sizes.n_actions, sizes.n_policies)
    if name == TRANSITION:
        return TransitionSignal.from_sequences(((t, p, rows) for t, p, (rows, _) in sequences), *axes)
    paid = ((t, p, np.column_stack([rows[:, :2], pay]).tolist()) for t, p, (rows, pay) in sequences)
    return StepRewardSignal.from_sequences(paid, found.rewards, *axes)


def _filled(found: Application) -> dict[str, int]:
    """Number of cells of each table that the episodes filled; of the performance, different returns."""
    values = sum(len(np.unique(of_pair)) for of_type in found.runs.outcomes for of_pair in of_type)
    rewards: set[tuple] = set()
    states: set[tuple] = set()
    for type_, policy, (rows, pay) in found.runs.sequences():
        for (s, a, after), reward in zip(rows.tolist(), pay.tolist(), strict=True):
            rewards.add((type_, policy, s, a, reward))
            states.add((type_, policy, s, a, after))
    return {PERFORMANCE: values, REWARD: len(rewards), TRANSITION: len(states)}
