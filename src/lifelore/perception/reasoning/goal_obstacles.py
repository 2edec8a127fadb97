"""Why no plan can reach a goal: objects that it moves or covers, and that cannot become clear."""

from collections.abc import Iterable

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, ON
from lifelore.perception.reasoning.fact import Fact
from lifelore.perception.reasoning.planning_goal import TABLE_WORD, Statement, names_of, pddl_name
from lifelore.perception.reasoning.planning_state import CLEAR, HIDDEN, PlanningState
from lifelore.perception.reasoning.scene_logic import reached_from


def goal_obstacles(state: PlanningState, goal: Iterable[Statement]) -> tuple[str, ...]:
    """One reason for each pair of objects in the way; empty where the state alone does not forbid a plan.

    An object must become clear to be taken, or to carry another one. So all that rests on it or may cover it goes
    first, and what rests on that or may cover that. It never becomes clear if one of these objects would have to
    be taken before itself.

    Parameters
    ----------
    state : PlanningState
    goal : iterable of Statement
        Over objects of the state.
    """
    numbers = names_of(state.objects) | {TABLE_WORD: TABLE}
    first = _to_take_first(state)
    circles = [(a, b) for a, b in state.may_cover if b in reached_from(a, first)]
    found: dict[tuple[int, int], str] = {}
    for statement in goal:
        places = tuple(numbers[name] for name in statement.arguments)
        ways = []
        for way in _must_be_clear(statement, places, state):
            ends = {end for end in way if end != TABLE}
            needed = ends.union(*(reached_from(end, first) for end in ends))
            ways.append([pair for pair in circles if pair[1] in needed])
        if ways and all(ways):
            found |= {(a, b): _reason(a, b, state) for way in ways for a, b in way}
    return tuple(found[pair] for pair in sorted(found))


def _must_be_clear(statement: Statement, places: tuple[int, ...], state: PlanningState) -> list[tuple[int, ...]]:
    """For each way to reach the statement, the objects that must become clear before; no way where it holds."""
    name = statement.name.removesuffix(f"-{TABLE_WORD}")
    places = (*places, TABLE) if name != statement.name else places
    known = tuple(sorted(places)) if name == ADJACENT else places
    if (Fact(name, known) in state.stated) == statement.holds:
        return []
    if name == ADJACENT:
        return [(places[0],), (places[1],)]
    if name in (CLEAR, "holding"):
        return [places] if statement.holds else []
    if name == ON:
        return [places if statement.holds else places[:1]]
    return []


def _to_take_first(state: PlanningState) -> dict[int, set[int]]:
    """What must be taken away before each object is clear: what rests on it by what is stated, or may cover it."""
    first: dict[int, set[int]] = {}
    for a, b in (*(fact.arguments for fact in state.stated if fact.name == ON), *state.may_cover):
        first.setdefault(b, set()).add(a)
    return first


def _reason(a: int, b: int, state: PlanningState) -> str:
    upper, lower = pddl_name(a), pddl_name(b)
    doubt = f"{upper} may rest on {lower}"
    if state.may_cover[a, b] == HIDDEN:
        doubt = f"{upper} hides a part of the top of {lower}, so something may rest on it unseen"
    return f"{doubt}, and {upper} cannot be taken away before {lower}"
