"""Callers served by sampling the belief, with three kinds of signal.

The service knows for each caller's type and language model the distribution of the signal and of the utility,
exactly or learnt from `samples` calls a pair. A caller's uniform numbers are the same whatever is signalled, so
that the signals are compared on the same luck. Callers come in groups; where models are learnt each group has a
library of its own.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.telephone.telephone import (
    PATHS,
    REWARD_SEQUENCES,
    REWARDS_OF_PATH,
    UTILITIES,
    UTILITY_OF_PATH,
    Telephone,
)
from lifelore.experiments.chapter4.reuse_runs import SETTLED, converged_after, play_rule
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.reuse.regret import library_regret
from lifelore.interaction.selection import BeliefSampling
from lifelore.interaction.signals.category_signal import CategorySignal

SIGNAL_OF_PATH: dict[str, tuple[int, ...]] = {
    "(s, a, s′)": tuple(range(len(PATHS))),
    "(s, a, r)": REWARDS_OF_PATH,
    "U": UTILITY_OF_PATH,
}
"""The signal of each call, by kind of signal: the whole path, its rewards, or their sum."""
N_SIGNALS = {"(s, a, s′)": len(PATHS), "(s, a, r)": len(REWARD_SEQUENCES), "U": len(UTILITIES)}
EXACT, LEARNT = "exact", "learnt"


def exact_library(phone: Telephone, signal: str) -> PolicyLibrary:
    """The service that knows all distributions."""
    probs = {"(s, a, s′)": phone.path_probs, "(s, a, r)": phone.reward_probs, "U": phone.utility_probs}[signal]
    return PolicyLibrary(CategoricalOutcomes(UTILITIES, phone.utility_probs), CategorySignal(probs))


def learnt_library(
    phone: Telephone, signal: str, generator: np.random.Generator, samples: int, pseudo_count: float
) -> PolicyLibrary:
    """The service that has taken `samples` calls of each type with each model."""
    every = np.arange(phone.n_models)
    paths = phone.sample(generator, np.tile(every[:, None, None], (1, len(every), samples)), every[:, None])
    signals = np.array(SIGNAL_OF_PATH[signal])[paths]
    paid = np.array(UTILITIES)[np.array(UTILITY_OF_PATH)[paths]]
    return PolicyLibrary(
        CategoricalOutcomes.from_samples(paid, UTILITIES, pseudo_count),
        CategorySignal.from_samples(signals, N_SIGNALS[signal], pseudo_count),
    )


def serve(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """All callers of one cell: regret by call, and of each caller its sum and when it ended.

    Regret is expected (Definition 4.3.1), so that it is 0 exactly when the preferred model is used. ``free``:
    callers without regret in call `by_call`; ``ended``: the first call from which on there is none.
    """
    phone = Telephone(cell["models"], settings["eta"], cell["reading"])
    n_groups, n_users, n_calls = settings["groups"], settings["users"], settings["calls"]
    luck = stream(seed, "callers", cell["models"])
    types = luck.integers(phone.n_models, size=(n_groups, n_users))
    uniforms = luck.random((n_groups, n_users, n_calls))
    parts = []
    if cell["model"] == EXACT:
        library = exact_library(phone, cell["signal"])
        parts = [_serve(phone, library, types.ravel(), uniforms.reshape(-1, n_calls), cell["signal"], seed, 0)]
    else:
        for group in range(n_groups):
            generator = stream(seed, "training calls", cell["models"], cell["reading"], cell["samples"], group)
            library = learnt_library(phone, cell["signal"], generator, cell["samples"], settings["pseudo_count"])
            parts.append(_serve(phone, library, types[group], uniforms[group], cell["signal"], seed, group))
    regret = np.concatenate(parts)
    sums = regret.sum(axis=1)
    return {
        "mean": regret.mean(axis=0).round(5).tolist(),
        "deviation": regret.std(axis=0).round(5).tolist(),
        "sums": sums.round(3).tolist(),
        "ended": converged_after(regret).tolist(),
        "free": int((regret[:, settings["by_call"] - 1] <= SETTLED).sum()),
    }


def _serve(
    phone: Telephone, library: PolicyLibrary, types, uniforms, signal: str, seed: int, group: int
) -> NDArray:
    """Regret of each call, (n_users, n_calls)."""
    signal_of = np.array(SIGNAL_OF_PATH[signal])

    def signals(call: int, models: NDArray[np.int64]) -> NDArray[np.int64]:
        return signal_of[phone.path_of(uniforms[:, call], types, models)]

    generator = stream(seed, "service", group)
    played = play_rule(BeliefSampling(), library, signals, len(types), uniforms.shape[1], generator)
    return library_regret(phone.mean[types], played.policies)
