"""C4.9: what the observation models of §4.7.6 take to store.

The thesis bounds the storage of three observation models by formulas and orders them for applications with more
rewards than states. Here the models are learnt and their entries counted: in random applications with fewer and
with more rewards than states, in the telephone service, in the reserve with finely and with coarsely rounded pay,
and in Pacman. Tables as the formulas count them decide; what episodes really fill, and the bytes of files, are
reported beside them.
Thesis: §4.7.6.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_09_model_storage.stored_models import (
    RANDOM,
    REWARDS_OF,
    SIGNALS,
    application,
    stored,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate
from lifelore.interaction.library.storage_cost import StorageSizes, storage_cost

MORE, FEWER = "more_rewards_than_states", "fewer_rewards_than_states"

FULL = {
    "states": [4, 8, 16, 32],
    "rewards": [2, 4, 8, 16, 32, 64, 128],
    "rewards_of": list(REWARDS_OF),
    "draws": 10,
    "types": 4,
    "policies": 4,
    "actions": 3,
    "episodes": 40,
    "horizon": 20,
    "samples": 10,
    "models": [5, 10, 20],
    "reserves": [[17, 1], [17, 50], [68, 1], [68, 10]],
    "mazes": [[5, 3], [7, 7]],
}
QUICK = {
    **FULL,
    "states": [4, 16],
    "rewards": [2, 8, 32],
    "draws": 3,
    "episodes": 10,
    "models": [5],
    "reserves": [[17, 1], [17, 50]],
    "mazes": [[5, 3]],
}


def _check(settings: Mapping) -> None:
    for key in ("draws", "types", "policies", "actions", "episodes", "horizon", "samples"):
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")
    if not settings["states"] or not settings["rewards"] or set(settings["rewards_of"]) - set(REWARDS_OF):
        raise InputError(f"states and rewards must name sizes, and rewards_of be among {', '.join(REWARDS_OF)}")
    if min([*settings["states"], *settings["rewards"], *settings["models"]]) < 1:
        raise InputError("states, rewards and models must be at least 1")


def cells(settings: Mapping) -> list[dict]:
    """Random applications by their sizes, and each of the thesis's own."""
    random = [
        {"kind": RANDOM, "states": s, "rewards": r, "rewards_of": of}
        for of in settings["rewards_of"]
        for s in settings["states"]
        for r in settings["rewards"]
    ]
    phones = [{"kind": "telephone", "models": n} for n in settings["models"]]
    reserves = [{"kind": "surveillance", "targets": n, "resolution": step} for n, step in settings["reserves"]]
    mazes = [{"kind": "pacman", "rows": rows, "columns": columns} for rows, columns in settings["mazes"]]
    return random + phones + reserves + mazes


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Every draw of an application, learnt and counted; the thesis's own are drawn once."""
    draws = settings["draws"] if cell["kind"] == RANDOM else 1
    return {
        "cell": dict(cell),
        "stored": [stored(application(settings, cell, number, seed)) for number in range(draws)],
    }


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.c4_09_model_storage.figure_stored_models import draw_stored_models

    return draw_stored_models(result["rows"])


CLAIM = Claim(
    id="C4.9",
    title="Storage of the observation models (§4.7.6)",
    thesis="Storage is bounded by |Π| N |R| B for performance, |Π| N |S|² |A| B for immediate rewards and "
    "|Π| N |R| |S| |A| B for (s, a, s′); for |R| > |S| performance < reward < state-action-state.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.9"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes={
        "rewards below transitions": "the two formulas have changed places in print: P(r | s, a) has |S| |A| |R| "
        "entries and P(s′ | s, a) |S|² |A|",
        "performance below transitions": "with more rewards than |S|² |A| a histogram of the return is the larger",
        "printed formulas bound": "the two formulas have changed places in print",
    },
    check=_check,
)
