"""Relations without labels, on features made by hand: what is found, how it is numbered, what is refused."""

import numpy as np
import pytest
from sklearn.metrics import adjusted_rand_score

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.relations.discovery import (
    DISPLACEMENT,
    FEATURES,
    discover,
    discover_by_displacement,
    upright_rows,
)

NAMES = ("centre_rise", *DISPLACEMENT, *FEATURES)


def scene(*pairs: tuple[int, int, dict[str, float]]) -> PairFeatures:
    """Each pair as it is and turned round: what has a sign changes it."""
    rows = []
    for _, _, told in pairs:
        row = np.array([told.get(name, 0.0) for name in NAMES])
        signed = [name not in ("gap", "a_over_b") for name in NAMES]
        rows += [row, np.where(signed, -row, row)]
    order = [[(a, b), (b, a)] for a, b, _ in pairs]
    return PairFeatures(
        NAMES,
        np.array(rows).reshape(-1, len(NAMES)),
        np.array(order, np.int64).reshape(-1, 2),
        np.zeros(2 * len(pairs)),
    )


def drawn(kind: str, rng: np.random.Generator) -> dict[str, float]:
    """Numbers such as a thing on another, beside another, or near another has."""
    noise = rng.normal(0, 1, 4)
    if kind == "on":
        return {
            "centre_rise": 0.1, "contact_right": 0.004 * noise[0], "rise_0": 0.04 + 0.004 * noise[1],
            "elevation_0": 1.4 + 0.05 * noise[2], "normal_up_0": 0.95 + 0.02 * noise[3], "gap": 0.001,
            "a_over_b": 0.9 + 0.03 * noise[0],
        }  # fmt: skip
    gap = 0.01 if kind == "adjacent" else 0.06
    return {
        "centre_rise": 0.001 * noise[0], "contact_right": rng.choice([-1, 1]) * (gap + 0.03) + 0.004 * noise[0],
        "rise_0": 0.004 * noise[1], "elevation_0": 0.05 * noise[2], "normal_up_0": 0.02 * noise[3],
        "gap": gap * np.exp(0.1 * noise[1]), "a_over_b": abs(0.03 * noise[0]),
    }  # fmt: skip


@pytest.fixture(scope="module")
def scenes():
    rng = np.random.default_rng(0)
    truth = rng.choice(["on", "adjacent", "none"], 150, p=[0.5, 0.3, 0.2])
    made = []
    for kind in truth:
        a, b = (2, 3) if rng.integers(2) else (3, 2)
        row = drawn(kind, rng)
        if (a, b) == (3, 2):
            row = {name: value if name in ("gap", "a_over_b") else -value for name, value in row.items()}
        made.append(scene((2, 3, row), (2, TABLE, {"centre_rise": 1.0, "gap": 0.5})))
    return made, truth


def test_mixture_finds_the_three(scenes):
    features, truth = scenes
    found = discover(features, np.random.default_rng(0))
    assert found.n_relations >= 3
    assert adjusted_rand_score(truth, found.labels) > 0.9


def test_displacements_tell_on_from_left_and_right(scenes):
    features, truth = scenes
    found = discover_by_displacement(features, np.random.default_rng(0))
    on = found.labels[truth == "on"]
    # One cluster holds all that is on, and nothing beside it is in that cluster.
    assert len(set(on.tolist())) == 1
    assert not set(on.tolist()) & set(found.labels[truth != "on"].tolist())


@pytest.mark.slow
@pytest.mark.parametrize("method", [discover, discover_by_displacement])
def test_numbers_are_by_size_and_repeat(scenes, method):
    features, _ = scenes
    one, other = (method(features, np.random.default_rng(1)) for _ in range(2))
    assert (one.labels == other.labels).all()
    sizes = np.bincount(one.labels)
    assert (np.diff(sizes) <= 0).all()
    assert len(sizes) == one.n_relations


def test_each_pair_stands_once_the_higher_first_and_never_with_the_table():
    features = [
        scene((2, 3, {"centre_rise": 0.1, "rise_0": 0.05}), (2, TABLE, {"centre_rise": 0.2})),
        scene((2, 4, {"centre_rise": -0.1, "rise_0": -0.07})),
    ]
    at, pairs, rows = upright_rows(features, ("rise_0",))
    assert at.tolist() == [0, 1]
    assert pairs.tolist() == [[2, 3], [4, 2]]
    assert rows.ravel().tolist() == [0.05, 0.07]


@pytest.mark.parametrize("method", [discover, discover_by_displacement])
def test_few_pairs_are_no_trouble_and_none_are_refused(method):
    one = [scene((2, 3, {"centre_rise": 0.1}))]
    assert method(one, np.random.default_rng(0)).labels.tolist() == [0]
    assert method(one * 8, np.random.default_rng(0)).labels.tolist() == [0] * 8
    with pytest.raises(InputError, match="at least one pair"):
        method([scene((2, TABLE, {"centre_rise": 0.1}))], np.random.default_rng(0))
