"""C2.7: three things on one another, and two things wrongly segmented into three, have one structure.

The middle thing's network merges its contact with the thing below and that with the thing above: two points. A
thing cut level into two has, with the other thing, the same skeleton: one point, two points, one point. Contacts
with the ground are not counted (the thesis's background is taken off), nor those of near pairs that perception
says are not related; both other countings stand beside. Three neighbours in a row have that skeleton too, as have
two things on one: without its predicates a skeleton knows no up. So a control has the structure only if its
predicates agree. Thesis: §2.4.3, Figure 2.7.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.stack_skeletons import run_cell
from lifelore.experiments.chapter2.stack_skeletons import stack_cells as cells

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")
