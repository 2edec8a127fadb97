"""C5.5: spare time spent by curiosity or uniform replay, and lives in which a type arrives late. Thesis: §5.2."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.agent.long_lived.curiosity import context_to_practise, curious_contexts
from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, attempt_task, live_task
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.core.streams import stream
from lifelore.domains.factory.customer_orders import CUSTOMERS
from lifelore.domains.task_stream import TaskStream
from reproduction.chapter5.c5_05_curiosity.late_type import LateTypeLife, live_with_late_type

UNIFORM, CURIOUS, LEARNABLE = "uniform", "curious", "learnable"
CHOOSERS = (UNIFORM, CURIOUS, LEARNABLE)
"""How the context of a spare order is chosen."""
LATE = "late type"
SPARE_NUMBER, TEST_NUMBER = 10_000, 20_000
"""Numbers of the first spare and of the first test order: their layouts are those of no order of the life."""
ONCE = LivingSettings(n_episodes=1)


def cells(settings: Mapping) -> list[dict]:
    """Every life; each is lived with all choosers."""
    spare = [{"part": "spare time", "life": life} for life in range(settings["lives"])]
    return spare + [{"part": LATE, "life": life} for life in range(settings["late_lives"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """A life of spare time: mean points missed after each span of spare orders. Or a life with a late type."""
    if cell["part"] == LATE:
        found = live_with_late_type(1000 * seed + cell["life"], settings["orders"], settings["arrival"])
        return {**cell, **vars(found)}
    family = FactoryFamily(TaskStream(tuple(CUSTOMERS), 1000 * seed + cell["life"], settings["contexts"]), seed)
    best = [family.best_return(number) for number in _tests(settings)]
    return {
        **cell,
        **{chooser: _spare_time(settings, family, best, chooser, cell["life"], seed) for chooser in CHOOSERS},
    }


def late_lives(results: list[Mapping]) -> list[LateTypeLife]:
    """The lives with a late type."""
    names = LateTypeLife.__dataclass_fields__
    return [LateTypeLife(**{name: one[name] for name in names}) for one in results if one["part"] == LATE]


def _spare_time(
    settings: Mapping, family: FactoryFamily, best: Sequence[float], chooser: str, life: int, seed: int
) -> list[float]:
    knowledge, abilities = Knowledge.empty(family), AGENTS["full"]
    living = LivingSettings(n_episodes=settings["episodes"])
    for number in range(settings["lived"]):
        live_task(knowledge, *family.meet(number, abilities), abilities, living, f"lived.{number}", seed)
    random = stream(seed, "C5.5", "spare time", life)
    missed = [_missed(settings, knowledge, best)]
    for number in range(SPARE_NUMBER, SPARE_NUMBER + settings["spare"]):
        context = _chosen(knowledge, family, chooser, settings["lived"], random)
        # The date goes on from task to task: spare orders are the latest.
        drawn, task = family.meet(number, abilities, context)
        live_task(knowledge, drawn, task, abilities, living, f"spare.{number}", seed)
        if (number + 1 - SPARE_NUMBER) % settings["every"] == 0:
            missed.append(_missed(settings, knowledge, best))
    return missed


def _chosen(
    knowledge: Knowledge, family: FactoryFamily, chooser: str, lived: int, random: np.random.Generator
) -> int:
    if chooser == UNIFORM:
        return family.stream.draw(int(random.integers(lived))).context
    if chooser == CURIOUS:
        return context_to_practise(knowledge, random)
    return max(curious_contexts(knowledge), key=lambda one: (one.learnable, -one.context)).context


def _tests(settings: Mapping) -> range:
    """The numbers of the test orders."""
    return range(TEST_NUMBER, TEST_NUMBER + settings["tests"])


def _missed(settings: Mapping, knowledge: Knowledge, best: Sequence[float]) -> float:
    """Mean points that the first episodes of new orders miss of their `best`; nothing is learnt from them."""
    family, abilities, missed = knowledge.family, AGENTS["full"], []
    for number, most in zip(_tests(settings), best, strict=True):
        drawn, task = family.meet(number, abilities)
        lived, _ = attempt_task(knowledge, drawn, task, abilities, ONCE, "test")
        missed.append(most - lived.returns[0])
    return round(float(np.mean(missed)), 4)
