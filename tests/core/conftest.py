"""Plain slow twins and random worlds that the tests of the kernels share."""

import numpy as np
import pytest

from lifelore.core.mdp import COLLISION, TERMINAL, Tables

MASK = 2**64 - 1


class BigRandom:
    """xoroshiro128+ (Blackman and Vigna, constants 24, 16, 37) on Python's whole numbers."""

    def __init__(self, state):
        self.s0, self.s1 = (int(word) for word in state)

    def bits(self) -> int:
        result = (self.s0 + self.s1) & MASK
        self.s1 ^= self.s0
        self.s0 = _rotated(self.s0, 24) ^ self.s1 ^ ((self.s1 << 16) & MASK)
        self.s1 = _rotated(self.s1, 37)
        return result

    def uniform(self) -> float:
        return (self.bits() >> 11) / 2**53

    @property
    def state(self) -> list[int]:
        return [self.s0, self.s1]


def _rotated(word: int, by: int) -> int:
    return ((word << by) | (word >> (64 - by))) & MASK


def naive_q_learning(tables, rows, schedule, world_state, own_state) -> dict:
    """ε-greedy Q-learning as a textbook has it, episode by episode, on lists."""
    world, own = BigRandom(world_state), BigRandom(own_state)
    n_rows, n_actions = int(rows.q_row.max()) + 1, tables.n_actions
    q = [[0.0] * n_actions for _ in range(n_rows)]
    visits = [[0] * n_actions for _ in range(n_rows)]
    out = {"returns": [], "rewards": [], "steps": [], "collisions": [], "reached": []}
    for epsilon, alpha in zip(schedule.epsilon, schedule.alpha, strict=True):
        state = int(tables.starts[int(world.uniform() * len(tables.starts))])
        reward_class, ended, rewards, bumps = 0, False, [], 0
        while not ended and len(rewards) < schedule.max_steps:
            row, context = rows.q_row[state], rows.context_row[state, reward_class]
            action = _naive_choice(q[row], rows.explore_cum[context], rows.tie_weight[context], epsilon, own)
            outcome = 0
            if tables.n_outcomes > 1:
                own_cum = tables.by_pair.outcome_cum[state, action]
                outcome = int(np.searchsorted(own_cum, world.uniform(), side="right"))
            reward = float(tables.reward[state, action, outcome])
            event = int(tables.event[state, action, outcome])
            following = int(tables.next_state[state, action, outcome])
            ended = event & TERMINAL != 0
            after = 0.0 if ended else max(q[rows.q_row[following]])
            # With an ended episode, r + γ·0 is r to the bit.
            q[row][action] += alpha * (reward + schedule.discount * after - q[row][action])
            visits[row][action] += 1
            bumps += event & COLLISION != 0
            reward_class = int(rows.reward_class[state, action, outcome])
            rewards.append(reward)
            state = following
        discounted, reach = 0.0, 1.0
        for reward in rewards:
            discounted += reach * reward
            reach *= schedule.discount
        for name, value in zip(out, (discounted, sum(rewards), len(rewards), bumps, ended), strict=True):
            out[name].append(value)
    return {"q": q, "visits": visits, "world": world.state, "own": own.state, **out}


def _naive_choice(values, explore_cum, tie_weight, epsilon, own) -> int:
    if epsilon > 0 and own.uniform() < epsilon:
        return int(np.searchsorted(explore_cum, own.uniform(), side="right"))
    tied = [a for a, value in enumerate(values) if value == max(values)]
    if len(tied) == 1:
        return tied[0]
    weights = [float(tie_weight[a]) for a in tied]
    left = own.uniform() * sum(weights)
    for action, weight in zip(tied, weights, strict=True):
        left -= weight
        if left < 0:
            return action
    return tied[-1]


def random_world(seed: int, n_states=8, n_actions=3, n_outcomes=1) -> Tables:
    """Tables drawn at random: some moves refused, some terminal, every state may be a start."""
    random = np.random.default_rng(seed)
    shape = (n_states, n_actions, n_outcomes)
    next_state = random.integers(0, n_states, shape).astype(np.int32)
    event = random.choice([0, 0, 0, 0, TERMINAL, COLLISION, COLLISION], shape).astype(np.uint8)
    here = np.broadcast_to(np.arange(n_states)[:, None, None], shape)
    next_state = np.where(event == COLLISION, here, next_state).astype(np.int32)
    # Whole rewards make ties between actions common.
    reward = random.integers(-2, 3, shape).astype(float)
    probs = random.dirichlet(np.ones(n_outcomes))
    cum = np.cumsum(probs)
    cum[-1] = 1.0
    return Tables(next_state, reward, event, cum, np.arange(n_states, dtype=np.int32))


def random_layers(seed: int, n_layers=5, size=4, n_actions=3, n_outcomes=1, reach=None) -> Tables:
    """`random_world` in layers that lead to themselves and onwards, by at most `reach` layers."""
    tables = random_world(seed, n_layers * size, n_actions, n_outcomes)
    random = np.random.default_rng(seed + 1)
    layer = np.arange(n_layers * size)[:, None, None] // size
    onwards = random.choice([0, 0, 1, reach or n_layers], tables.next_state.shape)
    target = np.minimum(layer + random.integers(0, onwards + 1), n_layers - 1)
    moved = target * size + tables.next_state % size
    next_state = np.where(tables.event == COLLISION, tables.next_state, moved).astype(np.int32)
    return tables._replace(next_state=next_state, starts=np.arange(size, dtype=np.int32))


@pytest.fixture(scope="session")
def draw_layers():
    return random_layers


@pytest.fixture(scope="session")
def big_random():
    return BigRandom


@pytest.fixture(scope="session")
def naive_learn():
    return naive_q_learning


@pytest.fixture(scope="session")
def draw_world():
    return random_world
