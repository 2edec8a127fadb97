"""C3.2: on the lattice, Q-learning with a state prior from 10 tasks against plain Q-learning.

The thesis leaves open how ties are broken in the greedy step, how ε is annealed, the pseudo-count α⁰ and the
form of the prior. All of them are crossed here: that grid is the answer, and one stated default its headline.
Thesis: §3.4.1, Figure 3.3.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.action_prior import FORMS
from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.grids.lattice import lattice
from lifelore.experiments.chapter3.c3_02_lattice_prior.lattice_grid import PLAIN, cells, configurations, run_cell
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.learning_settings import check_counts, check_learning, check_windows
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "size": 23,
    "discount": 0.95,
    "runs": 50,
    "training_tasks": 10,
    "test_tasks": 10,
    "episodes": 1000,
    "max_steps": 1000,
    "learning_rate": 0.5,
    "window": 10,
    "last": 100,
    "ties": ["uniform", "prior"],
    "schedules": [[0.1, 1.0, 0.1], [1.0, 0.98, 0.01], [1.0, 0.995, 0.01]],
    "alpha0": [0.01, 0.1, 1.0],
    "forms": ["proportion", "dirichlet", "support", "softmax"],
    "online_tasks": [0, 1, 2, 5, 10, 35],
    "default": {"ties": "uniform", "schedule": [1.0, 0.98, 0.01], "alpha0": 0.1, "form": "proportion"},
}
QUICK = {
    **FULL,
    "size": 9,
    "runs": 4,
    "training_tasks": 5,
    "test_tasks": 3,
    "episodes": 120,
    "max_steps": 200,
    "last": 20,
    "online_tasks": [0, 1, 5],
}


CAUSES = {
    "faster": "counts from ten goals pull exploration to the middle of the lattice, so that goals elsewhere are "
    "found late: the form `support`, which keeps only what was ever useful, is not slower, and at a constant ε, "
    "where the schedule is no brake, every form is faster with uniform ties",
    "most of the grid": "the two halves hold in different cells: the first return is positive where nearly every "
    "step follows the prior (ε starts at 1, or ties are broken by the prior) and α⁰ is small, 80 % comes sooner "
    "where few steps do; ties broken by the prior stall learning",
}


def _check(settings: Mapping) -> None:
    _check_sizes(settings)
    check_learning(settings)
    default = settings["default"]
    unknown = set(settings["forms"]) - set(FORMS)
    if unknown:
        raise InputError(f"forms must be among {', '.join(FORMS)}, got {', '.join(map(str, unknown))}")
    in_grid = (
        default.get("ties") in settings["ties"]
        and default.get("form") in settings["forms"]
        and default.get("alpha0") in settings["alpha0"]
        and default.get("schedule") in settings["schedules"]
    )
    if not in_grid:
        raise InputError(f"default must be a cell of the grid of ties, schedules, alpha0 and forms, got {default}")
    if settings["training_tasks"] not in settings["online_tasks"] or 0 not in settings["online_tasks"]:
        raise InputError(
            f"online_tasks must contain 0 and training_tasks ({settings['training_tasks']}), "
            f"got {settings['online_tasks']}"
        )


def _methods(results: Sequence[Mapping], schedule, how: Mapping) -> list[Mapping]:
    """One configuration under one schedule, run by run."""
    keys = ("ties", "alpha0", "form")
    return [
        method
        for result in results
        if result["kind"] == "grid" and result["schedule"] == schedule
        for method in result["methods"]
        if all(method[key] == how[key] for key in keys)
    ]


def _column(methods: Sequence[Mapping], key: str) -> np.ndarray:
    return np.array([method[key] for method in methods], float)


def _check_sizes(settings: Mapping) -> None:
    check_counts(settings, ("runs", "training_tasks", "test_tasks", "episodes", "max_steps", "window", "last"))
    check_windows(settings, ("window", "last"))
    n_states = lattice(settings["size"], settings["discount"]).n_states
    for key in ("test_tasks", "online_tasks"):
        if np.max(settings[key]) > n_states:
            raise InputError(f"{key} must be at most the {n_states} cells that can be goals, got {settings[key]}")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The headline at the default, the shares of the grid, and the online series."""
    return {
        **_headline(settings, results),
        **_grid_shares(settings, results),
        **_online_measures(settings, [r for r in results if r["kind"] == "online"]),
    }


def _headline(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    default = settings["default"]
    found = {}
    methods = {
        "q_learning": _methods(results, default["schedule"], PLAIN),
        "eps_qsap": _methods(results, default["schedule"], default),
    }
    for name, of_runs in methods.items():
        for key in ("first", "first_ten", "to_50", "to_80", "never_80", "final"):
            found[f"{key}_{name}"] = mean_estimate(_column(of_runs, key))
    for key in ("to_50", "to_80"):
        both = [_column(methods[name], key) for name in ("eps_qsap", "q_learning")]
        found[f"{key}_ratio"] = ratio_estimate(*both)
    optimal = [r["optimal"] for r in results if r["kind"] == "grid" and r["schedule"] == default["schedule"]]
    found["optimal_return"] = mean_estimate(optimal)
    return found


def _grid_shares(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of the grid's cells in which the two halves of the claim hold, each by its interval."""
    grid = [row for row in _grid_rows(settings, results) if row["form"]]
    positive = np.array([_beyond(row["first"], above=0.0) for row in grid])
    faster = np.array([_beyond(row["to_80_ratio"], below=1.0) for row in grid])
    shares = {"positive_at_once": positive, "faster_to_80": faster, "both": positive & faster}
    return {
        f"grid_{name}": Estimate(float(share.mean()), float(np.median(share)), None, len(share))
        for name, share in shares.items()
    }


def _beyond(number: Mapping, above: float | None = None, below: float | None = None) -> bool:
    if number["ci95"] is None:
        return False
    low, high = number["ci95"]
    return low > above if above is not None else high < below


def _online_measures(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    plain = np.array([r["plain"] for r in results])
    optimal = np.array([r["optimal"] for r in results])
    gain = {
        (source, n): np.array([r["first_ten"][f"{source}_{n}"] for r in results]) - plain
        for source in ("learnt", "exact")
        for n in settings["online_tasks"]
    }
    found = {f"online_gain_after_{n}_{source}": mean_estimate(g) for (source, n), g in gain.items()}
    all_of_it = settings["training_tasks"]
    lost = (gain["learnt", all_of_it] - gain["exact", all_of_it]) / optimal
    found["online_minus_exact_of_optimal"] = mean_estimate(lost)
    found["q_learning_is_uniform_prior"] = mean_estimate([float(r["same"]) for r in results])
    return found


def _grid_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    found = []
    for schedule in settings["schedules"]:
        plain = _methods(results, schedule, PLAIN)
        for how in (PLAIN, *configurations(settings)):
            methods = _methods(results, schedule, how)
            row = {"schedule": schedule, **how}
            for key in ("first", "first_ten", "to_50", "to_80", "final"):
                row[key] = mean_estimate(_column(methods, key)).to_dict()
            row["never_80"] = int(_column(methods, "never_80").sum())
            ratio = ratio_estimate(_column(methods, "to_80"), _column(plain, "to_80"))
            row["to_80_ratio"] = ratio.to_dict()
            found.append(row)
    return found


def _curve_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean curves with 95 % intervals (t, over runs) in blocks of episodes."""
    from scipy.stats import t

    edges = block_edges(settings["episodes"])
    found = [{"curve_edges": edges.tolist()}]
    hows = [PLAIN, *({**settings["default"], "ties": ties} for ties in settings["ties"])]
    for schedule in settings["schedules"]:
        for how in hows:
            curves = np.array([m["curve"] for m in _methods(results, schedule, how)])
            mean, n = curves.mean(axis=0), len(curves)
            half = t.ppf(0.975, n - 1) * curves.std(axis=0, ddof=1) / np.sqrt(n) if n > 1 else 0 * mean
            name = {key: how[key] for key in ("ties", "alpha0", "form")}
            curve = {"mean": mean.tolist(), "low": (mean - half).tolist(), "high": (mean + half).tolist()}
            found.append({"curve_of": name, "schedule": schedule, **curve})
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default's form and α⁰."""
    return _grid_rows(settings, results) + _curve_rows(settings, results)


def _draw(result: Mapping):
    from lifelore.figures.prior_grid import draw_prior_grid

    return draw_prior_grid(result)


CLAIM = Claim(
    id="C3.2",
    title="Q-learning with a state prior on the lattice (Figure 3.3)",
    thesis="In the 23×23 lattice, with a prior from 10 tasks, ε-QSAP receives positive return at once and reaches "
    "80 % of the optimal return in fewer episodes than Q-learning, over 10 test tasks; accumulated online it has "
    "no advantage at first and all of it after 10 tasks; Q-learning is ε-QSAP with a uniform prior.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.2"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
