"""`bench bands`: how well signal models of ordered categories predict, by the number of runs behind them.

Golf's seven bands of distance, four clubs at four holes. Each round fits every model to the same shots. The loss
of a model is the mean, over pairs, of the divergence of its probabilities from the true ones, in nats a shot.
"""

from collections.abc import Callable
from itertools import product

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_most, estimated_row
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.golf.golf import CATEGORIES, EDGES, Golf, category_of
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.ordered_normal_signal import OrderedNormalSignal

RUNS = (1, 3, 10, 30, 100)
USUAL, CHOSEN = "categories, pseudo-count 0.5", "categories, pseudo-count held-out"
NORMAL, KNOWN = "ordered normal", "ordered normal, cut points known"
MODELS: dict[str, Callable[[NDArray[np.int64]], CategorySignal | OrderedNormalSignal]] = {
    USUAL: lambda samples: CategorySignal.from_samples(samples, len(CATEGORIES)),
    CHOSEN: lambda samples: CategorySignal.from_samples(samples, len(CATEGORIES), "held-out"),
    NORMAL: lambda samples: OrderedNormalSignal.from_samples(samples, len(CATEGORIES)),
    KNOWN: lambda samples: OrderedNormalSignal.from_samples(samples, cuts=EDGES),
}


def bench_bands(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`. Rows also have ``ci95`` and ``n``."""
    losses: dict[tuple[int, str], list[float]] = {case: [] for case in product(RUNS, MODELS)}
    for number in range(repeats):
        for n in RUNS:
            samples = shots(stream(0, "bench", "bands", number, n), n)
            for name, fitted in MODELS.items():
                losses[n, name].append(loss(fitted(samples)))
        progress(number + 1, repeats, f"library {number + 1}")
    goals = [
        at_most(
            f"{NORMAL} / {USUAL}, {n} runs", 1.0, float(np.mean(losses[n, NORMAL]) / np.mean(losses[n, USUAL]))
        )
        for n in RUNS
    ]
    return {"rows": [_row(n, name, values, losses) for (n, name), values in losses.items()], "goals": goals}


def shots(generator: np.random.Generator, n: int) -> NDArray[np.int64]:
    """Categories of `n` shots of each club at each hole, (n_holes, n_clubs, n)."""
    golf = Golf()
    holes = np.ones((len(golf.holes), golf.n_clubs, n)) * np.array(golf.holes)[:, None, None]
    return category_of(golf.sample_errors(generator, holes, np.arange(golf.n_clubs)[:, None]))


def loss(signal: CategorySignal | OrderedNormalSignal) -> float:
    """Divergence of the model from the true probabilities, nats a shot, mean over pairs."""
    true = Golf().category_probs
    with np.errstate(divide="ignore", invalid="ignore"):
        terms = np.where(true > 0, true * (np.log(true) - np.log(signal.probs)), 0.0)
    return float(terms.sum(axis=2).mean())


def _row(n: int, name: str, values: list[float], losses: dict[tuple[int, str], list[float]]) -> dict:
    estimate, usual = mean_estimate(values), _words(n, USUAL)
    ratio = None if name == USUAL else estimate.value / float(np.mean(losses[n, USUAL]))
    found = estimated_row(_words(n, name), estimate, "nats a shot")
    return found | {"ratio_to": None if name == USUAL else usual, "ratio": ratio}


def _words(n: int, name: str) -> str:
    return f"{name}, {n} run{'s' * (n > 1)} a pair"
