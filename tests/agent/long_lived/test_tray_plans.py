"""States of trays and plans on them: what acts lead to, worked by hand, and what an episode teaches the next."""

import numpy as np
import pytest

from lifelore.agent.long_lived.families.outcome_planning import OutcomeModel, OutcomePlanner
from lifelore.agent.long_lived.families.tray_features import PerceivedTray
from lifelore.agent.long_lived.families.tray_graph import Answer, TrayGraph
from lifelore.agent.long_lived.families.tray_states import (
    ASIDE,
    BRISKLY,
    CLEAR,
    DONE,
    GENTLY,
    GIVE_UP,
    HANDED,
    KNOCKED,
    KNOCKED_IN_VAIN,
    MISSED,
    N_SITUATED,
    PAYMENTS,
    PICK_NEIGHBOUR,
    PICK_TARGET,
    PICK_TOP,
    PUSH_NEIGHBOUR,
    PUSH_TARGET,
    QUIET,
    RESULTS,
    SLIPPED,
    SPILL,
    SPILLED,
    SPILLED_IN_VAIN,
    VERB,
    TrayState,
    cause_name,
    result_of,
)
from lifelore.domains.tabletop_job.events import Events
from lifelore.domains.tabletop_job.job import PICK
from tests.agent.long_lived.test_tray_features import TARGET, box

CUBE = box((0, 0), (0.02, 0.02, 0.02), 0.05)
BESIDE = box((0.052, 0.0), (0.06, 0.04, 0.05))
"""2 mm beside the target, where its fingers go; its own fingers go down in front of it and behind it."""


@pytest.fixture
def loaded():
    """The target with a cube on it and a neighbour in the fingers' way."""
    return TrayState.seen(PerceivedTray(0, {0: TARGET, 1: CUBE, 2: BESIDE}, {(1, 0): 0.9}))


def test_acts_name_objects_by_their_place(loaded):
    assert loaded.named() == {PICK_TARGET: 0, PICK_TOP: 1, PICK_NEIGHBOUR: 2, PUSH_TARGET: 0, PUSH_NEIGHBOUR: 2}
    held = loaded.after(PICK_TOP, 1)[DONE]
    assert held.held == 1
    assert held.named() == {ASIDE: 1, GENTLY: 1, BRISKLY: 1}
    assert TrayState.seen(None).named() == {}


def test_what_is_put_aside_makes_the_target_free(loaded):
    def put_away(state, act, number):
        return state.after(act, number)[DONE].after(ASIDE, number)[DONE]

    assert cause_name(loaded.cause(PICK_TARGET, 0)) == "pick (something on it, no room for fingers)"
    bare = put_away(loaded, PICK_TOP, 1)
    assert cause_name(bare.cause(PICK_TARGET, 0)) == "pick (nothing on it, no room for fingers)"
    free = put_away(bare, PICK_NEIGHBOUR, 2)
    assert cause_name(free.cause(PICK_TARGET, 0)) == "pick (nothing on it, room for any finger)"
    pushed = bare.after(PUSH_NEIGHBOUR, 2)[DONE]
    assert pushed.cause(PICK_TARGET, 0) == free.cause(PICK_TARGET, 0)


def test_what_could_not_be_picked_is_tried_again_when_something_beside_it_is_gone(loaded):
    missed = loaded.after(PICK_TARGET, 0)[MISSED]
    assert PICK_TARGET not in missed.named()
    freed = missed.after(PICK_NEIGHBOUR, 2)[DONE].after(ASIDE, 2)[DONE]
    assert PICK_TARGET in freed.named()


def test_a_spill_takes_what_lay_on_the_object(loaded):
    after = loaded.after(PICK_TARGET, 0)
    assert (after[SPILLED].held, after[SPILLED].here) == (0, {2})
    assert (after[SPILLED_IN_VAIN].held, after[SPILLED_IN_VAIN].here) == (None, {0, 2})


def test_what_may_still_lie_on_a_picked_object_counts_when_it_is_handed_over(loaded):
    """The target has a cube on it, the cube has nothing on it."""

    def way_to_hand_over(number, act, result):
        return cause_name(loaded.after(act, number)[result].cause(GENTLY, number))

    assert way_to_hand_over(0, PICK_TARGET, DONE) == "hand over gently, something still on it"
    assert way_to_hand_over(0, PICK_TARGET, SPILLED) == "hand over gently, after a spill"
    assert way_to_hand_over(1, PICK_TOP, DONE) == "hand over gently"
    assert way_to_hand_over(1, PICK_TOP, KNOCKED) == "hand over gently, something still on it"
    aside = loaded.after(PICK_TARGET, 0)[DONE].after(ASIDE, 0)[DONE]
    assert aside.burden == CLEAR


def test_the_episode_ends_when_the_target_is_handed_over(loaded):
    held = loaded.after(PICK_TARGET, 0)[DONE]
    assert held.after(GENTLY, 0) == [None] * len(RESULTS)
    other = loaded.after(PICK_TOP, 1)[DONE]
    assert other.after(BRISKLY, 1)[DONE].held is None
    assert [PAYMENTS[state.payments(GENTLY)[DONE]] for state in (held, other)] == [
        "the target was handed over gently",
        "another object was handed over gently",
    ]


def test_the_user_pays_for_what_happened_and_not_for_the_act(loaded):
    held = loaded.after(PICK_TARGET, 0)[DONE]
    for state, act in ((loaded, PICK_TARGET), (loaded, PUSH_TARGET), (held, ASIDE)):
        assert state.payments(act)[SPILLED] == SPILL
    assert loaded.payments(PICK_TARGET)[MISSED] == loaded.payments(PUSH_TARGET)[DONE] == QUIET
    assert held.payments(BRISKLY)[DONE] == HANDED + 1
    assert PAYMENTS[held.payments(BRISKLY)[SPILLED]] == "the target was handed over briskly with a spill"
    assert held.payments(BRISKLY)[SPILLED_IN_VAIN] == SPILL


@pytest.mark.parametrize(
    ("events", "result"),
    [
        (Events(1.0), DONE),
        (Events(1.0, reached=False), MISSED),
        (Events(1.0, reached=False, knocked=(1,)), KNOCKED_IN_VAIN),
        (Events(1.0, spilled=(1,), knocked=(2,)), SPILLED),
        (Events(1.0, slipped=True, spilled=(0,)), SPILLED_IN_VAIN),
    ],
)
def test_results_of_a_pick(events, result):
    assert result_of(events, PICK_TARGET) == result


def test_a_push_that_makes_no_room_misses(loaded):
    assert result_of(Events(1.0), PUSH_NEIGHBOUR, room=True) == DONE
    assert result_of(Events(1.0), PUSH_NEIGHBOUR, room=False) == MISSED
    assert result_of(Events(1.0, knocked=(1,)), PUSH_NEIGHBOUR, room=False) == KNOCKED
    assert result_of(Events(1.0), ASIDE, room=False) == DONE
    in_vain = loaded.after(PUSH_NEIGHBOUR, 2)[MISSED]
    assert in_vain.cause(PICK_TARGET, 0) == loaded.cause(PICK_TARGET, 0)
    assert PUSH_NEIGHBOUR not in in_vain.named()  # a plan foresees one push


def model_of(nodes, missed, bring=10.0):
    """Picks miss with probabilities `missed` by cause; all else is done. An act costs 1, a push 6."""
    results = np.zeros((N_SITUATED, len(RESULTS)))
    results[:, DONE] = 1
    for cause, probability in missed.items():
        results[cause, [DONE, MISSED]] = 1 - probability, probability
    rewards = np.full(len(PAYMENTS), -1.0)
    rewards[HANDED] += bring
    found, paid = results[nodes.causes][None], rewards[nodes.payments][None]
    paid[:, :, [PUSH_TARGET, PUSH_NEIGHBOUR]] -= 5
    found[:, nodes.answered], paid[:, nodes.answered] = nodes.answers, nodes.paid[:, None]
    tried = np.ones(nodes.causes.shape, bool)
    return OutcomeModel(nodes.available, found, paid, nodes.following, tried, 10.0, 16)


def test_the_plan_clears_the_way_if_that_is_worth_its_cost(loaded):
    graph = TrayGraph()
    graph.saw((), loaded)
    nodes = graph.nodes(())
    blocked = loaded.cause(PICK_TARGET, 0)
    bare = loaded.after(PICK_TOP, 1)[DONE].after(ASIDE, 1)[DONE].cause(PICK_TARGET, 0)
    sure = OutcomePlanner(model_of(nodes, {blocked: 1.0}))
    # Pick the cube, put it aside, pick the target, hand it over: four acts of which the last brings 10 points.
    assert sure.q[0, 0, PICK_TOP] == pytest.approx(10 - 4)
    assert sure.plan().acts[0] == PICK_TOP
    assert sure.values()[0, 0] == pytest.approx(6)
    # Where the neighbour blocks as well, it has to be put aside, too.
    roomy = loaded.after(PICK_NEIGHBOUR, 2)[DONE].after(ASIDE, 2)[DONE].cause(PICK_TARGET, 0)
    all_missed = {blocked: 1.0, bare: 1.0, roomy: 1.0}
    both = OutcomePlanner(model_of(nodes, all_missed))
    assert both.q[0, 0].max() == pytest.approx(10 - 6)
    # Where bringing pays less than the way costs, the agent gives up.
    poor = OutcomePlanner(model_of(nodes, all_missed, bring=5.5))
    assert poor.plan().acts[0] == GIVE_UP


def test_what_a_tray_has_answered_is_remembered(loaded):
    """After a miss that the laws call impossible, the next episode does not miss again."""
    graph = TrayGraph()
    graph.saw((), loaded)
    assert OutcomePlanner(model_of(graph.nodes(()), {})).plan().acts[0] == PICK_TARGET
    done = ((VERB[PICK_TARGET], 0),)
    assert VERB[PICK_TARGET] == PICK
    graph.saw(done, loaded.after(PICK_TARGET, 0)[MISSED])
    graph.answered(done, Answer(MISSED, -3.0, False))
    again = OutcomePlanner(model_of(graph.nodes(()), {}))
    assert again.plan().acts[0] != PICK_TARGET
    # It counts the reward that was paid, and goes on from what was seen: 10 − 1 for each of four acts, and −3.
    assert again.q[0, 0, PICK_TARGET] == pytest.approx(-3 + 10 - 4)


def lived_through(graph, state, acts):
    """Add an episode to a graph: acts with their results; each costs 1, handing over ends it with 9 points."""
    done = ()
    graph.saw(done, state)
    for act, number, result in acts:
        done, ended = (*done, (VERB[act], number)), act == GENTLY
        if not ended:
            state = state.after(act, number)[result]
            graph.saw(done, state)
        graph.answered(done, Answer(result, 9.0 if ended else -1.0, ended))


@pytest.mark.parametrize("result", [MISSED, SLIPPED, KNOCKED_IN_VAIN])
def test_acts_in_vain_are_left_out_the_next_time(loaded, result):
    """The target was picked and pushed in vain, then brought in four acts; laws say that nothing can be picked."""
    graph = TrayGraph()
    way = [(PICK_TOP, 1, DONE), (ASIDE, 1, DONE), (PICK_TARGET, 0, DONE), (GENTLY, 0, DONE)]
    lived_through(graph, loaded, [(PICK_TARGET, 0, result), (PUSH_TARGET, 0, MISSED), *way])
    nothing = dict.fromkeys(range(N_SITUATED), 1.0)
    again = OutcomePlanner(model_of(graph.nodes(()), nothing))
    assert again.q[0, 0, PICK_TARGET] == pytest.approx(-1 - 3 + 9)
    assert again.q[0, 0, PICK_TOP] == pytest.approx(-3 + 9)
    assert again.plan().acts[0] == PICK_TOP
    # What the shorter way then answers itself counts more than what the longer way lets expect.
    lived_through(graph, loaded, [(PICK_TOP, 1, MISSED)])
    after = OutcomePlanner(model_of(graph.nodes(()), nothing))
    assert after.plan().acts[0] == PUSH_TARGET
    assert after.q[0, 0, [PICK_TARGET, PICK_TOP, PUSH_TARGET]] == pytest.approx([4.0, 4.0, 5.0])


def test_an_act_that_spilled_is_not_left_out(loaded):
    graph = TrayGraph()
    lived_through(graph, loaded, [(PICK_TARGET, 0, SPILLED_IN_VAIN), (PICK_NEIGHBOUR, 2, MISSED)])
    assert graph.nodes(()).answered[0].nonzero()[0].tolist() == [PICK_TARGET]


def test_a_push_that_made_no_room_may_make_room_when_it_is_repeated(loaded):
    graph = TrayGraph()
    pushed = ((VERB[PUSH_TARGET], 0),)
    graph.saw(pushed, TrayState.seen(loaded.tray))  # the tray is looked at again, and another push is possible
    lived_through(graph, loaded, [(PUSH_TARGET, 0, MISSED), (PICK_NEIGHBOUR, 2, MISSED)])
    first, then = graph.nodes(()), graph.nodes(pushed)
    assert first.answered[0, [PUSH_TARGET, PICK_NEIGHBOUR]].all()
    assert then.answered[0, PICK_NEIGHBOUR]
    assert not then.answered[0, PUSH_TARGET]


def test_untried_acts_are_hoped_for_by_the_unknown_type_alone():
    available = np.array([[True, True, True]])
    results = np.ones((2, 1, 2, 1))
    rewards = np.array([1.0, -5.0]).reshape(1, 1, 2, 1) * np.ones((2, 1, 1, 1))
    model = OutcomeModel(available, results, rewards, np.ones((1, 2, 1), int), np.array([[True, False]]), 10.0, 4)
    plan = OutcomePlanner(model, new=1).plan()
    assert plan.acts.tolist() == [0, 1]
    np.testing.assert_allclose(plan.values, [[1.0, 10.0], [1.0, 10.0]])
    assert OutcomePlanner(model, new=1, allowed=np.array([True, False, True])).plan().acts.tolist() == [0, 0]
