"""C4.9: shares of applications in which one model's table is smaller than another's, and checks of formulas."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_09_model_storage.stored_models import SIGNALS
from lifelore.interaction.library.storage_cost import StorageSizes, storage_cost

MORE, FEWER = "more_rewards_than_states", "fewer_rewards_than_states"
PAIRS = {
    "performance_below_reward": ("performance", "reward"),
    "performance_below_transition": ("performance", "state-action-state"),
    "reward_below_transition": ("reward", "state-action-state"),
}
"""Tables of which the first should be smaller."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of applications in which one table is smaller than another, and how the formulas do."""
    every = [(result["cell"], found) for result in results for found in result["stored"]]
    measured = {}
    for name, side in ((MORE, 1), (FEWER, -1)):
        own = [(cell, s) for cell, s in every if np.sign(s["rewards"] - s["states"]) == side]
        answers = {key: [s["table"][a] < s["table"][b] for _, s in own] for key, (a, b) in PAIRS.items()}
        answers["printed_order"] = [_in_order(s["table"]) for _, s in own]
        for of in settings["rewards_of"]:
            filled = [_in_order(s["filled"]) for cell, s in own if cell.get("rewards_of") == of]
            answers[f"printed_order_of_filled_entries_rewards_of_{of}"] = filled
        in_files = [_in_order(s["bytes"]) for _, s in own if None not in s["bytes"].values()]
        answers["printed_order_of_file_bytes"] = in_files
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
    performance, reward, states = (entries[signal] for signal in SIGNALS)
    return performance < reward < states


def _agrees(found: Mapping, variant: str, bound: bool = False) -> float:
    """1 where the formulas give the entries of every table that was built, or at least as many."""
    sizes = StorageSizes(1, found["pairs"], found["states"], found["actions"], found["rewards"], bits=1)
    cost = storage_cost(sizes, variant)  # pyright: ignore[reportArgumentType]
    formulas = dict(zip(SIGNALS, (cost.performance, cost.reward, cost.state_action_state), strict=True))
    pairs = [(found["table"][name], formulas[name]) for name in found["built"]]
    return float(all(table <= formula if bound else table == formula for table, formula in pairs))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Each application: its sizes, and mean entries and bytes of the three models."""
    return [dict(result["cell"]) | _row(result["stored"]) for result in results]


def _row(found: Sequence[Mapping]) -> dict:
    first = found[0]
    row = {"S": first["states"], "R": first["rewards"], "A": first["actions"], "pairs": first["pairs"]}
    for key in ("table", "filled", "bytes"):
        values = {name: [s[key][name] for s in found if s[key][name] is not None] for name in SIGNALS}
        row[key] = {name: float(np.mean(of)) if of else None for name, of in values.items()}
    return row | {"built": first["built"]}
