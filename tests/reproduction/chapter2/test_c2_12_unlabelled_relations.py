"""C2.12: clusters beside labels on displacements made by hand, and the numbers by hand."""

import numpy as np
import pytest

from lifelore.core.relations import ADJACENT, BOTH, ON
from reproduction.chapter2.c2_12_unlabelled_relations.run import MOST, blurred, joined, measure, mostly, rand_index
from reproduction.chapter2.scenes.tabletop_pairs import KERNEL_NAMES
from reproduction.chapter2.scoring.pair_validation import Reading

SETTINGS = {"starts": 3}


def row(number, relation, rng):
    """A pair whose displacement is what its relation makes it, metres."""
    place = {ON: (0.0, 0.0, 0.06), BOTH: (0.0, 0.0, 0.062), ADJACENT: (0.07, 0.0, 0.0)}[relation]
    at = (np.array(place) + 0.001 * rng.normal(size=3)).tolist()
    contacts = {name: {"a": [[*at, 9]], "b": [[0.0, 0.0, 0.0, 9]]} for name in KERNEL_NAMES}
    return {"scene": f"s{number}", "relation": relation, "gap": 0.002, "contacts": contacts}


@pytest.fixture(scope="module")
def results():
    rng = np.random.default_rng(0)
    kinds = [ON] * 12 + [ADJACENT] * 12 + [BOTH] * 4
    far = {"scene": "far", "relation": "none", "gap": None, "contacts": {}}
    return [{"set": n, "rows": [*(row(k, kind, rng) for k, kind in enumerate(kinds)), far]} for n in (0, 1)]


RELATIONS = np.array([ON, ON, ON, ADJACENT, BOTH, BOTH])
LABELS = np.array([0, 0, 1, 1, 1, 2])


def test_rand_index_counts_pairs_of_pairs():
    # Together in both 1, in relations 4, in clusters 4, of 15: (1 - 16/15) / (4 - 16/15).
    assert rand_index(RELATIONS, LABELS) == pytest.approx((1 - 16 / 15) / (4 - 16 / 15))


def test_clusters_take_the_commonest_relation_the_first_of_equals():
    assert [mostly(RELATIONS[k == LABELS]) for k in range(3)] == [ON, ON, BOTH]
    # Of two *both* displacements one lies in a cluster of *on*.
    assert blurred(RELATIONS, LABELS) == 0.5
    assert np.isnan(blurred(np.array([ON]), np.array([0])))


def test_all_displacements_of_near_pairs_take_part(results):
    moved, relations = joined(results[0]["rows"], Reading(), "plane of Figure 2.4")
    assert moved.shape == (28, 2)
    np.testing.assert_allclose(moved[0], [0, 0.06], atol=0.005)
    assert (relations == BOTH).sum() == 4


def test_measures_are_means_over_starts_and_then_over_data_sets(results):
    found = measure(SETTINGS, results)
    assert found["agreement"].n == found["clusters"].n == 2
    assert 0 < found["agreement"].value < 1
    # *both* lies where *on* does.
    assert found["blurred"].value == 1
    few = [{"set": 0, "rows": results[0]["rows"][: MOST - 1]}]
    assert measure(SETTINGS, few)["agreement"].n == 0
