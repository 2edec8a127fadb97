"""C4.3: a telephone service that learns from calls, their rewards, or their sum. Thesis: §4.6.2, Figure 4.6."""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.c4_03_telephone_signals.telephone_runs import (
    EXACT,
    LEARNT,
    SIGNAL_OF_PATH,
    serve,
)

SIGNALS = tuple(SIGNAL_OF_PATH)
DEFAULT_READING = "A"


def check(settings: Mapping) -> None:
    if settings["default_models"] not in settings["models"] or DEFAULT_READING not in settings["readings"]:
        raise InputError(f"models must include default_models ({settings['default_models']}), readings A")
    if settings["samples"] == settings["more_samples"]:
        raise InputError(f"more_samples must not be samples ({settings['samples']})")


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
