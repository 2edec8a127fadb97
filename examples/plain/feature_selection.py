"""Selecting the features of an action prior by entropy (thesis §3.3.2, Eq. 3.9-3.11, Algorithms 5 and 6).

Six features, two of which decide what is sensible. Algorithm 5 removes each feature in turn and selects those
whose removal raises the entropy of the actions by at least ω, here the mean rise (§3.3.3).

    python examples/plain/feature_selection.py
"""

import numpy as np

ALPHA0 = 0.1
NAMES = ("wall ahead", "door left", "colour", "hour", "noise", "floor")


def marginalised(phi: np.ndarray, alpha: np.ndarray, kept: list[int]) -> tuple[np.ndarray, np.ndarray]:
    """The configurations of the features `kept`, and α summed over all others, (K, n_actions)."""
    rows, index = np.unique(phi[:, kept], axis=0, return_inverse=True)
    summed = np.zeros((len(rows), alpha.shape[1]))
    np.add.at(summed, index.ravel(), alpha)
    return rows, summed


def action_entropy(alpha: np.ndarray, action: int) -> float:
    """H̄_φ(a) (Eq. 3.9): Σ_i P(φ^i) H[P(a | φ^i)] with H[p] = -p log2 p."""
    total = alpha.sum(axis=1)
    p_phi = total / total.sum()
    p = np.divide(alpha[:, action], total, out=np.zeros(len(alpha)), where=total > 0)
    return float(-(p_phi * p * np.log2(np.where(p > 0, p, 1.0))).sum())


def entropy(alpha: np.ndarray) -> float:
    """H_φ (Eq. 3.10, 3.11): the sum over the actions, in bits."""
    return sum(action_entropy(alpha, action) for action in range(alpha.shape[1]))


def rises(phi: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Δ_f of each feature: the rise in entropy when it is removed (Algorithm 5, lines 1 to 6)."""
    features = range(phi.shape[1])
    full = entropy(marginalised(phi, alpha, list(features))[1])
    without = [entropy(marginalised(phi, alpha, [g for g in features if g != f])[1]) for f in features]
    return np.array(without) - full


def select(phi: np.ndarray, alpha: np.ndarray, omega: float | None = None) -> list[int]:
    """The selected features (Algorithm 5); ω is the mean rise by default (Algorithm 6)."""
    delta = rises(phi, alpha)
    return np.flatnonzero(delta >= (delta.mean() if omega is None else omega)).tolist()


def one_task(generator: np.random.Generator, n_states: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """The features of a task's states (n_states, 6), and its best actions (n_states, 3) as 0 and 1."""
    phi = generator.integers(0, 2, size=(n_states, len(NAMES)))
    wall, door = phi[:, 0], phi[:, 1]
    best = np.where(wall == 0, 0, np.where(door == 1, 1, 2))  # go on; through the door; turn
    confused = generator.random(n_states) < 0.1
    best = np.where(confused, generator.integers(0, 3, n_states), best)
    return phi, np.eye(3)[best]


def main() -> None:
    generator = np.random.default_rng(0)
    phi, useful, chosen = np.empty((0, len(NAMES)), int), np.empty((0, 3)), list(range(len(NAMES)))
    for task in range(1, 11):  # Algorithm 6: after each task the full prior is updated, then features are selected
        new_phi, new_useful = one_task(generator)
        phi, useful = np.vstack([phi, new_phi]), np.vstack([useful, new_useful])
        chosen = select(phi, useful)
        if task in (1, 3, 10):
            print(f"after {task:2} tasks:", ", ".join(NAMES[f] for f in chosen))
    _, alpha = marginalised(phi, useful, chosen)
    theta = (alpha + ALPHA0) / (alpha + ALPHA0).sum(axis=1, keepdims=True)
    print("θ by configuration:", theta.round(2).tolist())


if __name__ == "__main__":
    main()
