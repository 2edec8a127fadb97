"""C4.9: shares of applications in which one model's table is smaller than another's, and checks of formulas."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.interaction.library.storage_cost import StorageSizes, storage_cost
from reproduction.chapter4.c4_09_model_storage.stored_models import (
    PERFORMANCE,
    REWARD,
    SIGNALS,
    TRANSITION,
)

PAIRS = {
    "performance_below_reward": (PERFORMANCE, REWARD),
    "performance_below_transition": (PERFORMANCE, TRANSITION),
    "reward_below_transition": (REWARD, TRANSITION),
}
"""Tables of which the first should be smaller."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    every = [(result["cell"], found) for result in results for found in result["stored"]]
    measured = {}
    for side, name in ((1, "more_rewards_than_states"), (-1, "fewer_rewards_than_states")):
        own = [(cell, s) for cell, s in every if np.sign(s["rewards"] - s["states"]) == side]
        answers = {key: [s["table"][a] < s["table"][b] for _, s in own] for key, (a, b) in PAIRS.items()}
        answers["printed_order"] = [_in_order(s["table"]) for _, s in own]
        for of in settings["rewards_of"]:
            filled = [_in_order(s["filled"]) for cell, s in own if cell.get("rewards_of") == of]
            answers[f"printed_order_of_filled_entries_rewards_of_{of}"] = filled
        in_bytes = (s["bytes"] for _, s in own if None not in s["bytes"].values())
        answers["printed_order_of_array_bytes"] = [_in_order(size) for size in in_bytes]
        measured |= {
            f"{key}_{name}": mean_estimate(np.array(some, float)) for key, some in answers.items() if some
        }
    stored = [s for _, s in every]
    measured["right_formulas_equal_tables"] = mean_estimate([_agrees(s, "standard") for s in stored])
    measured["printed_formulas_bound_tables"] = mean_estimate([_agrees(s, "thesis", bound=True) for s in stored])
    for name in SIGNALS:
        share = [s["filled"][name] / s["table"][name] for s in stored]
        measured[f"share_of_table_filled_{name.replace('-', '_')}"] = mean_estimate(share)
    return measured


def _in_order(entries: Mapping) -> bool:
    """Whether performance < reward < state-action-state."""
    return entries[PERFORMANCE] < entries[REWARD] < entries[TRANSITION]


def _agrees(found: Mapping, variant: str, bound: bool = False) -> float:
    """1 where the formulas give the entries of every table that was built, or at least as many."""
    sizes = StorageSizes(1, found["pairs"], found["states"], found["actions"], found["rewards"], bits=1)
    cost = storage_cost(sizes, variant)  # pyright: ignore[reportArgumentType]
    formulas = dict(zip(SIGNALS, (cost.performance, cost.reward, cost.state_action_state), strict=True))
    pairs = [(found["table"][name], formulas[name]) for name in found["built"]]
    return float(all(table <= formula if bound else table == formula for table, formula in pairs))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Each application: its sizes, and mean entries and bytes of arrays of the three models."""
    found = []
    for result in results:
        draws, first = result["stored"], result["stored"][0]
        row = {"S": first["states"], "R": first["rewards"], "A": first["actions"], "pairs": first["pairs"]}
        for key in ("table", "filled", "bytes"):
            values = {name: [draw[key][name] for draw in draws] for name in SIGNALS}
            row[key] = {name: None if None in each else float(np.mean(each)) for name, each in values.items()}
        found.append(dict(result["cell"]) | row | {"built": first["built"]})
    return found
