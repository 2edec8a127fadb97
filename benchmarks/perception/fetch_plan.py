"""Plans that fetch an object: everything known to rest on it is put away first, from the top.

They are the shortest plans of the domain of `planning_domain` for the goal to hold the object.
"""

from collections.abc import Iterable, Sequence

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import BOTH, ON, PairLabel
from lifelore.perception.reasoning.planning_state import PlanningState


def fetch_order(state: PlanningState, target: int) -> tuple[int, ...] | None:
    """The objects to pick up, the target last; None if something may rest unseen on one of them."""
    above: dict[int, list[int]] = {}
    for fact in state.stated:
        if fact.name == ON and fact.arguments[1] != TABLE:
            above.setdefault(fact.arguments[1], []).append(fact.arguments[0])
    order: list[int] = []
    begun: set[int] = set()

    def put_away(thing: int) -> bool:
        """Append the objects above, then the object itself; False if that is impossible."""
        if thing in order:
            return True
        if thing in begun or thing in state.may_be_covered:
            return False
        begun.add(thing)
        if not all(put_away(other) for other in above.get(thing, ())):
            return False
        order.append(thing)
        return True

    return tuple(order) if put_away(target) else None


def is_valid(order: Sequence[int], truth: Iterable[PairLabel], least_confidence: int = 2) -> bool:
    """Whether nothing rests on any object when it is picked up, by labels with at least that confidence."""
    return first_fault(order, truth, least_confidence) is None


def first_fault(
    order: Sequence[int], truth: Iterable[PairLabel], least_confidence: int = 2
) -> tuple[int, int] | None:
    """The first object that is picked up while another rests on it, as (object, other); None of a valid plan."""
    resting = sorted(
        (label.b, label.a)
        for label in truth
        if label.relation in (ON, BOTH) and label.confidence >= least_confidence and label.b != TABLE
    )
    away: set[int] = set()
    for thing in order:
        for below, other in resting:
            if below == thing and other not in away:
                return below, other
        away.add(thing)
    return None
