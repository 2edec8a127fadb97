"""C4.3: a telephone service that learns from whole calls, from their rewards, or from their sum alone.

The thesis does not say how many language models there are; nor, but by words, what η splits. Reading A of the
transition system is the default, ten models the headline; beside it other numbers of models, and reading B.

What was known beforehand: for every type and model the distributions of signal and utility, exactly, or as learnt
from `samples` calls a pair with pseudo-counts; the caller's type never.

Thesis: §4.6.2, Figures 4.5 and 4.6.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.domains.telephone.telephone import READINGS
from lifelore.experiments.chapter4.c4_03_telephone_signals.telephone_runs import (
    EXACT,
    LEARNT,
    SIGNAL_OF_PATH,
    serve,
)
from lifelore.experiments.engine.learning_settings import check_among, check_counts

SIGNALS = tuple(SIGNAL_OF_PATH)
DEFAULT_READING = "A"


def check(settings: Mapping) -> None:
    check_counts(settings, ("groups", "users", "calls", "by_call", "samples", "more_samples"))
    check_counts(settings, ("models",), 2)
    check_among(settings, "readings", READINGS)
    if settings["default_models"] not in settings["models"] or DEFAULT_READING not in settings["readings"]:
        raise InputError(f"models must include default_models ({settings['default_models']}), readings A")
    if settings["by_call"] > settings["calls"]:
        raise InputError(f"by_call must be at most calls ({settings['calls']}), got {settings['by_call']}")
    if settings["samples"] == settings["more_samples"]:
        raise InputError(f"more_samples must not be samples ({settings['samples']})")
    if not 0 <= settings["eta"] < 1 or settings["pseudo_count"] < 0:
        raise InputError("eta must lie in [0, 1) and pseudo_count be at least 0")


def cells(settings: Mapping) -> list[dict]:
    """Every signal, by number of models and kind of model under reading A, and for the default number under B."""
    few, many, default = settings["samples"], settings["more_samples"], settings["default_models"]
    kinds = ((LEARNT, few), (EXACT, None))
    ways = [(DEFAULT_READING, n, *kind) for n in settings["models"] for kind in kinds]
    ways += [(DEFAULT_READING, default, LEARNT, many)]
    ways += [("B", default, *kind) for kind in kinds if "B" in settings["readings"]]
    return [
        {"reading": reading, "models": n, "model": model, "samples": samples, "signal": signal}
        for reading, n, model, samples in ways
        for signal in SIGNALS
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One kind of signal; see `telephone_runs.serve`."""
    return {**cell, **serve(settings, cell, seed)}
