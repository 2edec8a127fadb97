"""C4.1: golf's printed shots under histograms and exact models, and rounds played. Thesis: §4.6.1, Table 4.2."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, entropy, mean_estimate
from lifelore.core.streams import stream
from lifelore.figures.style import BLUE, GREY, VERMILION, Axes
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import Greedy, tied_shares
from reproduction.chapter4.golf.rounds import IRON, WOOD, exact_library, learnt_library, play_greedily
from reproduction.engine.estimates import exact_value
from reproduction.figures.panels import panels

PRINTED_CLUBS = (0, 1, 1, 1, 1, 1, 1, 1)
PRINTED_CATEGORIES = (5, 4, 3, 4, 3, 4, 4, 3)
"""20–50, 5–20, −5–5, … beyond the hole."""
PRINTED_ENTROPY = (1.3863, 0.2237, *[0.0] * 6)
PRINTED_ERROR = (35.3657, 13.1603, 4.2821, 6.7768, 2.0744, 11.0469, 8.1516, 2.4527)
"""Nats before each shot, and yards beyond the hole."""
EXACT = {"samples": None, "pseudo_count": None}


def cells(settings: Mapping) -> list[dict]:
    """Each way to fit the golfer's models, the default first, and exact models."""
    fits = product(settings["samples"], settings["pseudo_counts"])
    return [*({"samples": n, "pseudo_count": pseudo} for n, pseudo in fits), EXACT]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """By library: entropies along the printed shots, shares of clubs, and errors of rounds played.

    Exact models are one library, which plays the rounds of all.
    """
    n, rounds = settings["libraries"], settings["rounds"]
    if cell["samples"] is None:
        libraries, rounds = [exact_library()], n * rounds
    else:
        generator = stream(seed, "libraries", cell["samples"])
        libraries = [learnt_library(generator, cell["samples"], cell["pseudo_count"]) for _ in range(n)]
    luck = stream(seed, "luck at the printed hole")
    found: dict[str, list] = {key: [] for key in ("entropy", "irons", "rounds_on_iron", "error")}
    for library in libraries:
        entropies, iron = follow_printed(library)
        distance = np.full(rounds, settings["distance"])
        played = play_greedily(library, distance, luck.standard_normal((rounds, settings["shots"])), luck, WOOD)
        found["entropy"].append([round(h, 6) for h in entropies[: settings["shots"]]])
        found["irons"].append(float(np.mean(iron[: settings["shots"] - 1])))
        found["rounds_on_iron"].append(float((played.clubs[:, 1:] == IRON).all(axis=1).mean()))
        found["error"].append(np.abs(played.error).mean(axis=0).round(4).tolist())
    return {**cell, **found}


def follow_printed(library: PolicyLibrary) -> tuple[list[float], list[float]]:
    """Entropy before each printed shot, and the probability that greedy takes the 3-iron from the second on."""
    log_belief = log_prior(library.prior)
    entropies, iron = [], []
    for club, category in zip(PRINTED_CLUBS, PRINTED_CATEGORIES, strict=True):
        entropies.append(float(entropy(np.exp(log_belief))))
        log_belief = update(log_belief, library.signal.log_likelihood(club, category)).log_belief
        iron.append(float(tied_shares(Greedy().scores(library, np.exp(log_belief)))[IRON]))
    return entropies, iron[:-1]


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each way to fit the models, and exact ones."""
    for result in results:
        samples = result["samples"]
        models = "exact" if samples is None else f"{samples} shots"
        yield {"models": models, "pseudo_count": result["pseudo_count"]}, _measured(result)


def _measured(result: Mapping) -> dict[str, Estimate]:
    first, second = np.array(result["entropy"])[:, 1], np.array(result["entropy"])[:, 2]
    rank = (first < PRINTED_ENTROPY[1]) + 0.5 * (first == PRINTED_ENTROPY[1])
    found = {
        "irons_after_printed": mean_estimate(result["irons"]),
        "rounds_on_iron": mean_estimate(result["rounds_on_iron"]),
        "entropy_2": mean_estimate(first),
        "rank_of_0_2237": mean_estimate(rank),
        "entropy_3_is_0": mean_estimate(second < 5e-5),
    }
    return found if result["samples"] else {name: exact_value(one.value) for name, one in found.items()}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Of the default and of exact models: median and middle 95 % of libraries, shot by shot."""
    return [
        {"samples": result["samples"]}
        | {
            key: np.quantile(result[key], [0.025, 0.5, 0.975], axis=0).round(5).tolist()
            for key in ("entropy", "error")
        }
        for result in (results[0], results[-1])
    ]


@panels(8.6, 3.2, 1, 2)
def draw(result: Mapping, *every: Axes) -> None:
    """The worked example of golf: entropy of the belief and error by shot, as printed and as measured (Table 4.2).

    Printed numbers as diamonds beside histograms (median, middle 95 %) and exact models.
    """
    learnt, exact = result["rows"]
    shots = range(1, result["settings"]["shots"] + 1)
    titles = {
        "entropy": "Entropy of the belief before each shot (nats)",
        "error": "Distance from the hole (yards)",
    }
    for axes, (key, title) in zip(every, titles.items(), strict=True):
        low, middle, high = learnt[key]
        axes.fill_between(shots, low, high, color=BLUE, alpha=0.2, lw=0)
        axes.plot(shots, middle, "o-", color=BLUE, ms=4, label=f"histograms of {learnt['samples']} shots")
        axes.plot(shots, exact[key][1], ls=(0, (3, 2)), color=GREY, label="exact models")
        printed = PRINTED_ENTROPY if key == "entropy" else PRINTED_ERROR
        axes.plot(shots, printed[: len(shots)], "D", color=VERMILION, ms=5, label="printed (one round)")
        axes.set(title=title, xlabel="shot", ylim=(0, None), xticks=list(shots))
    every[0].legend()
