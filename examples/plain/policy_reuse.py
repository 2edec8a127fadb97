"""Bayesian policy reuse (thesis §4.2-4.5, Algorithms 7 and 8), on golf clubs as in §4.6.1.

A hole of unknown distance, a type for each known distance, a policy for each club. After each shot the robot sees
only a category (long, near, short), updates its belief (Eq. 4.1) and selects the next club by a rule.

The rules are the standard ones of these names; what the thesis prints differs (docs/errata.md, E45 to E49).

    python examples/plain/policy_reuse.py
"""

from math import erf, sqrt

import numpy as np

CLUBS = {"3-wood": (215.0, 8.0), "3-iron": (180.0, 7.2), "6-iron": (150.0, 6.0), "9-iron": (115.0, 4.4)}
HOLES = (110.0, 150.0, 170.0, 220.0)
BORDERS = (-20.0, -5.0, 5.0, 20.0)  # yards beyond the hole: far short, short, near, long, far long
SHOTS = 3


def normal_cdf(x: float) -> float:
    """P(X ≤ x) of the standard normal distribution."""
    return 0.5 * (1 + erf(x / sqrt(2)))


def models() -> tuple[np.ndarray, np.ndarray]:
    """E[U | τ, π], (types, policies): minus the mean distance; F(σ | τ, π), (types, policies, categories)."""
    utility, signals = np.empty((4, 4)), np.empty((4, 4, 5))
    for t, hole in enumerate(HOLES):
        for p, (mean, sd) in enumerate(CLUBS.values()):
            m = mean - hole  # the distance is |N(m, sd)|, a folded normal
            spread = sd * sqrt(2 / np.pi) * np.exp(-(m**2) / (2 * sd**2))
            utility[t, p] = -(spread + m * (1 - 2 * normal_cdf(-m / sd)))
            edges = [0.0, *(normal_cdf((border - m) / sd) for border in BORDERS), 1.0]
            signals[t, p] = np.diff(edges)
    return utility, signals


def update(beta: np.ndarray, F: np.ndarray, policy: int, signal: int) -> np.ndarray:
    """β^t(τ) ∝ F(σ | τ, π) β^{t-1}(τ) (Eq. 4.1); a signal that no type explains leaves the belief."""
    new = F[:, policy, signal] * beta
    return new / new.sum() if new.sum() > 0 else beta


def expected_utility(beta: np.ndarray, U: np.ndarray) -> np.ndarray:
    """Ũ(π) = Σ_τ β(τ) E[U | τ, π] (Eq. 4.5)."""
    return beta @ U


def expected_improvement(beta: np.ndarray, U: np.ndarray) -> np.ndarray:
    """Σ_τ β(τ) max(E[U | τ, π] - U^t, 0) with U^t = max Ũ (§4.5.2.1); Ũ where nothing can improve."""
    now = expected_utility(beta, U)
    improvement = beta @ np.maximum(U - now.max(), 0.0)
    return improvement if improvement.max() > 1e-9 * np.ptp(U) else now


def entropy(beta: np.ndarray) -> float:
    """H(β) in nats."""
    return float(-(beta * np.log(np.where(beta > 0, beta, 1.0))).sum())


def posteriors(beta: np.ndarray, F: np.ndarray, policy: int):
    """P(σ | π) and the belief after σ, for every signal that can come."""
    for signal, p in enumerate(beta @ F[:, policy]):
        if p > 0:
            yield p, F[:, policy, signal] * beta / p


def belief_entropy(beta: np.ndarray, U: np.ndarray, F: np.ndarray, kappa: float) -> np.ndarray:
    """Ũ(π) + κ (H(β) - E_σ H(β after σ)): utility, and κ for each nat of information (§4.5.2.2)."""
    after = [sum(p * entropy(b) for p, b in posteriors(beta, F, policy)) for policy in range(U.shape[1])]
    return expected_utility(beta, U) + kappa * (entropy(beta) - np.array(after))


def knowledge_gradient(beta: np.ndarray, U: np.ndarray, F: np.ndarray, left: int) -> np.ndarray:
    """Ũ(π) + (K - t) (E_σ max Ũ after σ - max Ũ) (Eq. 4.6)."""
    now = expected_utility(beta, U)
    after = [
        sum(p * expected_utility(b, U).max() for p, b in posteriors(beta, F, policy))
        for policy in range(U.shape[1])
    ]
    return now + left * (np.array(after) - now.max())


def play(rule, distance: float, generator: np.random.Generator) -> float:
    """The utility of the last of `SHOTS` shots at a hole of this distance (Algorithm 8)."""
    U, F = models()
    beta, yards = np.full(len(HOLES), 1 / len(HOLES)), 0.0
    for t in range(SHOTS):
        policy = int(rule(beta, U, F, SHOTS - 1 - t).argmax())
        mean, sd = list(CLUBS.values())[policy]
        yards = generator.normal(mean, sd) - distance
        beta = update(beta, F, policy, int(np.searchsorted(BORDERS, yards)))
    return -abs(yards)


RULES = {
    "greedy": lambda beta, U, F, left: expected_utility(beta, U),
    "expected improvement": lambda beta, U, F, left: expected_improvement(beta, U),
    "belief entropy": lambda beta, U, F, left: belief_entropy(beta, U, F, kappa=20.0),
    "knowledge gradient": knowledge_gradient,
}


def main() -> None:
    for name, rule in RULES.items():
        shots = [play(rule, d, np.random.default_rng(run)) for run in range(100) for d in (112, 152, 179, 217)]
        print(f"{name:22} last shot {-np.mean(shots):5.1f} yards from the hole")


if __name__ == "__main__":
    main()
