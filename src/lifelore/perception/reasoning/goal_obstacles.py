"""Why no plan can reach a goal: objects that it moves or covers, and on which something may rest unseen."""

from collections.abc import Iterable, Mapping

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, ON
from lifelore.perception.reasoning.fact import Fact
from lifelore.perception.reasoning.planning_goal import TABLE_WORD, Statement
from lifelore.perception.reasoning.planning_state import CLEAR, HIDDEN, PlanningState


def goal_obstacles(state: PlanningState, goal: Iterable[Statement], called: Mapping[int, str]) -> tuple[str, ...]:
    """One reason for each object that stands in the way; empty where the state alone does not forbid a plan.

    An object must become clear to be taken, or to carry another one. It never does if something may rest on it
    unseen, or on an object of the pile on it.

    Parameters
    ----------
    state : PlanningState
    goal : iterable of Statement
        Over objects of the state.
    called : mapping of int to str
        What each object is called in the goal and in the reasons.
    """
    numbers = {TABLE_WORD: TABLE} | {name: n for n, text in called.items() for name in (text, str(n))}
    hidden = {one.fact.arguments[0] for one in state.unknown if one.reason == HIDDEN}
    found: dict[int, str] = {}
    for statement in goal:
        places = tuple(numbers[name] for name in statement.arguments)
        ways = [
            {thing for end in way if end != TABLE for thing in _covered(end, state)}
            for way in _must_be_clear(statement, places, state)
        ]
        if ways and all(ways):
            for thing in sorted(set().union(*ways)):
                found[thing] = _reason(called[thing], thing in hidden, state.probability[Fact(CLEAR, (thing,))])
    return tuple(found.values())


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


def _covered(thing: int, state: PlanningState) -> set[int]:
    """Of an object and the pile on it, those on which something may rest unseen."""
    pile = {thing}
    while above := {f.arguments[0] for f in state.stated if f.name == ON and f.arguments[1] in pile} - pile:
        pile |= above
    return pile & set(state.may_be_covered)


def _reason(name: str, is_hidden: bool, clear: float) -> str:
    if is_hidden:
        return f"other objects hide a part of the top of {name}, so something may rest on it unseen"
    return f"something may rest on {name}: that nothing unknown does has a probability of {clear:.2f} only"
