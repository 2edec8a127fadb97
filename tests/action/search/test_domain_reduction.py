"""Domain reduction: Alg. 3 by hand, the counterexamples, and properties over random small domains."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.action.search.domain_reduction import (
    domain_futile_actions,
    domain_futile_states,
    futile_goal_probability,
    minimised_domain,
    minimised_transitions,
    reachable_states,
    tables_within,
    task_futile_actions,
    task_futile_states,
    trap_states,
)
from lifelore.core import TERMINAL, InputError, Tables, optimal_q

DISCOUNT = 0.9


def goal_task(follow, goal: int, starts, outcomes=(1.0,)) -> Tables:
    """Reach `goal` for a reward of 1; `follow` is (n_states, n_actions) or with outcomes as a third axis."""
    follow = np.asarray(follow, np.int32).reshape(len(follow), -1, len(outcomes))
    there = follow == goal
    cum = np.cumsum(outcomes)
    cum[-1] = 1.0
    event = np.where(there, TERMINAL, 0).astype(np.uint8)
    return Tables(follow, there.astype(float), event, cum, np.asarray(starts, np.int32))


def best_of(tables: Tables, goal: int) -> np.ndarray:
    ended = np.arange(tables.n_states) == goal
    return actions_to_count(optimal_q(tables, DISCOUNT), "all", ended=ended)


@st.composite
def task_sets(draw):
    """Tasks of one random domain: goals in it, starts elsewhere, one or two outcomes an action."""
    n_states, n_actions = draw(st.integers(2, 6)), draw(st.integers(1, 3))
    outcomes = draw(st.sampled_from([(1.0,), (0.75, 0.25), (0.1, 0.2, 0.7)]))
    shape = (n_states, n_actions, len(outcomes))
    size = int(np.prod(shape))
    follow = np.array(draw(st.lists(st.integers(0, n_states - 1), min_size=size, max_size=size))).reshape(shape)
    tasks, policies = [], []
    for _ in range(draw(st.integers(1, 3))):
        goal = draw(st.integers(0, n_states - 1))
        others = [s for s in range(n_states) if s != goal]
        starts = sorted(draw(st.sets(st.sampled_from(others), min_size=1)))
        tasks.append(goal_task(follow, goal, starts, outcomes))
        policies.append(best_of(tasks[-1], goal))
    return tasks, policies


def naive_reach(tables: Tables, best) -> set[int]:
    """Alg. 3 word for word, but that nothing is done once the episode is over."""
    acting = set(tables.starts.tolist())
    while True:
        entered, going_on = set(), set()
        for s in acting:
            for a in range(tables.n_actions):
                for k in range(len(tables.outcome_cum)):
                    if best[s, a]:
                        entered.add(int(tables.next_state[s, a, k]))
                        if not tables.event[s, a, k] & TERMINAL:
                            going_on.add(int(tables.next_state[s, a, k]))
        if going_on <= acting:
            return acting | entered
        acting |= going_on


# ---- by hand -----------------------------------------------------------------------------------------------

# A corridor 0 - 1 - 2 - 3 - 4; actions left and right.
CORRIDOR = [(max(s - 1, 0), min(s + 1, 4)) for s in range(5)]


def test_futile_states_and_actions_by_hand():
    east = goal_task(CORRIDOR, 3, [1])
    best = best_of(east, 3)
    assert best.tolist() == [[False, True], [False, True], [False, True], [False, False], [True, False]]
    assert reachable_states(east, best).tolist() == [False, True, True, True, False]
    assert task_futile_states(east, best).tolist() == [True, False, False, False, True]
    assert task_futile_actions(best)[1].tolist() == [True, False]
    west = goal_task(CORRIDOR, 0, [2])
    both, policies = [east, west], [best, best_of(west, 0)]
    assert domain_futile_states(both, policies).tolist() == [False, False, False, False, True]
    # In 0 west's episode is over and east goes right, in 3 the other way about; in 4 both would go left.
    futile = [[True, False], [False, False], [False, False], [False, True], [False, True]]
    assert domain_futile_actions(policies).tolist() == futile


# ---- E8: the printed definition can be left --------------------------------------------------------------------


def printed_and_repaired(tasks, policies):
    return (minimised_domain(tasks, policies, form) for form in ("printed", "repaired"))


def test_the_counterexample_of_errata_e8():
    # Both start in 0. Task 1: goal 1, by 0 -a-> 1; from 2, where it never comes, it would go 2 -b-> 3 -a-> 1.
    # Task 2: goal 4, by 0 -b-> 2 -a-> 4.
    follow = [(1, 2), (1, 1), (4, 3), (1, 1), (4, 4)]
    tasks = [goal_task(follow, 1, [0]), goal_task(follow, 4, [0])]
    policies = [best_of(tasks[0], 1), best_of(tasks[1], 4)]
    printed, repaired = printed_and_repaired(tasks, policies)
    assert printed.states.tolist() == repaired.states.tolist() == [True, True, True, False, True]
    assert np.argwhere(printed.without_successor).tolist() == [[2, 1]]  # η = 1/0
    assert np.argwhere(printed.leading_out).tolist() == [[2, 1]]
    assert not repaired.leading_out.any()
    assert np.argwhere(repaired.pairs).tolist() == [[0, 0], [0, 1], [2, 0]]


@pytest.mark.slow
@settings(max_examples=40)
@given(task_sets())
def test_the_repaired_domain_keeps_each_tasks_optimal_return(case):
    # Theorem 3.2.6, both parts: the same return from every start, and every optimal action still best.
    tasks, policies = case
    domain = minimised_domain(tasks, policies)
    for tables, best in zip(tasks, policies, strict=True):
        for dead_ends in ("stay", "free"):
            q = optimal_q(tables_within(tables, domain.pairs, dead_ends), DISCOUNT)
            whole = optimal_q(tables, DISCOUNT)
            assert q[tables.starts].max(axis=1) == pytest.approx(whole[tables.starts].max(axis=1), abs=1e-9)
            here = reachable_states(tables, best)[:, None] & best
            assert q[here] == pytest.approx(whole[here], abs=1e-9)


@pytest.mark.slow
@settings(max_examples=40)
@given(task_sets())
def test_the_closed_domain_is_never_left_and_keeps_every_policy(case):
    tasks, policies = case
    domain, repaired = (minimised_domain(tasks, policies, form) for form in ("closed", "repaired"))
    states = {int(s) for tables in tasks for s in tables.starts}
    kept = {(s, a) for best in policies for s, a in np.argwhere(best)}
    for _ in range(tasks[0].n_states):
        states |= {int(t) for s, a in kept if s in states for t in tasks[0].next_state[s, a]}
    assert set(np.flatnonzero(domain.states)) == states
    assert {tuple(pair) for pair in np.argwhere(domain.pairs)} == {(s, a) for s, a in kept if s in states}
    assert not domain.leading_out.any()
    assert not (repaired.pairs & ~domain.pairs).any()
    # Wherever another's steps have led, a task goes on as if nothing were missing (E36).
    for tables, best in zip(tasks, policies, strict=True):
        within = optimal_q(tables_within(tables, domain.pairs, "stay"), DISCOUNT)
        own = domain.states[:, None] & best
        assert within[own] == pytest.approx(optimal_q(tables, DISCOUNT)[own], abs=1e-9)


@pytest.mark.slow
@settings(max_examples=40)
@given(task_sets())
def test_reach_and_futility_are_the_definitions(case):
    tasks, policies = case
    reached = [naive_reach(tables, best) for tables, best in zip(tasks, policies, strict=True)]
    for tables, best, states in zip(tasks, policies, reached, strict=True):
        assert set(np.flatnonzero(reachable_states(tables, best))) == states
    n_states, n_actions = policies[0].shape
    futile = {s for s in range(n_states) if all(s not in states for states in reached)}
    assert set(np.flatnonzero(domain_futile_states(tasks, policies))) == futile
    printed, repaired = printed_and_repaired(tasks, policies)
    for s in range(n_states):
        for a in range(n_actions):
            assert printed.pairs[s, a] == (s not in futile and any(best[s, a] for best in policies))
            own = any(s in states and best[s, a] for states, best in zip(reached, policies, strict=True))
            assert repaired.pairs[s, a] == own


# ---- traps: Prop. 3.2.7 ----------------------------------------------------------------------------------------


def test_the_minimised_domain_can_have_traps_where_the_domain_has_none():
    # In the middle of a corridor one task goes left, the other right. Whoever, learning the first, tries the step
    # that only the second takes cannot come back: all that is kept there leads on to the right.
    tasks = [goal_task(CORRIDOR, 0, [2]), goal_task(CORRIDOR, 4, [2])]
    domain = minimised_domain(tasks, [best_of(tasks[0], 0), best_of(tasks[1], 4)])
    assert domain.states.all()
    assert np.argwhere(domain.pairs).tolist() == [[1, 0], [2, 0], [2, 1], [3, 1]]
    assert not trap_states(tasks[0]).any()
    assert np.flatnonzero(trap_states(tasks[0], domain.pairs)).tolist() == [3, 4]
    assert np.flatnonzero(trap_states(tasks[1], domain.pairs)).tolist() == [0, 1]


# ---- Eq. 3.6 ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("n_actions", [2, 4, 6])
@pytest.mark.parametrize("alpha0", [0.1, 1.0, 7.0])
def test_the_worst_case_is_the_priors_own_proportion(n_actions, alpha0):
    # All actions but the last tied best in each of the tasks.
    prior = ActionPrior(n_actions, alpha0)
    for n_tasks in range(4):
        expected = prior.probs([0])[0, -1]
        assert futile_goal_probability(n_actions, n_tasks, alpha0) == pytest.approx(expected, rel=1e-12)
        prior.update([0], [[True] * (n_actions - 1) + [False]])
    assert futile_goal_probability(n_actions, 0, alpha0) == pytest.approx(1 / n_actions)


# ---- rules -----------------------------------------------------------------------------------------------------

TASK = goal_task(CORRIDOR, 4, [0])
BEST = best_of(TASK, 4)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: minimised_domain([], []), "a policy for each task, at least one, got 0 and 0"),
        (lambda: minimised_domain([TASK], [BEST, BEST]), "got 1 and 2"),
        (lambda: minimised_domain([TASK], [BEST[:2]]), r"best must have shape \(5, 2\), got \(2, 2\)"),
        (
            lambda: minimised_domain([TASK, goal_task([(0, 0)] * 5, 0, [1])], [BEST, BEST]),
            "tasks must share their transitions .*, got others in task 1",
        ),
        (
            lambda: minimised_domain([TASK, goal_task([(0,)] * 5, 0, [1])], [BEST, BEST[:, :1]]),
            "tasks must be of one domain, got task 1 with other",
        ),
        (lambda: minimised_transitions(TASK, minimised_domain([TASK], [BEST])), r"tasks must be a list of Tables"),
        (lambda: futile_goal_probability(0, 1, 0.1), "n_actions must be at least 1"),
        (lambda: futile_goal_probability(2, -1, 0.1), "n_tasks at least 0"),
        (lambda: futile_goal_probability(2, 1, 0.0), "alpha0 positive"),
    ],
)
def test_broken_rules(call, message):
    with pytest.raises(InputError, match=message):
        call()


# ---- T̂, and what is refused --------------------------------------------------------------------------------


@settings(deadline=None, max_examples=40)
@given(task_sets(), st.sampled_from(["printed", "repaired", "closed"]))
def test_the_transitions_of_the_minimised_domain_term_by_term(drawn, form):
    tasks, policies = drawn
    tables, domain = tasks[0], minimised_domain(tasks, policies, form)
    found = minimised_transitions(tasks, domain)
    probs = np.diff(tables.outcome_cum, prepend=0.0)
    for s in range(tables.n_states):
        for a in range(tables.n_actions):
            own = {}
            for following, p in zip(tables.next_state[s, a].tolist(), probs, strict=True):
                if domain.pairs[s, a] and domain.states[following]:
                    own[following] = own.get(following, 0.0) + p
            eta = 1 / sum(own.values()) if own else 0.0
            row = found[a][[s]].toarray()[0]
            assert row == pytest.approx([eta * own.get(t, 0.0) for t in range(tables.n_states)])
            assert row.sum() == pytest.approx(float(domain.pairs[s, a] and not domain.without_successor[s, a]))


@pytest.mark.parametrize("first", [0, 1])
def test_the_goal_of_one_task_has_the_moves_of_another(first):
    # A line 0 - 1 - 2 - 3 in which the step right from 1 slips; matrices do not read the row of a task's goal.
    T = np.zeros((4, 2, 4))
    for s in range(4):
        T[s, 0, max(s - 1, 0)] = T[s, 1, min(s + 1, 3)] = 1.0
    T[1, 1] = [0.0, 0.25, 0.75, 0.0]
    tasks = [Tables.from_matrices(T, np.eye(4)[goal], terminal=goal, starts=[0]) for goal in (1, 2)]
    policies = [best_of(tasks[0], 1), best_of(tasks[1], 2)]
    tasks, policies = [tasks[first], tasks[1 - first]], [policies[first], policies[1 - first]]
    assert domain_futile_states(tasks, policies).tolist() == [False, False, False, True]
    domain = minimised_domain(tasks, policies)
    assert np.argwhere(domain.pairs).tolist() == [[0, 1], [1, 1]]
    assert minimised_transitions(tasks, domain)[1].toarray()[1].tolist() == [0.0, 0.25, 0.75, 0.0]
    assert minimised_domain(tasks, policies, "closed").states.tolist() == [True, True, True, False]
    other = T.copy()
    other[3, 0] = [1.0, 0.0, 0.0, 0.0]
    with pytest.raises(InputError, match=r"share their transitions .*, got others in task 2"):
        minimised_domain([*tasks, Tables.from_matrices(other, np.eye(4)[0], terminal=0)], [*policies, policies[0]])
