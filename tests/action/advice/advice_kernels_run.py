"""Runs the kernels of advice on a small world and saves all arrays: ``python advice_kernels_run.py OUT.npz``.

Started by the tests in processes of their own, compiled and as plain Python.
"""

import sys

import numpy as np


def all_arrays() -> dict[str, np.ndarray]:
    """Every array that the kernels leave behind, by name."""
    from lifelore.action.advice.advised_walk import advised_walk
    from lifelore.action.advice.advisor import AdviceSettings, Advisor
    from lifelore.action.advice.behaviour_models import Tabulated, Uniform
    from lifelore.action.advice.goal_model import GoalModel, Trajectory
    from lifelore.core.mdp import Tables

    random, out = np.random.default_rng(0), {}
    n_states, n_actions = 8, 3
    event = np.zeros((n_states, n_actions, 1), np.uint8)
    event[0, 0, 0] = 1
    tables = Tables(
        random.integers(0, n_states, (n_states, n_actions, 1)).astype(np.int32),
        random.normal(size=(n_states, n_actions, 1)),
        event,
        np.ones(1),
        np.arange(1, 6, dtype=np.int32),
    )
    purposes = [
        GoalModel.from_trajectories(
            [Trajectory(random.integers(0, n_states, 9), random.integers(0, n_actions, 8))],
            n_states,
            n_actions,
            [g],
        )
        for g in range(3)
    ]
    headed = random.dirichlet(np.ones(n_actions), (n_states, n_actions + 1))
    flat = random.dirichlet(np.ones(n_actions), n_states)
    better = AdviceSettings(kappa=0.1, window=7, slip=0.05, share=0.4, burst=5, own_steps_only=True)
    for name, advisor in (
        ("thesis", Advisor.of_thesis(purposes, AdviceSettings(kappa=0.1, window=7))),
        ("better", Advisor(purposes, [Uniform(n_actions), Tabulated(headed)], better)),
    ):
        for policy_name, policy in (("headed", headed), ("flat", flat)):
            for start in range(1, 6):
                walk = advised_walk(tables, policy, advisor, np.random.default_rng(start), 60, start=start)
                for field, value in walk._asdict().items():
                    out[f"{name} {policy_name} {start} {field}"] = np.asarray(value)
        states, actions = random.integers(0, n_states, 50), random.integers(-1, n_actions, 50)
        for field, value in advisor.assess(states, actions)._asdict().items():
            out[f"{name} assessed {field}"] = value
    return out


if __name__ == "__main__":
    np.savez(sys.argv[1], **all_arrays())  # type: ignore[arg-type]
