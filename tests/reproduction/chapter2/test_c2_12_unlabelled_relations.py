"""C2.12: clusters beside labels on pairs made by hand, and the numbers by hand."""

import numpy as np
import pytest

from lifelore.perception.pairs.pair_features import COLUMNS
from reproduction.chapter2.c2_12_unlabelled_relations.measure import (
    both_in_a_cluster_of_both,
    measure,
    rand_indices,
    rows,
)
from reproduction.chapter2.c2_12_unlabelled_relations.relation_clusters import (
    METHODS,
    Sighted,
    cluster_counts,
    cluster_names,
    clustered,
    every_word,
    k_means,
    rand_index,
    rand_index_by_scene,
    sighted,
)
from reproduction.chapter2.scenes.tabletop_pairs import KERNELS, kernel_name
from reproduction.chapter2.scoring.pair_validation import Reading
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C2.12")

KERNEL_NAMES = [kernel_name(*kernel) for kernel in KERNELS]
MM = 0.001


def row(number, relation, rng):
    """A pair as a cell keeps it; the displacement is what its relation makes it, the scene's upper thing has 3."""
    right, rise, over = {
        "on": (0.0, 60 * MM, 0.9),
        "both": (0.0, 62 * MM, 0.5),
        "adjacent": (rng.choice([-1, 1]) * 70 * MM, 0.0, 0.0),
    }[relation]
    right, rise = right + MM * rng.normal(), rise + MM * rng.normal()
    told = {"centre_rise": rise + 0.001, "contact_right": right, "rise_0": rise, "gap": 0.002}
    told |= {"elevation_0": np.arctan2(rise, abs(right)), "a_over_b": over + 0.02 * rng.normal()}
    upper = np.array([told.get(name, 0.0) for name in COLUMNS])
    lower = np.array([told.get(name, 0.0) * (-1 if name not in ("gap", "a_over_b") else 1) for name in COLUMNS])
    contacts = {"a": [[0.0, 0.0, 0.0, 9]], "b": [[right, 0.0, rise, 9]]}
    return {
        "scene": f"s{number}", "a": 3, "b": 2, "relation": relation, "confidence": 3, "pair": [2, 3], "gap": 0.002,
        "contacts": dict.fromkeys(KERNEL_NAMES, contacts), "features": [lower.tolist(), upper.tolist()],
    }  # fmt: skip


@pytest.fixture(scope="module")
def results():
    rng = np.random.default_rng(0)
    kinds = ["on"] * 12 + ["adjacent"] * 12 + ["both"] * 4
    far = {"scene": "far", "a": 3, "b": 2, "relation": "none", "confidence": 3, "pair": [2, 3], "gap": None}
    return [
        {"set": 0, "rows": [row(k, kind, rng) for k, kind in enumerate(kinds)]},
        {"set": 1, "rows": [*(row(k, kind, rng) for k, kind in enumerate(kinds)), far]},
        {"set": "real", "rows": [row(k, kind, rng) for k, kind in enumerate(kinds)]},
    ]


def test_a_sighted_pair_has_the_upper_thing_first_and_far_pairs_are_not_seen(results):
    seen = sighted(results[1]["rows"])
    assert len(seen.relations) == 28
    np.testing.assert_allclose(seen.displacements[:12], [[0, 60 * MM]] * 12, atol=5 * MM)
    assert set(seen.sides) == {"on", "both", "left", "right"}


def test_x_means_tells_left_from_right_and_blurs_both_with_on(results):
    seen = sighted(results[0]["rows"])
    # From an unlucky direction the first split gains nothing, and all is one cluster.
    labels = max(clustered(seen, "x-means", 3, "0"), key=lambda one: len(set(one)))
    counts = cluster_counts(seen.relations, labels)
    assert counts[0] == [12, 0, 4, 0]
    assert [sum(column) for column in zip(*counts[1:], strict=True)] == [0, 12, 0, 0]
    assert len(counts) == 3


RELATIONS = np.array(["on", "on", "on", "adjacent", "both", "both"])
LABELS = np.array([0, 0, 1, 1, 1, 2])


def test_clusters_take_the_commonest_relation_the_first_of_equals():
    assert cluster_names(RELATIONS, LABELS).tolist() == ["on", "on", "on", "on", "on", "both"]
    assert cluster_counts(RELATIONS, LABELS) == [[1, 1, 1, 0], [2, 0, 0, 0], [0, 0, 1, 0]]


def test_rand_index_counts_pairs_of_pairs():
    # Together in both 1, in relations 4, in clusters 4, of 15: (1 - 16/15) / (4 - 16/15).
    assert rand_index(RELATIONS, LABELS) == pytest.approx((1 - 16 / 15) / (4 - 16 / 15))
    whole = rand_index_by_scene(np.array(list("abcdef")), RELATIONS, LABELS)
    assert whole.value == rand_index(RELATIONS, LABELS)
    assert whole.n == 6
    assert whole.ci95 is not None
    assert whole.ci95[0] <= whole.value <= whole.ci95[1]


def test_k_means_of_fewer_places_than_clusters():
    assert len(set(k_means(np.array([[0.0, 0], [0, 0], [1, 1]]), 3, np.random.default_rng(0)))) == 2


def test_numbers_are_averaged_over_starts_and_then_over_data_sets():
    seen = Sighted(RELATIONS, RELATIONS, [], np.zeros((6, 2)))
    sets = [(seen, {"x-means": [LABELS, np.zeros(6, int)]}), (seen, {"x-means": [np.zeros(6, int)]})]
    assert rand_indices(sets[0], "x-means") == pytest.approx(rand_index(RELATIONS, LABELS) / 2)
    # Of two both in either set: half of one in a cluster of its name.
    assert both_in_a_cluster_of_both(sets).value == pytest.approx(0.5 / 4)


def test_measures_of_simulated_and_real_sets(results):
    settings = CLAIM.settings("quick", {"starts": 1, "data_sets": 2})
    found = measure(settings, results)
    assert found["clusters_x_means"].value == 3.0
    assert found["clusters_x_means"].n == 2
    assert found["both_in_a_cluster_of_both"].value == 0.0
    assert found["ari_x_means_left_and_right_apart"].value > found["ari_x_means"].value
    assert found["ari_x_means_of_on_left_and_right_alone"].value == 1.0
    assert found["ari_lifelore_real"].n == 28
    asked = {condition.measure for condition in CLAIM.predicate.conditions}
    assert asked <= set(found)


def test_rows_hold_what_the_figure_needs(results):
    settings = CLAIM.settings("quick", {"starts": 1, "grid": True})
    found = rows(settings, results)
    assert len([one for one in found if "method" in one]) == 3 * len(METHODS)
    assert len([one for one in found if "every word" in one]) == 3 * 2 * len(KERNELS)
    measured = {name: number.to_dict() for name, number in measure(settings, results).items()}
    figure = CLAIM.draw({"rows": found, "measured": measured, "settings": settings})
    titles = [axes.get_title(loc="left") for axes in figure.get_axes()]
    assert titles == [
        "relations",
        "x-means: 3",
        "k-means: 3",
        titles[3],
        "simulated (56 pairs)",
        "real (28 pairs)",
    ]


def test_every_word_looks_at_each_displacement_in_the_given_order(results):
    found = every_word(results[0]["rows"], Reading(), "0")
    assert found is not None
    assert found["displacements"] == 28
    assert every_word([{"gap": None, "relation": "none"}], Reading(), "0") is None
