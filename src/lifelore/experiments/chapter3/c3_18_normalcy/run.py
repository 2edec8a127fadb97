"""C3.18: advice raises P(M₁ | H), the probability that an explorer acts as the experts do.

Partly so by construction: an advised step is drawn from θ, which is M₁. So it is measured three times: all steps
in H, as the thesis does; H of the agent's own steps alone; and all steps in H, read only where no advice was
given. The last is chosen by what it measures: no advice is given where P(M₁ | H) is high.
Thesis: §3.7.2.3, Figure 3.21.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.domains.advice.explorers import EXPLORERS
from lifelore.experiments.chapter3.advice_estimates import (
    at,
    check_grid,
    grid_of,
    is_positive,
    maze_estimate,
    picked,
    plain,
    share_of_grid,
)
from lifelore.experiments.chapter3.advice_grid import GRID, SMALL, maze_cells
from lifelore.experiments.chapter3.advised_explorers import run_normalcy_cell
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import UNMEASURED
from lifelore.experiments.engine.predicate import Predicate

FULL = {**GRID, "mazes": 16, "tasks": 20, "max_steps": 5000, "blocks": 50}
QUICK = {**FULL, **SMALL, "mazes": 3, "tasks": 4, "max_steps": 300, "blocks": 10}
READINGS = ("told", "own", "unadvised")
"""All steps in H; only the agent's own; all in H, read where no advice was given."""
CAUSES = {
    "own steps raised": "an explorer of fixed policy chooses its own steps as before: what they gain comes of "
    "where advice has moved it, and random motion is alike everywhere",
    "raised": "where nearly every step seems an expert's already, there is nothing to raise",
}


def _check(settings: Mapping) -> None:
    check_grid(settings, ("tasks", "max_steps", "blocks"))
    if settings["max_steps"] % settings["blocks"]:
        raise InputError(f"blocks must divide max_steps ({settings['max_steps']}), got {settings['blocks']}")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: P(M₁ | H) of each explorer alone and told, by every reading; how many rise; the grid."""
    default = settings["default"]
    cells, experts = at(results, default["loops"]), default["experts"]
    found = {}
    for agent in EXPLORERS:
        entries = _entries(cells, experts, agent)
        for reading in ("alone", *READINGS):
            found[f"normal_{reading}_{agent}"] = _mean(entries, reading)
        for reading in READINGS:
            found[f"gain_{reading}_{agent}"] = _gain(entries, reading)
        found[f"advised_{agent}"] = maze_estimate([100 * np.mean(e["advised_share"]) for e in entries])
    for reading, name in zip(READINGS, ("", "_own", "_unadvised"), strict=True):
        found[f"explorers_raised{name}"] = plain(_raised(cells, experts, reading), len(EXPLORERS))
    for reading, name in zip(READINGS, ("", "_own", "_unadvised"), strict=True):
        answers = [_raised(at(results, loops), e, reading) == len(EXPLORERS) for loops, e in grid_of(settings)]
        found[f"grid_all_raised{name}"] = share_of_grid(answers)
    return found


def _entries(cells: Sequence[Mapping], experts: str, agent: str) -> list[Mapping]:
    return [picked(cell["explorers"], experts=experts, agent=agent) for cell in cells]


def _mean(entries: Sequence[Mapping], reading: str) -> Estimate:
    kept = [[p for p in entry[reading] if p is not None] for entry in entries]
    means = [np.mean(of) for of in kept if of]
    return maze_estimate(means) if means else UNMEASURED


def _gain(entries: Sequence[Mapping], reading: str) -> Estimate:
    """What advice adds to an errand's mean P(M₁ | H), over mazes; errands advised throughout left out."""
    gains = [
        [told - alone for told, alone in zip(entry[reading], entry["alone"], strict=True) if told is not None]
        for entry in entries
    ]
    means = [np.mean(of) for of in gains if of]
    return maze_estimate(means) if means else UNMEASURED


def _raised(cells: Sequence[Mapping], experts: str, reading: str) -> int:
    return sum(is_positive(_gain(_entries(cells, experts, agent), reading)) for agent in EXPLORERS)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row an explorer; then the default's curves by blocks of steps."""
    found = []
    for loops, experts in grid_of(settings):
        for agent in EXPLORERS:
            entries = _entries(at(results, loops), experts, agent)
            row: dict = {"loops": loops, "experts": experts, "agent": agent}
            row |= {reading: _short(_mean(entries, reading)) for reading in ("alone", *READINGS)}
            gains = {reading: _gain(entries, reading) for reading in READINGS}
            row["certain"] = {reading: bool(g.ci95 and g.ci95[0] * g.ci95[1] > 0) for reading, g in gains.items()}
            row["gain"] = {reading: _short(g) for reading, g in gains.items()}
            found.append(row)
    return found + _curves(settings, results)


def _short(number: Estimate) -> float | None:
    return round(number.value, 4) if np.isfinite(number.value) else None


def _curves(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean P(M₁ | H) over those still walking, and mean reward so far, by block; explorers told and alone."""
    default = settings["default"]
    found = []
    for agent in EXPLORERS:
        entries = _entries(at(results, default["loops"]), default["experts"], agent)
        for way in ("alone", "told"):
            curves = [entry[f"curve_{way}"] for entry in entries]
            p, n, reached = (np.sum([c[key] for c in curves], axis=0) for key in ("p", "n", "reached"))
            mean = [round(float(a / b), 4) if b else None for a, b in zip(p, n, strict=True)]
            reward = np.round(1000 * reached / (len(entries) * settings["tasks"]), 1).tolist()
            found.append({"curve_of": agent, "way": way, "normal": mean, "reward": reward})
    return found


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_18_normalcy.figure_normalcy_curves import draw_normalcy_curves

    return draw_normalcy_curves(result)


CLAIM = Claim(
    id="C3.18",
    title="Advice makes explorers resemble experts (Figure 3.21)",
    thesis="Injection of advice results in agents of four action selection procedures resembling normal behaviour "
    "in the domain more closely: P(M₁ | H) rises (20 random tasks, κ = 0.5).",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.18"),
    cells=maze_cells,
    run_cell=run_normalcy_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
