"""Measures and rows of claim C4.9."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_09_model_storage.stored_models import SIGNALS
from lifelore.interaction.library.storage_cost import StorageSizes, storage_cost

MORE, FEWER = "more_rewards_than_states", "fewer_rewards_than_states"


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of applications in which one table is smaller than another, and how the formulas do."""
    found = {}
    for name, side in ((MORE, 1), (FEWER, -1)):
        own = [(c, s) for c, s in _all(results) if np.sign(s["rewards"] - s["states"]) == side]
        found.update(_shares([s for _, s in own], name))
        for of in settings["rewards_of"]:
            if in_order := [_in_order(s["filled"]) for c, s in own if c.get("rewards_of") == of]:
                found[f"printed_order_of_filled_entries_rewards_of_{of}_{name}"] = mean_estimate(in_order)
        if in_order := [_in_order(s["bytes"]) for _, s in own if None not in s["bytes"].values()]:
            found[f"printed_order_of_file_bytes_{name}"] = mean_estimate(in_order)
    every = [s for _, s in _all(results)]
    found["right_formulas_equal_tables"] = mean_estimate([_agrees(s, "standard") for s in every])
    found["printed_formulas_bound_tables"] = mean_estimate([_agrees(s, "thesis", bound=True) for s in every])
    for name in SIGNALS:
        filled = [s["filled"][name] / s["table"][name] for s in every]
        found[f"share_of_table_filled_{name.replace('-', '_')}"] = mean_estimate(filled)
    return found


def _all(results: Sequence[Mapping]) -> Iterator[tuple[Mapping, Mapping]]:
    for result in results:
        for found in result["stored"]:
            yield result["cell"], found


def _shares(found: Sequence[Mapping], name: str) -> dict[str, Estimate]:
    """Shares of applications with one table smaller than another; none where there are no applications."""
    if not found:
        return {}
    tables = [[s["table"][signal] for signal in SIGNALS] for s in found]
    shares = {
        "performance_below_reward": [performance < reward for performance, reward, _ in tables],
        "performance_below_transition": [performance < states for performance, _, states in tables],
        "reward_below_transition": [reward < states for _, reward, states in tables],
        "printed_order": [_in_order(s["table"]) for s in found],
    }
    return {f"{key}_{name}": mean_estimate(np.array(share, float)) for key, share in shares.items()}


def _in_order(entries: Mapping) -> float:
    """1 where performance < reward < state-action-state, else 0."""
    performance, reward, states = (entries[signal] for signal in SIGNALS)
    return float(performance < reward < states)


def _agrees(found: Mapping, variant: str, bound: bool = False) -> float:
    """1 where the formulas give the entries of every table that was built, or at least as many."""
    sizes = StorageSizes(1, found["pairs"], found["states"], found["actions"], found["rewards"], bits=1)
    cost = storage_cost(sizes, variant)  # pyright: ignore[reportArgumentType]
    said = dict(zip(SIGNALS, (cost.performance, cost.reward, cost.state_action_state), strict=True))
    pairs = [(found["table"][name], said[name]) for name in found["built"]]
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
