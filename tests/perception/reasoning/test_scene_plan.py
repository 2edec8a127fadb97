"""Plans of a planner that is made up: their confidences by hand, and goals that no plan can reach."""

from dataclasses import dataclass

import numpy as np
import pytest

from lifelore.core.errors import InputError, LifeloreError, MissingExtraError
from lifelore.perception.reasoning.goal_obstacles import goal_obstacles
from lifelore.perception.reasoning.planning_goal import read_goal
from lifelore.perception.reasoning.planning_state import NO_HIDDEN, planning_state
from lifelore.perception.reasoning.scene_plan import _judged, scene_plan
from lifelore.perception.relations.relation import Relation


@dataclass(frozen=True)
class Step:
    action: str
    arguments: tuple[str, ...]


def planner(*steps, problems=None):
    """A planner that answers with these steps, and adds the problem that it is given to `problems`."""

    def solve(domain, problem):
        if problems is not None:
            problems.append(problem)
        return None if steps == (None,) else [Step(action, tuple(names)) for action, *names in steps]

    return solve


@pytest.fixture
def pile(make_scene):
    """4 on 3 (0.9), 3 and 2 on the table, 2 beside 3 with 0.7."""
    points = {label: np.zeros((1, 3)) for label in (2, 3, 4)}
    relations = [(2, 1, "on", 0.95), (3, 1, "on", 0.95), (4, 3, "on", 0.9), (2, 3, "adjacent", 0.7)]
    return make_scene(points, relations=relations)


def test_confidences_are_products_of_what_the_steps_rely_on(pile):
    steps = (("pick-up", "o4"), ("put-beside", "o4", "o2"), ("pick-up", "o3"), ("put-on", "o3", "o4"))
    problems = []
    solve = planner(*steps, problems=problems)
    plan = scene_plan(pile, read_goal("on(o3, o4)"), solve, least=0.5, cut_confidence={3: 0.75, 4: 0.5})
    assert "(:goal (on o3 o4))" in problems[0]
    assert [step.objects for step in plan.steps] == [(4,), (4, 2), (3,), (3, 4)]
    state = planning_state(pile.relations, pile.objects, 0.5)
    p = {str(fact): probability for fact, probability in state.probability.items()}
    # Of the 0.3 that "adjacent" leaves, a part each says that 2 rests on 3, or 3 on 2.
    assert 0.85 < p["clear(2)"] == p["clear(3)"] < 1
    expected = [p["clear(4)"] * 0.5, p["on(2, table)"] * 0.5, p["clear(3)"] * 0.75, 0.75 * 0.5]
    assert [step.confidence for step in plan.steps] == pytest.approx(expected)
    assert plan.confidence == pytest.approx(p["clear(4)"] * p["on(2, table)"] * p["clear(3)"] * 0.75 * 0.5)
    assert plan.reason is None


def test_the_goal_holds_already(pile):
    plan = scene_plan(pile, read_goal("on(o4, o3)"), planner())
    assert (plan.steps, plan.confidence, plan.reason) == ((), 1.0, None)


def test_a_planner_without_a_plan_is_told_with_what_is_unknown(pile):
    reason = scene_plan(pile, read_goal("on(o2, o3) and on(o3, o2)"), planner(None), least=0.85).reason
    assert reason.startswith("no order of picking up and putting down brings the goal about; unknown facts")
    assert "adjacent(2, 3) (0.82, doubtful)" in reason


def test_a_planner_out_of_time_is_a_reason_and_its_other_errors_stay(pile):
    def fail(error):
        def solve(domain, problem):
            raise error

        return solve

    late = LifeloreError("the planner found no plan in 60 s: TIMEOUT")
    assert scene_plan(pile, read_goal("on(o2, o4)"), fail(late)).reason == str(late)
    with pytest.raises(MissingExtraError):
        scene_plan(pile, read_goal("on(o2, o4)"), fail(MissingExtraError("pip install")))


def test_without_support_there_is_no_plan(make_scene):
    scene = make_scene({2: np.zeros((1, 3))})
    assert scene_plan(scene, read_goal("holding(o2)"), planner()).reason == "nothing tells what 2 rests on"
    assert make_scene({2: np.zeros((1, 3))}, relations=[(2, 1, "on")]).objects == (2,)


def test_an_unknown_object_is_the_users_mistake(pile):
    with pytest.raises(InputError, match="got 'o9'"):
        scene_plan(pile, read_goal("holding(o9)"), planner())


def test_a_step_that_needs_a_hidden_top_says_to_look(pile):
    state = planning_state(pile.relations, pile.objects, 0.5, None, {2: (4,)})
    actions = [("pick-up", (4,)), ("put-on", (4, 2)), ("pick-up", (4,)), ("put-on-table", (4,)), ("pick-up", (2,))]
    assert [step.look for step in _judged(actions, state, {}).steps] == [(), (2,), (), (), ()]


def stack_state(hidden=NO_HIDDEN, least=0.0):
    """4 on 3 on 2 on the table; 5 beside 2 on the table."""
    relations = [Relation(a, b, "on", 0.9, 0.0) for a, b in ((2, 1), (3, 2), (4, 3), (5, 1))]
    return planning_state([*relations, Relation(2, 5, "adjacent", 0.9, 0.0)], (), least, None, hidden)


@pytest.mark.parametrize(
    ("goal", "in_the_way"),
    [
        ("holding(o4)", ["o4"]),
        ("holding(o2)", ["o4"]),  # the pile on it must go first
        ("holding(o5)", []),
        ("on(o5, o4)", ["o4"]),
        ("on(o4, o3)", []),  # holds
        ("not on(o4, o3)", ["o4"]),
        ("on(o5, table)", []),
        ("on(o3, table)", ["o4"]),
        ("adjacent(o4, o5)", []),  # 5 may be put beside 4 as well
        ("not adjacent(o2, o5)", []),
        ("clear(o4)", ["o4"]),
        ("not clear(o4)", []),
        ("holding(4)", ["o4"]),
        ("hand-empty()", []),
    ],
)
def test_an_object_that_hides_what_rests_on_it_stands_in_the_way(goal, in_the_way):
    """A tall part of 2 hides the top of 4."""
    found = goal_obstacles(stack_state(hidden={4: (2,)}), read_goal(goal))
    assert [reason.split(" of ")[2].split(",")[0] for reason in found] == in_the_way
    # 5 hides it as well: it can be taken away first, and is no obstacle.
    assert goal_obstacles(stack_state(hidden={4: (5,)}), read_goal(goal)) == ()


def test_objects_that_may_rest_on_each_other_are_obstacles():
    beside = [Relation(2, 1, "on", 1.0, 0.0), Relation(3, 1, "on", 1.0, 0.0), Relation(3, 2, "adjacent", 0.4, 0.0)]
    found = goal_obstacles(planning_state(beside, (), 0.9), read_goal("holding(o2)"))
    assert found == (
        "o2 may rest on o3, and o2 cannot be taken away before o3",
        "o3 may rest on o2, and o3 cannot be taken away before o2",
    )
