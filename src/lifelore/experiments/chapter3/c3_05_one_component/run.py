"""C3.5: in the factory with one component, what a prior gains as it accumulates from 0 to 40 tasks.

There are only nine such tasks, so that at the end all have been met. Thesis: §3.4.3, Figure 3.8.
"""

from lifelore.experiments.chapter3.factory_gains import FULL, QUICK, check, draw, measure, rows
from lifelore.experiments.chapter3.factory_series import cells, run_cell
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate

CLAIM = Claim(
    id="C3.5",
    title="A prior accumulated over factory tasks of one component (Figure 3.8)",
    thesis="In the factory with tasks of 1 random component, the reward of an episode with a state prior grows "
    "with the number of prior tasks, from 0 to 40, above that of learning each task from scratch; in the end all "
    "tasks have been met (10 runs).",
    sizes={"quick": {**QUICK, "components": [1]}, "full": {**FULL, "components": [1]}},
    predicate=Predicate.of("C3.5"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=draw,
    check=check,
)
