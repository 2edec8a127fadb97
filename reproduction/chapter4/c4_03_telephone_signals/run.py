"""C4.3: a telephone service that learns from calls, their rewards, or their sum. Thesis: §4.6.2, Figure 4.6.

The service samples the belief. It knows for each caller's type and language model the distribution of the signal
and of the utility, exactly or learnt from `samples` calls a pair. A caller's uniform numbers are the same whatever
is signalled, so that the signals are compared on the same luck. Callers come in groups; where models are learnt
each group has a library of its own.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.telephone import telephone
from lifelore.domains.telephone.telephone import PATHS, REWARDS_OF_PATH, UTILITIES, UTILITY_OF_PATH, Telephone
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.reuse.regret import library_regret
from lifelore.interaction.selection import BeliefSampling
from lifelore.interaction.signals.category_signal import CategorySignal
from reproduction.chapter4.reuse.many_tasks import (
    EXACT,
    LEARNT,
    SETTLED,
    UNCERTAIN,
    converged_after,
    play_doubting,
    play_rule,
)

SIGNAL_OF_PATH: dict[str, tuple[int, ...]] = {
    "(s, a, s′)": tuple(range(len(PATHS))),
    "(s, a, r)": REWARDS_OF_PATH,
    "U": UTILITY_OF_PATH,
}
"""The signal of each call, by kind of signal: the whole path, its rewards, or their sum."""
N_SIGNALS = {"(s, a, s′)": len(PATHS), "(s, a, r)": len(telephone.REWARD_SEQUENCES), "U": len(UTILITIES)}
MIDDLE_SAMPLES = 30
"""Calls of a pair between `samples` and `more_samples`."""
SIGNALS, DEFAULT_READING = tuple(SIGNAL_OF_PATH), "A"


def check(settings: Mapping) -> None:
    if settings["default_models"] not in settings["models"] or DEFAULT_READING not in settings["readings"]:
        raise InputError(f"models must include default_models ({settings['default_models']}), readings A")
    if not settings["samples"] < MIDDLE_SAMPLES < settings["more_samples"]:
        given = f"{settings['samples']} and {settings['more_samples']}"
        raise InputError(f"samples and more_samples must have {MIDDLE_SAMPLES} between them, got {given}")


def samples_of(settings: Mapping) -> tuple[int, int, int]:
    """Calls of each pair from which models are learnt: few, some, many."""
    return settings["samples"], MIDDLE_SAMPLES, settings["more_samples"]


def doubting_groups(settings: Mapping, samples: int) -> int:
    """Groups of callers of a service that doubts its models: a tenth, or a twentieth unless samples are few."""
    return max(1, settings["groups"] // (10 if samples == settings["samples"] else 20))


def cells(settings: Mapping) -> list[dict]:
    """Every signal, by number of models and kind of model under reading A, and for the default number under B.

    A service that doubts its models has fewer groups of callers, and sees the utility beside the signal.
    """
    numbers, default = samples_of(settings), settings["default_models"]
    kinds = [*((LEARNT, samples) for samples in numbers), (EXACT, None)]
    ways = [(DEFAULT_READING, n, *kind) for n in settings["models"] for kind in kinds]
    ways += [(DEFAULT_READING, default, UNCERTAIN, samples) for samples in numbers]
    ways += [("B", default, *kind) for kind in (kinds[0], kinds[-1]) if "B" in settings["readings"]]
    return [
        {"reading": reading, "models": n, "model": model, "samples": samples, "signal": signal}
        for reading, n, model, samples in ways
        for signal in SIGNALS
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """All callers of one cell: regret by call, and of each caller its sum and when it ended.

    Regret is expected (Definition 4.3.1), so that it is 0 exactly when the preferred model is used. ``free``:
    callers without regret in call `by_call`; ``ended``: the first call from which on there is none.
    """
    phone, signal = Telephone(cell["models"], settings["eta"], cell["reading"]), cell["signal"]
    n_groups, n_calls = settings["groups"], settings["calls"]
    luck = stream(seed, "callers", cell["models"])
    types = luck.integers(phone.n_models, size=(n_groups, settings["users"]))
    uniforms = luck.random((*types.shape, n_calls))
    if cell["model"] == UNCERTAIN:
        n_groups = doubting_groups(settings, cell["samples"])
        types, uniforms = types[:n_groups], uniforms[:n_groups]
    if cell["model"] == EXACT:
        libraries = [exact_library(phone, signal)]
        types, uniforms = types.reshape(1, -1), uniforms.reshape(1, -1, n_calls)
    else:
        name = ("training calls", cell["models"], cell["reading"], cell["samples"])
        known = (cell["samples"], settings["pseudo_count"])
        libraries = [learnt_library(phone, signal, stream(seed, *name, g), *known) for g in range(n_groups)]
    parts = [
        _serve(
            phone, library, types[group], uniforms[group], signal, (seed, "service", group),
            cell["model"] == UNCERTAIN,
        )
        for group, library in enumerate(libraries)
    ]  # fmt: skip
    regret = np.concatenate(parts)
    return {
        **cell,
        "mean": regret.mean(axis=0).round(5).tolist(),
        "deviation": regret.std(axis=0).round(5).tolist(),
        "sums": regret.sum(axis=1).round(3).tolist(),
        "ended": converged_after(regret).tolist(),
        "free": int((regret[:, settings["by_call"] - 1] <= SETTLED).sum()),
    }


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


def _serve(
    phone: Telephone, library: PolicyLibrary, types, uniforms, signal: str, stream_of: tuple, doubting: bool
) -> NDArray:
    """Regret of each call, (n_users, n_calls)."""
    signal_of, paid = np.array(SIGNAL_OF_PATH[signal]), np.array(UTILITIES)[np.array(UTILITY_OF_PATH)]

    def signals(call: int, models: NDArray[np.int64]) -> NDArray[np.int64]:
        return signal_of[phone.path_of(uniforms[:, call], types, models)]

    def outcomes(call: int, models: NDArray[np.int64]) -> NDArray[np.float64]:
        return paid[phone.path_of(uniforms[:, call], types, models)]

    rule, size = BeliefSampling(), (len(types), uniforms.shape[1])
    if doubting:
        played = play_doubting(rule, library, signals, *size, stream_of, outcomes=outcomes)
    else:
        played = play_rule(rule, library, signals, *size, stream(*stream_of))
    return library_regret(phone.mean[types], played.policies)
