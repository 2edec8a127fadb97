"""Adapting an interface to a user of unknown skill (thesis §4.8, BEAT, Algorithm 9, Eq. 4.8 and 4.9).

A user steers along a line from beside a ditch to a goal at its end. A fast stick is best for a skilled user; with
it a clumsy user falls into the ditch. The action set is the speed of the stick, the type how often a move slips.

    python examples/plain/beat.py
"""

import numpy as np

DITCH, START, GOAL, LENGTH = 0, 2, 11, 12  # cells of the line
SPEEDS = (1, 3)  # the action sets: cells a move
SLIPS = (0.02, 0.3)  # the types: how often a move goes the other way
GAMMA = 0.99
BACK, AHEAD = -1, 1


def transitions(slip: float, speed: int) -> np.ndarray:
    """T(s' | s, a; τ) of an action set, (cells, 2, cells); the goal and the ditch are left no more."""
    T = np.zeros((LENGTH, 2, LENGTH))
    for s in range(LENGTH):
        for a, way in enumerate((BACK, AHEAD)):
            if s in (GOAL, DITCH):
                T[s, a, s] = 1.0
                continue
            for went, p in ((way, 1 - slip), (-way, slip)):
                T[s, a, min(max(s + went * speed, 0), LENGTH - 1)] += p
    return T


def value(T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """V(s) and the best action of each cell, by value iteration: -1 a move, +10 at the goal, -100 in the ditch."""
    R = np.full(LENGTH, -1.0)
    R[[GOAL, DITCH]] = 10.0, -100.0
    V = np.zeros(LENGTH)
    while True:
        Q = (T * (R + GAMMA * V)).sum(axis=2)
        Q[[GOAL, DITCH]] = 0.0
        if np.abs(Q.max(axis=1) - V).max() < 1e-12:
            return V, Q.argmax(axis=1)
        V = Q.max(axis=1)


def update(beta: np.ndarray, T: np.ndarray, s: int, a: int, after: int) -> np.ndarray:
    """β^{t+1}(τ) ∝ T(s' | s, a; τ) β^t(τ) (line 6); `T` is (types, cells, 2, cells) of the action set in force."""
    new = T[:, s, a, after] * beta
    return new / new.sum() if new.sum() > 0 else beta


def best_action_set(beta: np.ndarray, V: np.ndarray) -> int:
    """α_BO = arg max_α Σ_i V^α(τ_i) β(τ_i) (Eq. 4.9); under the prior this is Eq. 4.8. `V` is (types, sets)."""
    return int((beta @ V).argmax())


def session(true_type: int, generator: np.random.Generator, episodes: int = 5, epsilon: float = 0.0):
    """The action set in force at the start of each episode, and the belief at the end."""
    T = np.array([[transitions(slip, speed) for speed in SPEEDS] for slip in SLIPS])
    solved = [[value(T[t, z]) for z in range(len(SPEEDS))] for t in range(len(SLIPS))]
    V = np.array([[found[0][START] for found in row] for row in solved])  # line 2
    beta, used = np.full(len(SLIPS), 1 / len(SLIPS)), []
    for _ in range(episodes):
        s = START
        used.append(best_action_set(beta, V))
        for _ in range(50):
            explores = generator.random() < epsilon
            z = int(generator.integers(len(SPEEDS))) if explores else best_action_set(beta, V)
            a = int(solved[true_type][z][1][s])  # the user knows her type and acts best (§4.8.3)
            after = int(generator.choice(LENGTH, p=T[true_type, z, s, a]))
            beta = update(beta, T[:, z], s, a, after)
            s = after
            if s in (GOAL, DITCH):
                break
    return used, beta


def main() -> None:
    for t, name in enumerate(("skilled", "clumsy")):
        used, beta = session(t, np.random.default_rng(t))
        print(f"a {name} user: speeds {[SPEEDS[z] for z in used]}, belief {beta.round(2).tolist()}")


if __name__ == "__main__":
    main()
