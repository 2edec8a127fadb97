"""C4.8: regret saved by a larger library and by more episodes, and the share of single steps that save regret."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, difference_estimate
from reproduction.chapter4.c4_08_library_size.run import AGAINST, RULE
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN
from reproduction.engine.estimates import is_above, share_of
from reproduction.engine.results_table import ResultsTable

BOTH_WAYS = ("saved_by_size_late", "saved_by_episodes_whole")
"""What the thesis finds saved: by the whole library over all episodes, and with it by more episodes."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    table = ResultsTable(results, ("rule", "model", "share"))
    measured: dict[str, Estimate] = {}
    saves_library_regret = []
    for rule in settings["rules"]:
        for model in (LEARNT, EXACT, UNCERTAIN) if rule == RULE else (LEARNT, EXACT):
            for against in AGAINST:
                cells = (table.values(against, rule=rule, model=model, share=x)[0] for x in settings["shares"])
                found = _savings(np.stack([regret.T for regret in cells]))
                if against == "library":
                    saves_library_regret.append(all(is_above(found[name], 0.0) for name in BOTH_WAYS))
                name = f"{rule.replace(', ', '_')}_{model}" + ("" if against == "all" else "_library_regret")
                measured |= {f"{key}_{name}": number for key, number in found.items()}
    return measured | {"grid_library_regret": share_of(saves_library_regret)}


def _savings(found: np.ndarray) -> dict[str, Estimate]:
    """From the mean regret of every trial, (n_shares, n_episodes, n_trials)."""
    small, whole, mean = found[0], found[-1], found.mean(axis=2)
    return {
        "saved_by_size_early": difference_estimate(small[0], whole[0]),
        "saved_by_size_late": difference_estimate(small[-1], whole[-1]),
        "saved_by_episodes_small": difference_estimate(small[0], small[-1]),
        "saved_by_episodes_whole": difference_estimate(whole[0], whole[-1]),
        "steps_of_size": share_of((np.diff(mean, axis=0) < 0).ravel()),
        "steps_of_episodes": share_of((np.diff(mean, axis=1) < 0).ravel()),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: mean regret up to each number of episodes, its standard error, and tasks met in training."""
    found = []
    for result in results:
        row = {key: result[key] for key in ("rule", "model", "share")}
        for against in AGAINST:
            values = np.array(result[against], float)
            row[against] = values.mean(axis=0).round(3).tolist()
            row[f"{against}_error"] = (values.std(axis=0, ddof=1) / len(values) ** 0.5).round(3).tolist()
        row["share_met"] = round(float(np.mean(result["met"])), 4)
        found.append(row)
    return found
