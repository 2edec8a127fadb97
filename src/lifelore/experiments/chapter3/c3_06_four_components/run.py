"""C3.6: the same as C3.5 with four components, of whose tasks only a fraction is met.

Thesis: §3.4.3, Figure 3.9.
"""

from collections.abc import Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter3 import factory_gains
from lifelore.experiments.chapter3.factory_gains import FULL, QUICK, draw, rows
from lifelore.experiments.chapter3.factory_series import cells, run_cell
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The measures of C3.5 for four components, and what is gained beside one component."""
    return {
        **factory_gains.measure(settings, results),
        **factory_gains.against_one_component(settings, results),
    }


def _check(settings: Mapping) -> None:
    factory_gains.check(settings)
    if len(settings["components"]) != 2 or settings["components"][1] != 1:
        raise InputError(f"components must be a number and 1 to compare it with, got {settings['components']}")


CAUSES = {
    "as much as one component": "under a code of all nine components few configurations of a task of four are met "
    "again in another; by a component's place in the task's list as much is gained as with one",
}

CLAIM = Claim(
    id="C3.6",
    title="A prior accumulated over factory tasks of four components (Figure 3.9)",
    thesis="With tasks of 4 random components the agent has met only a small fraction of the possible tasks after "
    "40, yet a state prior brings very similar benefits to the case of a single component (10 runs).",
    sizes={"quick": {**QUICK, "components": [2, 1]}, "full": {**FULL, "components": [4, 1]}},
    predicate=Predicate.of("C3.6"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=draw,
    causes=CAUSES,
    check=_check,
)
