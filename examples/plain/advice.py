"""When to advise an agent whose goal is hidden (thesis §3.7, Eq. 3.13-3.16).

Experts walk a corridor with a side room that leads nowhere. Their steps are the action prior θ. An explorer is
advised where KL[θ_s, P(A | s, H)] ≥ κ: where the models that explain its last steps say something else than θ.

    python examples/plain/advice.py
"""

import numpy as np

N_STATES, N_ACTIONS = 12, 3  # a corridor of cells 0 to 11; back, ahead, aside
BACK, AHEAD, ASIDE = range(N_ACTIONS)
KAPPA, ALPHA0, WINDOW = 0.3, 0.1, 300


def expert_counts(generator: np.random.Generator, walks: int = 40) -> np.ndarray:
    """α(s, a) of experts: nearly all of their steps lead ahead."""
    alpha = np.full((N_STATES, N_ACTIONS), ALPHA0)
    for _ in range(walks):
        for state in range(N_STATES):
            alpha[state, generator.choice(N_ACTIONS, p=[0.05, 0.9, 0.05])] += 1
    return alpha


def posterior(history: list[tuple[int, int]], models: np.ndarray) -> np.ndarray:
    """P(M | H) (Eq. 3.15) of models P(a | s, M), (n_models, n_states, n_actions), equally likely beforehand."""
    log = np.zeros(len(models))
    for state, action in history[-WINDOW:]:
        log += np.log(models[:, state, action])
    weight = np.exp(log - log.max())
    return weight / weight.sum()


def kl(p: np.ndarray, q: np.ndarray) -> float:
    """KL[p, q] in nats."""
    return float((p * np.log(p / q)).sum())


def gain(theta: np.ndarray, models: np.ndarray, history: list[tuple[int, int]], state: int) -> float:
    """What advice would tell in `state`: KL[θ_s, Σ_M P(A | s, M) P(M | H)] (Eq. 3.13, 3.14)."""
    expected = posterior(history, models) @ models[:, state]
    return kl(theta[state], expected)


def walk(theta, models, behaviour, generator, steps=12) -> list[str]:
    """A line for each step of an explorer with its own P(a | s); it follows advice."""
    lines, history, state = [], [], 0
    for _ in range(steps):
        found = gain(theta, models, history, state)
        advised = found >= KAPPA  # condition 3.16
        action = int(generator.choice(N_ACTIONS, p=theta[state] if advised else behaviour[state]))
        lines.append(f"cell {state:2}  gain {found:4.2f}  {'advised' if advised else ''}".rstrip())
        history.append((state, action))
        state = min(max(state + {BACK: -1, AHEAD: 1, ASIDE: 0}[action], 0), N_STATES - 1)
    return lines


def main() -> None:
    generator = np.random.default_rng(3)
    alpha = expert_counts(generator)
    theta = alpha / alpha.sum(axis=1, keepdims=True)
    uniform = np.full_like(theta, 1 / N_ACTIONS)
    models = np.stack([theta, uniform])  # M₁ normalcy, M₂ uniformity
    for name, behaviour in (("an expert", theta), ("a lost explorer", uniform)):
        print(name, *walk(theta, models, behaviour, np.random.default_rng(5)), sep="\n  ")


if __name__ == "__main__":
    main()
