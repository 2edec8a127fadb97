"""Runs the kernels of policy reuse on small cases and saves all arrays: ``python user_kernels_run.py OUT.npz``.

Started by the tests in processes of their own, compiled and as plain Python.
"""

import sys

import numpy as np


def all_arrays() -> dict[str, np.ndarray]:
    """Every array that the kernels leave behind, by name."""
    from lifelore.interaction.beliefs.belief import update
    from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
    from lifelore.interaction.library.policy_library import PolicyLibrary
    from lifelore.interaction.reuse.user_beliefs import UserBeliefs
    from lifelore.interaction.selection import RULES, choose, rule_named, tied_shares
    from lifelore.interaction.signals.category_signal import CategorySignal

    random, out = np.random.default_rng(0), {}
    beliefs = np.log(random.dirichlet(np.full(7, 0.3), 20))
    said = random.normal(scale=40, size=(20, 7))
    said[random.random(said.shape) < 0.2], said[3] = -np.inf, -np.inf
    out["belief"], out["evidence"] = update(beliefs, said)
    out["huge"] = update(beliefs, np.where(said > 0, 1.7e308, -1.7e308)).log_belief
    scores = random.integers(0, 3, (30, 5)).astype(float)
    out["chosen"], out["shares"] = choose(scores, np.random.default_rng(1)), tied_shares(scores)
    library = PolicyLibrary.from_means(random.normal(scale=20, size=(7, 5)), 15.0)
    words = random.dirichlet(np.full(4, 0.3), (7, 5))
    words[0, :, 0] = 0
    words /= words.sum(axis=2, keepdims=True)
    spoken = PolicyLibrary(library.performance, CategorySignal(words))
    for name in RULES:
        scores = rule_named(name).scores(library, np.exp(beliefs), generator=np.random.default_rng(2))
        out[f"{name} scores"] = scores
    runs = random.normal(scale=20, size=(7, 5, 6))
    learnt = [PolicyLibrary.from_samples(runs), PolicyLibrary.from_samples(runs.round(-1), model="categorical")]
    learnt.append(PolicyLibrary.from_means(runs.mean(axis=2), 15.0, count=random.integers(3, 9, (7, 5))))
    for dtype in ("f4", "f8"):
        for number, model in enumerate(learnt):
            for changing in (TypeDynamics.static(), TypeDynamics.hazard(0.1, model.prior)):
                users = UserBeliefs(model, 9, dtype, dynamics=changing, seed=4)
                for rule in ("sampling", "greedy", "sampling"):
                    who, policies = random.integers(0, 9, 20), random.integers(0, 5, 20)
                    signals = runs.round(-1)[random.integers(0, 7, 20), policies, 0]
                    name = f"{dtype} learnt {number} {changing.kind} {rule} {len(out)}"
                    out[name] = users.update_and_select(who, policies, signals, rule)
                    out[f"{name} logs"] = users.log_belief.copy()
                    out[f"{name} available"] = users.select(np.arange(9), rule, available=np.arange(5) % 2 == 0)
                users.reset([3])
                out[f"{name} tried"] = np.concatenate([part.astype(float) for part in users.outcomes.tried(who)])
        for model, draw in (
            (library, lambda: random.normal(size=20)),
            (spoken, lambda: random.integers(0, 4, 20)),
        ):
            users = UserBeliefs(model, 9, dtype, seed=4)
            for rule in ("sampling", "greedy", "sampling", "greedy"):
                who, policies = random.integers(0, 9, 20), random.integers(0, 5, 20)
                name = f"{dtype} {type(model.signal).__name__} {rule} {len(out)}"
                out[name] = users.update_and_select(who, policies, draw(), rule)
                out[f"{name} logs"] = users.log_belief.copy()
                out[f"{name} selected"] = users.select(np.arange(9), rule)
    return out


if __name__ == "__main__":
    np.savez(sys.argv[1], **all_arrays())  # type: ignore[arg-type]
