"""States of trays and plans on them: what acts lead to, worked by hand, and what an episode teaches the next."""

import numpy as np
import pytest

from lifelore.agent.long_lived.families import tray_states as tray
from lifelore.agent.long_lived.families.outcome_planning import OutcomePlanner
from lifelore.agent.long_lived.families.tray_features import PerceivedTray
from lifelore.agent.long_lived.families.tray_graph import UNKNOWN, Answer, TrayEdges, TrayGraph
from lifelore.agent.long_lived.families.tray_states import (
    ASIDE,
    DONE,
    GENTLY,
    MISSED,
    PICK_NEIGHBOUR,
    PICK_TARGET,
    PICK_TOP,
    PUSH_NEIGHBOUR,
    PUSH_TARGET,
    VERB,
    TrayState,
    cause_name,
    result_of,
)
from lifelore.domains.tabletop_job.events import Events
from tests.agent.long_lived.test_tray_features import TARGET, box

CUBE = box((0, 0), (0.02, 0.02, 0.02), 0.05)
BESIDE = box((0.052, 0.0), (0.06, 0.04, 0.05))
"""2 mm beside the target, where its fingers go; its own fingers go down in front of it and behind it."""
LOADED = TrayState.seen(PerceivedTray(0, {0: TARGET, 1: CUBE, 2: BESIDE}, {(1, 0): 0.9}))
"""The target with a cube on it and a neighbour in the fingers' way."""
BARE = LOADED.after(PICK_TOP, 1)[DONE].after(ASIDE, 1)[DONE]
ROOMY = LOADED.after(PICK_NEIGHBOUR, 2)[DONE].after(ASIDE, 2)[DONE]
HELD = LOADED.after(PICK_TARGET, 0)[DONE]
OTHER = LOADED.after(PICK_TOP, 1)[DONE]


def test_acts_name_objects_by_their_place():
    named = {PICK_TARGET: 0, PICK_TOP: 1, PICK_NEIGHBOUR: 2, PUSH_TARGET: 0, PUSH_NEIGHBOUR: 2}
    assert LOADED.named() == named
    assert (OTHER.held, OTHER.named()) == (1, {ASIDE: 1, GENTLY: 1, tray.BRISKLY: 1})
    assert TrayState.seen(None).named() == {}


def test_what_is_put_aside_or_pushed_makes_the_target_free():
    free = BARE.after(PICK_NEIGHBOUR, 2)[DONE].after(ASIDE, 2)[DONE]
    assert [cause_name(state.cause(PICK_TARGET, 0)) for state in (LOADED, BARE, free)] == [
        "pick (something on it, no room for fingers)",
        "pick (nothing on it, no room for fingers)",
        "pick (nothing on it, room for any finger)",
    ]
    assert BARE.after(PUSH_NEIGHBOUR, 2)[DONE].cause(PICK_TARGET, 0) == free.cause(PICK_TARGET, 0)
    # What could not be picked is tried again when something beside it is gone.
    missed = LOADED.after(PICK_TARGET, 0)[MISSED]
    assert PICK_TARGET not in missed.named()
    assert PICK_TARGET in missed.after(PICK_NEIGHBOUR, 2)[DONE].after(ASIDE, 2)[DONE].named()


def test_a_spill_takes_what_lay_on_the_object():
    after = LOADED.after(PICK_TARGET, 0)
    assert (after[tray.SPILLED].held, after[tray.SPILLED].here) == (0, {2})
    assert (after[tray.SPILLED_IN_VAIN].held, after[tray.SPILLED_IN_VAIN].here) == (None, {0, 2})


@pytest.mark.parametrize(
    ("number", "act", "result", "burden"),
    [
        (0, PICK_TARGET, DONE, ", something still on it"),
        (0, PICK_TARGET, tray.SPILLED, ", after a spill"),
        (1, PICK_TOP, DONE, ""),
        (1, PICK_TOP, tray.KNOCKED, ", something still on it"),
    ],
)
def test_what_may_still_lie_on_a_picked_object_counts_when_it_is_handed_over(number, act, result, burden):
    """The target has a cube on it, the cube has nothing on it."""
    held = LOADED.after(act, number)[result]
    assert cause_name(held.cause(GENTLY, number)) == f"hand over gently{burden}"
    assert held.after(ASIDE, number)[DONE].burden == tray.CLEAR


def test_the_user_pays_for_what_happened_and_the_target_ends_the_episode():
    assert HELD.after(GENTLY, 0) == [None] * len(tray.RESULTS)
    assert OTHER.after(tray.BRISKLY, 1)[DONE].held is None
    for state, act in ((LOADED, PICK_TARGET), (LOADED, PUSH_TARGET), (HELD, ASIDE)):
        assert state.payments(act)[tray.SPILLED] == tray.SPILL
    assert LOADED.payments(PICK_TARGET)[MISSED] == LOADED.payments(PUSH_TARGET)[DONE] == tray.QUIET
    briskly = HELD.payments(tray.BRISKLY)
    assert briskly[tray.SPILLED_IN_VAIN] == tray.SPILL
    paid = [HELD.payments(GENTLY)[DONE], OTHER.payments(GENTLY)[DONE], briskly[DONE], briskly[tray.SPILLED]]
    assert [tray.PAYMENTS[payment] for payment in paid] == [
        "the target was handed over gently",
        "another object was handed over gently",
        "the target was handed over briskly",
        "the target was handed over briskly with a spill",
    ]


@pytest.mark.parametrize(
    ("events", "act", "room", "result"),
    [
        (Events(1.0), PICK_TARGET, True, DONE),
        (Events(1.0, reached=False), PICK_TARGET, True, MISSED),
        (Events(1.0, reached=False, knocked=(1,)), PICK_TARGET, True, tray.KNOCKED_IN_VAIN),
        (Events(1.0, spilled=(1,), knocked=(2,)), PICK_TARGET, True, tray.SPILLED),
        (Events(1.0, slipped=True, spilled=(0,)), PICK_TARGET, True, tray.SPILLED_IN_VAIN),
        (Events(1.0), PUSH_NEIGHBOUR, True, DONE),
        (Events(1.0), PUSH_NEIGHBOUR, False, MISSED),
        (Events(1.0, knocked=(1,)), PUSH_NEIGHBOUR, False, tray.KNOCKED),
        (Events(1.0), ASIDE, False, DONE),
    ],
)
def test_results(events, act, room, result):
    assert result_of(events, act, room) == result


def test_a_push_that_made_no_room_changes_nothing_and_is_not_repeated():
    in_vain = LOADED.after(PUSH_NEIGHBOUR, 2)[MISSED]
    assert in_vain.cause(PICK_TARGET, 0) == LOADED.cause(PICK_TARGET, 0)
    assert PUSH_NEIGHBOUR not in in_vain.named()


# ---- plans -------------------------------------------------------------------------------------------


def planned(graph, missed, bring=10.0):
    """Plans where picks surely miss for some causes; all else is done. An act costs 1, a push 6."""
    edges = graph.edges(())
    results = np.eye(len(tray.RESULTS))[np.where(np.isin(edges.cause, list(missed)), MISSED, DONE)]
    rewards = np.full(len(tray.PAYMENTS), -1.0)
    rewards[tray.HANDED] += bring
    paid = rewards[edges.payments] - 5.0 * np.isin(edges.act, (PUSH_TARGET, PUSH_NEIGHBOUR))[:, None]
    known = edges.answer != UNKNOWN
    results[known], paid[known] = np.eye(len(tray.RESULTS))[edges.answer[known]], edges.paid[known, None]
    tried = np.ones(len(edges.at), bool)
    return OutcomePlanner(edges, len(tray.ACTS), results[None], paid[None], tried, 10.0, 16)


def lived_through(graph, state, acts, reward=-1.0):
    """Add an episode to a graph: acts with their results; handing over ends it with 9 points."""
    done = ()
    graph.saw(done, state)
    for act, number, result in acts:
        done, ended = (*done, (VERB[act], number)), act == GENTLY
        if not ended:
            state = state.after(act, number)[result]
            graph.saw(done, state)
        graph.answered(done, Answer(result, 9.0 if ended else reward, ended))
    return graph


def test_the_plan_clears_the_way_if_that_is_worth_its_cost():
    graph, blocked = lived_through(TrayGraph(), LOADED, ()), LOADED.cause(PICK_TARGET, 0)
    sure = planned(graph, {blocked})
    # Pick the cube, put it aside, pick the target, hand it over: four acts of which the last brings 10 points.
    assert sure.q[0, 0, PICK_TOP] == pytest.approx(10 - 4)
    assert sure.plan().acts[0] == PICK_TOP
    assert sure.values()[0, 0] == pytest.approx(6)
    # Where the neighbour blocks as well, it has to be put aside, too.
    all_missed = {blocked, BARE.cause(PICK_TARGET, 0), ROOMY.cause(PICK_TARGET, 0)}
    assert planned(graph, all_missed).q[0, 0].max() == pytest.approx(10 - 6)
    # Where bringing pays less than the way costs, the agent gives up.
    assert planned(graph, all_missed, bring=5.5).plan().acts[0] == tray.GIVE_UP


def test_what_a_tray_has_answered_is_remembered():
    """After a miss that the laws call impossible, the next episode does not miss again."""
    graph = lived_through(TrayGraph(), LOADED, ())
    assert planned(graph, ()).plan().acts[0] == PICK_TARGET
    again = planned(lived_through(graph, LOADED, [(PICK_TARGET, 0, MISSED)], -3.0), ())
    assert again.plan().acts[0] != PICK_TARGET
    # It counts the reward that was paid, and goes on from what was seen: 10 − 1 for each of four acts, and −3.
    assert again.q[0, 0, PICK_TARGET] == pytest.approx(-3 + 10 - 4)


@pytest.mark.parametrize("result", [MISSED, tray.SLIPPED, tray.KNOCKED_IN_VAIN])
def test_acts_in_vain_are_left_out_the_next_time(result):
    """The target was picked and pushed in vain, then brought in four acts; laws say that nothing can be picked."""
    way = [(PICK_TOP, 1, DONE), (ASIDE, 1, DONE), (PICK_TARGET, 0, DONE), (GENTLY, 0, DONE)]
    graph = lived_through(TrayGraph(), LOADED, [(PICK_TARGET, 0, result), (PUSH_TARGET, 0, MISSED), *way])
    again = planned(graph, range(tray.N_SITUATED))
    assert again.q[0, 0, [PICK_TARGET, PICK_TOP]] == pytest.approx([-1 - 3 + 9, -3 + 9])
    assert again.plan().acts[0] == PICK_TOP
    # What the shorter way then answers itself counts more than what the longer way lets expect.
    after = planned(lived_through(graph, LOADED, [(PICK_TOP, 1, MISSED)]), range(tray.N_SITUATED))
    assert after.plan().acts[0] == PUSH_TARGET
    assert after.q[0, 0, [PICK_TARGET, PICK_TOP, PUSH_TARGET]] == pytest.approx([4.0, 4.0, 5.0])


def answered(graph, done=()):
    """Acts of the first state whose answers are known."""
    edges = graph.edges(done)
    return set(edges.act[(edges.at == 0) & (edges.answer != UNKNOWN)].tolist())


def test_an_act_that_spilled_is_not_left_out_and_a_push_in_vain_not_before_a_push():
    spilled = [(PICK_TARGET, 0, tray.SPILLED_IN_VAIN), (PICK_NEIGHBOUR, 2, MISSED)]
    assert answered(lived_through(TrayGraph(), LOADED, spilled)) == {PICK_TARGET}
    graph, pushed = TrayGraph(), ((VERB[PUSH_TARGET], 0),)
    graph.saw(pushed, TrayState.seen(LOADED.tray))  # the tray is looked at again, and another push is possible
    lived_through(graph, LOADED, [(PUSH_TARGET, 0, MISSED), (PICK_NEIGHBOUR, 2, MISSED)])
    assert answered(graph) == {PUSH_TARGET, PICK_NEIGHBOUR}
    assert answered(graph, pushed) == {PICK_NEIGHBOUR}


def test_untried_acts_are_hoped_for_by_the_unknown_type_alone():
    none, both = np.zeros(2, np.int64), np.arange(2)
    edges = TrayEdges(1, none, both, none, none[:, None], np.ones((2, 1), np.int64), none - 1, np.zeros(2), {})
    given = edges, 3, np.ones((2, 2, 1)), np.tile([[1.0], [-5.0]], (2, 1, 1)), np.array([True, False]), 10.0, 4
    plan = OutcomePlanner(*given, new=1).plan()
    assert plan.acts.tolist() == [0, 1]
    np.testing.assert_allclose(plan.values, [[1.0, 10.0], [1.0, 10.0]])
    assert OutcomePlanner(*given, new=1, allowed=np.array([True, False, True])).plan().acts.tolist() == [0, 0]
