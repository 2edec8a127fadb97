"""C4.9: entries of the tables of three observation models, once learnt. Thesis: §4.7.6.

From the same random episodes three models are learnt: of the return (a histogram with as many bins as there are
rewards, as §4.7.6 counts), of (s, a, r) and of (s, a, s′), each with a table for every type and policy.
"""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.outcome_rows import rows_of_samples
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal
from reproduction.engine.estimates import UNMEASURED, share_of

SIGNALS = ("performance", "reward", "state_action_state")


def cells(settings: Mapping) -> list[dict]:
    """Applications by their numbers of states and rewards."""
    return [{"states": s, "rewards": r} for s, r in product(settings["states"], settings["rewards"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Entries of the learnt tables, and what the formulas give, put right and as printed."""
    sizes = StorageSizes(
        settings["policies"], settings["types"], cell["states"], settings["actions"], cell["rewards"]
    )
    generator = stream(seed, "C4.9", cell["states"], cell["rewards"])
    return {
        **cell,
        "table": table_sizes(sizes, settings["episodes"], settings["horizon"], generator),
        "right": entries_of(sizes),
        "printed": entries_of(sizes, printed=True),
    }


class StorageSizes(NamedTuple):
    """Sizes of a problem, in the thesis's letters: |Π|, N, |S|, |A|, |R|."""

    n_policies: int
    n_types: int
    n_states: int
    n_actions: int
    n_rewards: int


def entries_of(sizes: StorageSizes, printed: bool = False) -> dict[str, int]:
    """Entries of each observation model's table, by `SIGNALS`.

    The distribution over next states of every state and action has |S|² |A| entries, the distribution over rewards
    |S| |A| |R|; `printed` swaps the two, as the thesis does. Its order, performance < reward < state-action-state
    for |R| > |S|, holds where |R| < |S|.
    """
    each, pairs = sizes.n_policies * sizes.n_types, sizes.n_states * sizes.n_actions
    models = [each * pairs * sizes.n_rewards, each * pairs * sizes.n_states]
    return dict(zip(SIGNALS, [each * sizes.n_rewards, *(reversed(models) if printed else models)], strict=True))


def table_sizes(
    sizes: StorageSizes, n_episodes: int, horizon: int, generator: np.random.Generator
) -> dict[str, int]:
    """Entries of the three models' tables, learnt from random walks whose steps pay random rewards."""
    n_pairs = (sizes.n_types, sizes.n_policies)
    states = generator.integers(sizes.n_states, size=(*n_pairs, n_episodes, horizon + 1))
    acts = generator.integers(sizes.n_actions, size=(*n_pairs, n_episodes, horizon))
    paid = generator.integers(sizes.n_rewards, size=acts.shape).astype(float)
    steps = np.stack([states[..., :-1], acts, states[..., 1:]], axis=-1)
    every = list(np.ndindex(*n_pairs, n_episodes))
    axes = (sizes.n_types, sizes.n_states, sizes.n_actions, sizes.n_policies)
    performance = HistogramOutcomes.from_rows(rows_of_samples(paid.sum(axis=-1)), sizes.n_rewards)
    pays = ((t, p, np.column_stack([steps[t, p, k][:, :2], paid[t, p, k]]).tolist()) for t, p, k in every)
    rewards = StepRewardSignal.from_sequences(pays, np.arange(float(sizes.n_rewards)), *axes)
    transitions = TransitionSignal.from_sequences(((t, p, steps[t, p, k]) for t, p, k in every), *axes)
    return dict(zip(SIGNALS, (performance.counts.size, rewards.n_entries, transitions.n_entries), strict=True))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of the applications with more rewards than states; of formulas the share of all tables."""
    more = [one["table"] for one in results if one["rewards"] > one["states"]]

    def share_below(first: str, second: str) -> Estimate:
        return share_of([table[first] < table[second] for table in more]) if more else UNMEASURED

    every = [(one, name) for one in results for name in SIGNALS]
    return {
        "performance_below_reward": share_below("performance", "reward"),
        "reward_below_transition": share_below("reward", "state_action_state"),
        "printed_formulas_bound": share_of([one["table"][name] <= one["printed"][name] for one, name in every]),
        "right_formulas": share_of([one["table"][name] == one["right"][name] for one, name in every]),
    }
