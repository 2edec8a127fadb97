"""The planner of the model-based learner against a naive Dijkstra; distances against SciPy."""

import heapq

import numpy as np
import pytest
import scipy.sparse.csgraph
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.compiled.random_state import random_state
from lifelore.core.learning.known_world import DEAD_END, GOAL, LOOKED, NOT_LOOKED, UNKNOWN, goal_distances
from lifelore.core.learning.model_learning import StateInfo, new_model_learner
from lifelore.core.learning.search_plan import NO_CRUMBS, OUT_OF_REACH, plan_search
from lifelore.core.streams import stream

seeds = st.integers(0, 10**6)


def knowledge(seed: int, n_states=10, n_actions=3, goal=False):
    """Known moves, places and costs of trying, drawn at random; state 0 is where one stands."""
    random = np.random.default_rng(seed)
    target = random.integers(0, n_states, (n_states, n_actions)).astype(np.int32)
    target[random.random(target.shape) < random.choice([0.05, 0.3])] = UNKNOWN
    place = random.choice([NOT_LOOKED, LOOKED, LOOKED, LOOKED, DEAD_END], n_states).astype(np.int8)
    place[0] = LOOKED
    if goal:
        place[1:][random.random(n_states - 1) < 0.2] = GOAL
    cost_row = random.integers(0, 2, n_states).astype(np.int32)
    try_cost = random.choice([0.0, 0.0, 2.0, 7.5], (2, n_actions))
    return target, place, cost_row, try_cost


def planned(
    target, place, cost_row, try_cost, exhaustive=False, seed=0, start=0, wanted=-1, later=()
) -> list[int]:
    """The actions of `plan_search`, first one first; OUT_OF_REACH alone if the wanted place is out of reach."""
    desk = new_model_learner(*target.shape, stream(0, "world"), stream(0, "own"))
    own, on_tour = random_state(stream(seed, "own")), np.isin(np.arange(len(place)), later)
    learner = desk._replace(place=place, own_random=own, later=on_tour)
    info = StateInfo(np.zeros(len(place), np.int64), cost_row, try_cost)
    length = plan_search(start, target, info, learner, bool((place == GOAL).any()), exhaustive, wanted)
    assert (desk.parent == UNKNOWN).all()  # as it was, whatever the search reached
    if length == OUT_OF_REACH:
        return [OUT_OF_REACH]
    return [int(a) for a in desk.plan[:length][::-1]]


def crumbs(t, target, place) -> int:
    return sum(x not in (UNKNOWN, t) and place[x] == NOT_LOOKED for x in target[t].tolist())


def naive_candidates(target, place, cost_row, try_cost, start=0):
    """(kind, cost) of everything worth doing, by Dijkstra over all known moves but bad ones."""
    n_actions = target.shape[1]
    goal_known = (place == GOAL).any()
    crumb = min(NO_CRUMBS, 1 / (n_actions + 1))
    found, settled, heap = {}, set(), [(0, start)]
    while heap:
        steps, s = heapq.heappop(heap)
        if s in settled:
            continue
        settled.add(s)
        for a in range(n_actions):
            t = int(target[s, a])
            if t == UNKNOWN:
                found[s, a] = ("try", steps + 1 + try_cost[cost_row[s], a])
            elif place[t] == GOAL:
                found[s, a] = ("goal", steps + 1)
            elif place[t] == NOT_LOOKED and not goal_known:
                found[s, a] = ("look", steps + 1 + crumb * crumbs(t, target, place))
                heapq.heappush(heap, (steps + 1, t))
            elif place[t] != DEAD_END:
                heapq.heappush(heap, (steps + 1, t))
    return found


def followed(plan, target, start=0):
    """The (state, action) at which a plan ends; every move before it must be known."""
    s = start
    for a in plan[:-1]:
        assert target[s, a] != UNKNOWN
        s = int(target[s, a])
    return s, plan[-1]


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(seeds, st.booleans(), st.booleans(), st.sampled_from([2, 3, 4, 8]))
def test_what_is_planned_is_a_cheapest(seed, goal, exhaustive, n_actions):
    target, place, cost_row, try_cost = knowledge(seed, n_actions=n_actions, goal=goal)
    candidates = naive_candidates(target, place, cost_row, try_cost)
    plan = planned(target, place, cost_row, try_cost, exhaustive, seed)
    if exhaustive and any(kind != "goal" for kind, _ in candidates.values()):
        candidates = {at: found for at, found in candidates.items() if found[0] != "goal"}
    assert bool(plan) == bool(candidates)
    if plan:
        end = followed(plan, target)
        assert end in candidates
        kind, cost = candidates[end]
        assert cost == pytest.approx(min(cost for _, cost in candidates.values()), abs=1e-9)
        assert len(plan) == pytest.approx(cost - _extra(kind, end, target, place, cost_row, try_cost))


def _extra(kind, end, target, place, cost_row, try_cost) -> float:
    s, a = end
    if kind == "try":
        return try_cost[cost_row[s], a]
    crumb = min(NO_CRUMBS, 1 / (target.shape[1] + 1))
    return crumb * crumbs(int(target[s, a]), target, place) if kind == "look" else 0.0


@settings(max_examples=40, deadline=None)
@given(seeds)
def test_goal_distances_are_scipys(seed):
    target, place, *_ = knowledge(seed, n_states=15, goal=True)
    walkable = np.flatnonzero(place != DEAD_END)
    graph = np.zeros((15, 15))
    for s in walkable:
        for t in target[s]:
            if t != UNKNOWN and place[t] != DEAD_END:
                graph[s, t] = 1
    distance = scipy.sparse.csgraph.shortest_path(scipy.sparse.csr_matrix(graph), unweighted=True)
    goals = np.flatnonzero(place == GOAL)
    nearest = distance[:, goals].min(axis=1, initial=np.inf)
    nearest[place == DEAD_END] = np.inf
    expected = np.where(np.isinf(nearest), -1, nearest)
    assert goal_distances(target, place).tolist() == expected.tolist()
