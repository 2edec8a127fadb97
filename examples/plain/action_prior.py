"""Action priors and ε-greedy Q-learning with them (thesis §3.2.2, Eq. 3.1-3.5, Algorithm 2), in plain NumPy.

A 9 × 9 maze. Ten tasks have goals of their own and are solved exactly; the counts of their best actions are the
action prior. The eleventh task is learnt with it, and with uniform exploration.

    python examples/plain/action_prior.py
"""

import numpy as np

MAZE = [
    ".........",
    ".##.###.#",
    ".#....#..",
    ".#.##.##.",
    "...#.....",
    "##.#.##.#",
    ".....#...",
    ".###.#.#.",
    ".........",
]
MOVES = ((-1, 0), (1, 0), (0, 1), (0, -1))  # north, south, east, west
GAMMA = 0.95


def maze_transitions(maze: list[str]) -> np.ndarray:
    """T(s, a, s') of a maze, (n_states, 4, n_states): a move into a wall stays where it is."""
    cells = [(row, column) for row, line in enumerate(maze) for column, mark in enumerate(line) if mark == "."]
    state = {cell: s for s, cell in enumerate(cells)}
    T = np.zeros((len(cells), len(MOVES), len(cells)))
    for (row, column), s in state.items():
        for a, (down, right) in enumerate(MOVES):
            T[s, a, state.get((row + down, column + right), s)] = 1.0
    return T


def goal_rewards(T: np.ndarray, goal: int) -> np.ndarray:
    """R(s, a, s') of a task: 10 for entering the goal, -1 for a move that stays, else 0."""
    stays = np.eye(len(T))[:, None, :]
    return np.broadcast_to(np.where(np.arange(len(T)) == goal, 10.0, 0.0) - stays, T.shape)


def optimal_q(T: np.ndarray, R: np.ndarray, goal: int) -> np.ndarray:
    """Q*(s, a) by value iteration; an episode ends at the goal."""
    Q = np.zeros(T.shape[:2])
    while True:
        V = Q.max(axis=1)
        V[goal] = 0.0
        new = (T * (R + GAMMA * V)).sum(axis=2)
        if np.abs(new - Q).max() < 1e-12:
            return new
        Q = new


def useful(Q: np.ndarray) -> np.ndarray:
    """U(s, a): 1 where the action is best or ties with the best (Eq. 3.1)."""
    return np.isclose(Q, Q.max(axis=1, keepdims=True), rtol=1e-9, atol=1e-9).astype(float)


def update(alpha: np.ndarray, U: np.ndarray, goal: int, w: float = 1.0) -> np.ndarray:
    """α(s, a) after another policy of weight w (Eq. 3.5); at its own goal no action is counted."""
    counted = np.arange(len(alpha)) != goal
    return alpha + w * U * counted[:, None]


def proportions(alpha: np.ndarray) -> np.ndarray:
    """θ(s, a): the mean of Dir(α_s) (§3.2.2.1)."""
    return alpha / alpha.sum(axis=1, keepdims=True)


def q_learning(T, R, goal, theta, generator, episodes=60, steps=200, alpha_q=0.5):
    """ε-QSAP (Algorithm 2): the discounted return of each episode. ε falls from 1 to 0 over the episodes."""
    n_states, n_actions, _ = T.shape
    Q, returns = np.zeros((n_states, n_actions)), []
    for k in range(episodes):
        epsilon = 1.0 - k / episodes
        s, total = int(generator.choice(np.delete(np.arange(n_states), goal))), 0.0
        for step in range(steps):
            if generator.random() < epsilon:
                a = int(generator.choice(n_actions, p=theta[s]))
            else:
                a = int(generator.choice(np.flatnonzero(Q[s] == Q[s].max())))
            after = int(generator.choice(n_states, p=T[s, a]))
            r, ended = R[s, a, after], after == goal
            Q[s, a] += alpha_q * (r + (0.0 if ended else GAMMA * Q[after].max()) - Q[s, a])
            total += GAMMA**step * r
            s = after
            if ended:
                break
        returns.append(total)
    return np.array(returns)


def main() -> None:
    T = maze_transitions(MAZE)
    generator = np.random.default_rng(1)
    *goals, new_goal = generator.permutation(len(T))[:11].tolist()
    alpha = np.full(T.shape[:2], 0.1)  # the pseudocounts α⁰
    for goal in goals:
        alpha = update(alpha, useful(optimal_q(T, goal_rewards(T, goal), goal)), goal)
    R = goal_rewards(T, new_goal)
    for name, theta in (("uniform", np.full(T.shape[:2], 0.25)), ("action prior", proportions(alpha))):
        runs = [q_learning(T, R, new_goal, theta, np.random.default_rng(run)) for run in range(20)]
        print(f"{name:12} mean return of the first ten episodes {np.mean([run[:10].mean() for run in runs]):6.2f}")


if __name__ == "__main__":
    main()
