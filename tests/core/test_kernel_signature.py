"""The kernel's signature carries worlds that are yet to be built: table-only stubs of two of them."""

from itertools import product

import numpy as np
import pytest

from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.q_learning import Rows, Schedule, cumulative, learn, new_learner, uniform_rows
from lifelore.core.mdp import COLLISION, NOTHING, TERMINAL, Tables
from lifelore.core.planning.planning import optimal_q, policy_values
from lifelore.core.streams import stream

SIDE = 3
CELLS = SIDE * SIDE
MOVES = ((-1, 0), (1, 0), (0, 1), (0, -1))
PROCURE, ASSEMBLE = 4, 5
RAW, PROCURED, ASSEMBLED = range(3)


def moved(cell: int, action: int) -> int:
    row, column = divmod(cell, SIDE)
    row, column = row + MOVES[action][0], column + MOVES[action][1]
    return row * SIDE + column if 0 <= row < SIDE and 0 <= column < SIDE else cell


# ---- the factory (§3.4.3): a task's k components, each raw, procured or assembled -------------------


def factory(procure_at, assemble_at) -> Tables:
    """States (configuration, cell) of a task's own components: 3^k · cells of them, six actions."""
    k = len(procure_at)
    configurations = list(product(range(3), repeat=k))
    code = {configuration: i for i, configuration in enumerate(configurations)}
    shape = (len(configurations) * CELLS, 6, 1)
    next_state, reward, event = np.zeros(shape, np.int32), np.zeros(shape), np.zeros(shape, np.uint8)
    for configuration, cell, action in product(configurations, range(CELLS), range(6)):
        after, r, e, target = list(configuration), -1.0, NOTHING, cell
        if action < 4:
            target = moved(cell, action)
            e = COLLISION if target == cell else NOTHING
        else:
            stations, before = (procure_at, RAW) if action == PROCURE else (assemble_at, PROCURED)
            if cell in stations and configuration[stations.index(cell)] == before:
                after[stations.index(cell)] += 1
                r = 10.0
                if all(status == ASSEMBLED for status in after):
                    r, e = 110.0, TERMINAL
        s = code[configuration] * CELLS + cell
        next_state[s, action, 0] = code[tuple(after)] * CELLS + target
        reward[s, action, 0], event[s, action, 0] = r, e
    starts = np.arange(CELLS, dtype=np.int32)  # nothing procured, any cell
    return Tables(next_state, reward, event, np.ones(1), starts)


def test_factory_of_one_component_by_hand():
    tables = factory([0], [2])
    assert tables.n_states == 3 * CELLS
    # Upper left corner: procure (10), two moves east (-1 each), assemble (110).
    value = policy_values(tables, optimal_q(tables, 0.5).argmax(axis=1), 0.5)
    assert value[0] == pytest.approx(10 - 0.5 - 0.25 + 110 / 8)


@pytest.mark.parametrize("n_components", [1, 2, 3])
def test_factory_is_learnt_with_a_prior_over_configuration_and_cell(n_components, naive_learn):
    tables = factory([0, 8, 4][:n_components], [2, 6, 7][:n_components])
    assert tables.n_states == 3**n_components * CELLS
    best = optimal_q(tables, 0.9)
    useful = best >= best.max(axis=1, keepdims=True) - 1e-9
    explore = 0.7 * useful / useful.sum(axis=1, keepdims=True) + 0.3 / 6
    rows = uniform_rows(tables, explore)
    n = 3000
    plan = Schedule(np.full(n, 0.5), np.ones(n), 300, 0.9)
    who, curve = new_learner(tables.n_states, 6, stream(0, "w"), stream(0, "o")), new_curve(n)
    first = Schedule(plan.epsilon[:5], plan.alpha[:5], 300, 0.9)
    twin = naive_learn(tables, rows, first, who.world_random, who.own_random)
    learn(tables, rows, plan, who, curve, 10**9)
    assert curve.returns[:5].tolist() == twin["returns"]
    greedy = policy_values(tables, who.q.argmax(axis=1), 0.9)
    assert greedy[tables.starts] == pytest.approx(best.max(axis=1)[tables.starts], abs=1e-6)


# ---- Pacman (§4): a ghost the learner does not see ---------------------------------------------------

FOOD = CELLS - 1
CLASS_NOTHING, CLASS_BUMPED, CLASS_CAUGHT = range(3)


def pacman() -> tuple[Tables, Rows]:
    """World state (cell, ghost); Q and prior read the cell, the prior also the last reward's class."""
    shape = (CELLS * CELLS, 4, 4)
    next_state, reward, event = np.zeros(shape, np.int32), np.zeros(shape), np.zeros(shape, np.uint8)
    reward_class = np.zeros(shape, np.uint8)
    for cell, ghost, action, ghost_action in product(range(CELLS), range(CELLS), range(4), range(4)):
        index = cell * CELLS + ghost, action, ghost_action
        target, ghost_target = moved(cell, action), moved(ghost, ghost_action)
        next_state[index] = target * CELLS + ghost_target
        if target in (ghost, ghost_target):
            reward[index], event[index], reward_class[index] = -100.0, TERMINAL, CLASS_CAUGHT
        elif target == FOOD:
            reward[index], event[index] = 100.0, TERMINAL
        elif target == cell:
            reward[index], event[index], reward_class[index] = -10.0, COLLISION, CLASS_BUMPED
    cell_of = np.arange(CELLS * CELLS) // CELLS
    starts = np.flatnonzero((cell_of == 0) & (np.arange(CELLS * CELLS) % CELLS > 3)).astype(np.int32)
    tables = Tables(next_state, reward, event, np.array([0.4, 0.6, 0.9, 1.0]), starts)
    # One context a cell and reward class; after a bump another action than north is preferred.
    context_row = (cell_of[:, None] * 3 + np.arange(3)).astype(np.int32)
    explore = np.tile([[0.25] * 4, [0.1, 0.3, 0.3, 0.3], [0.25] * 4], (CELLS, 1))
    rows = Rows(cell_of.astype(np.int32), context_row, reward_class, cumulative(explore), explore)
    return tables, rows


def test_hidden_ghost_same_as_the_naive_twin(naive_learn):
    tables, rows = pacman()
    n = 200
    plan = Schedule(np.full(n, 0.2), np.full(n, 0.1), 50, 0.95)
    who, curve = new_learner(CELLS, 4, stream(1, "w"), stream(1, "o")), new_curve(n)
    twin = naive_learn(tables, rows, plan, who.world_random, who.own_random)
    learn(tables, rows, plan, who, curve, 10**9)
    assert who.q.shape == (CELLS, 4)
    assert np.array_equal(who.q, twin["q"])
    assert np.array_equal(curve.returns, twin["returns"])
    assert who.world_random.tolist() == twin["world"]


def test_hidden_ghost_is_learnt_as_well_as_a_learner_that_is_blind_to_it_can():
    tables, rows = pacman()
    n = 20_000
    plan = Schedule(np.full(n, 0.1), np.full(n, 0.05), 50, 0.95)
    who, curve = new_learner(CELLS, 4, stream(2, "w"), stream(2, "o")), new_curve(n)
    learn(tables, rows, plan, who, curve, 10**9)
    learnt = policy_values(tables, who.q.argmax(axis=1)[rows.q_row].astype(np.int32), 0.95)
    seeing = optimal_q(tables, 0.95).max(axis=1)
    # No policy of the cell alone beats one that sees the ghost, and the learnt one beats a fixed east.
    assert (learnt <= seeing + 1e-6).all()
    east = policy_values(tables, np.full(tables.n_states, 2), 0.95)
    assert learnt[tables.starts].mean() > east[tables.starts].mean() + 10
