"""C4.1: golf's printed shots under exact and learnt models, and rounds played. Thesis: §4.6.1, Tables 4.1, 4.2."""

from collections.abc import Mapping
from itertools import product

import numpy as np

from lifelore.core.streams import stream
from lifelore.domains.golf.golf import CLUBS
from lifelore.interaction.beliefs.belief import entropy, log_prior, update
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import Greedy, tied_shares
from reproduction.chapter4.golf.rounds import IRON, WOOD, exact_library, learnt_library, play_holes

PRINTED_CLUBS = (0, 1, 1, 1, 1, 1, 1, 1)
PRINTED_CATEGORIES = (5, 4, 3, 4, 3, 4, 4, 3)
"""20–50, 5–20, −5–5, … beyond the hole."""


def cells(settings: Mapping) -> list[dict]:
    """The printed shots under the exact models, the same under learnt ones, and rounds played."""
    kinds = product(settings["samples"], settings["pseudo_counts"])
    learnt = [{"part": "learnt", "samples": n, "pseudo_count": pseudo} for n, pseudo in kinds]
    return [{"part": "printed"}, *learnt, {"part": "played", "first": None}, {"part": "played", "first": WOOD}]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One part's entropies and clubs."""
    if cell["part"] == "printed":
        return {**cell, "first_club": greedy_shares(exact_library()), **follow_printed(exact_library())}
    if cell["part"] == "played":
        return {**cell, **_played(settings, cell["first"], seed)}
    generator, known = stream(seed, "libraries", cell["samples"]), (cell["samples"], cell["pseudo_count"])
    followed = [follow_printed(learnt_library(generator, *known)) for _ in range(settings["libraries"])]
    return {
        **cell,
        "entropy": [[round(h, 5) for h in found["entropy"][1:3]] for found in followed],
        "irons": [round(float(np.mean(found["iron"])), 4) for found in followed],
    }


def follow_printed(library: PolicyLibrary) -> dict:
    """The belief along the printed shots, and how likely greedy then takes the 3-iron.

    ``entropy``: before each shot; ``belief``: the same; ``iron``: before each shot but the first.
    """
    log_belief = log_prior(library.prior)
    beliefs, iron = [np.exp(log_belief)], []
    for club, category in zip(PRINTED_CLUBS, PRINTED_CATEGORIES, strict=True):
        log_belief = update(log_belief, library.signal.log_likelihood(club, category)).log_belief
        beliefs.append(np.exp(log_belief))
        iron.append(greedy_shares(library, beliefs[-1])[IRON])
    return {
        "entropy": [float(entropy(belief)) for belief in beliefs[:-1]],
        "belief": [belief.round(6).tolist() for belief in beliefs[:-1]],
        "iron": iron[:-1],
    }


def greedy_shares(library: PolicyLibrary, belief: np.ndarray | None = None) -> list[float]:
    """Probability that greedy selection takes each club."""
    belief = library.prior if belief is None else belief
    return tied_shares(Greedy().scores(library, belief)).tolist()


def _played(settings: Mapping, first: int | None, seed: int) -> dict:
    """Rounds at the printed hole under exact models."""
    n, shots = settings["rounds"], settings["shots"]
    luck = stream(seed, "luck at the printed hole").standard_normal((n, shots))
    found = play_holes(Greedy(), exact_library(), np.full(n, settings["distance"]), luck, seed, first)
    return {
        "clubs": [np.bincount(found.clubs[:, t], minlength=len(CLUBS)).tolist() for t in range(shots)],
        "iron_after_first": int((found.clubs[:, 1:] == IRON).all(axis=1).sum()),
        "iron_after_second": int((found.clubs[:, 2:] == IRON).all(axis=1).sum()),
        "error": np.abs(found.error).mean(axis=0).round(4).tolist(),
        "entropy": found.entropy.mean(axis=0).round(5).tolist(),
    }
