"""Functional similarity: equal roles score 1 whatever the sizes, unlike ones less; D2 by what is known of it."""

import numpy as np
import pytest

from lifelore.core.streams import stream
from reproduction.chapter5.c5_02_functional_roles.functional_similarity import overlap, role, shape_distribution

POINT = np.zeros((1, 3))
DOWN, EAST = [0, 0, -1.0], [1.0, 0, 0]


def likeness(scene_a, a, scene_b, b) -> float:
    return overlap(role(scene_a, a), role(scene_b, b))


@pytest.fixture
def pile(make_scene, meet):
    """``pile(scale, labels)``: three objects one on another on the table."""

    def build(scale, labels=(2, 3, 4)):
        below = [1, *labels[:-1]]
        parts = [meet(b, a, [[0, 0, scale * k]]) for k, (a, b) in enumerate(zip(below, labels, strict=True))]
        return make_scene(dict.fromkeys(labels, POINT), parts)

    return build


def test_equal_roles_are_alike_whatever_the_numbers_and_sizes(pile):
    small, large = pile(0.05), pile(0.4, (7, 5, 9))
    assert [likeness(small, a, large, b) for a, b in ((2, 7), (3, 5), (4, 9))] == [1, 1, 1]


def test_the_middle_of_a_pile_is_like_another_middle_before_all_else(pile):
    one, other = pile(0.1), pile(0.1)
    scores = np.array([likeness(one, 3, other, label) for label in (2, 3, 4)])
    assert np.argmax(scores) == 1
    assert (np.delete(scores, 1) < 1).all()


def test_a_bridge_is_like_a_bridge_before_a_tower(make_scene, meet):
    def bridge(span):
        posts = [meet(2, 1, [[0, 0, 0]]), meet(3, 1, [[span, 0, 0]])]
        return make_scene(
            dict.fromkeys((2, 3, 4), POINT), [*posts, meet(4, 2, [[0, 0, 0.1]]), meet(4, 3, [[span, 0, 0.1]])]
        )

    tower = make_scene({2: POINT, 3: POINT}, [meet(2, 1, [[0, 0, 0]]), meet(3, 2, [[0, 0, 0.1]])])
    lone = make_scene({2: POINT}, [meet(2, 1, [[0, 0, 0]])])
    others = [(bridge(0.5), 4), (tower, 3), (lone, 2)]
    scores = [likeness(bridge(0.1), 4, scene, label) for scene, label in others]
    assert scores[0] == 1
    assert 1 > scores[1] > scores[2]


def test_tokens_by_hand(make_scene, meet):
    # 3 stands on the table, carries 2, and has 4 at its east side.
    parts = [meet(2, 3, [[0, 0, 0.1]]), meet(3, 1, [[0, 0, 0]]), meet(4, 3, [([0.05, 0, 0.05], EAST)])]
    tokens = role(make_scene({2: POINT, 3: POINT, 4: POINT}, parts), 3)
    assert tokens[("points", 3)] == 1
    assert {k[1:] for k in tokens if k[0] == "contact"} == {
        ("above", "object"),
        ("below", "table"),
        ("beside", "object"),
    }
    assert sum(n for k, n in tokens.items() if k[0] == "edge") == 2
    # Neighbours 2 and 4 touch nothing else, and steps never go on from the table.
    assert not any(k[0] == "steps" for k in tokens)


def test_shape_does_not_see_size_and_tells_a_ball_from_a_rod():
    rng = stream(0, "shapes")
    ball = rng.normal(size=(4000, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    rod = np.c_[rng.random(4000), np.zeros((4000, 2))]
    # Sampling leaves about sqrt(BINS / DISTANCES) of L1 noise: 6 %.
    round_, larger, long = (shape_distribution(points, rng) for points in (ball, 7 * ball, rod))
    assert np.abs(round_ - larger).sum() / 2 < 0.07
    assert np.abs(round_ - long).sum() / 2 > 0.3
    # Distances of two points on a sphere have the density d / 2 on [0, 2], mean 4 / 3: none beyond 1.5 means.
    histogram = shape_distribution(ball, rng)
    edges = np.linspace(0, 3, len(histogram) + 1)[1:]
    expected = np.minimum((edges * 4 / 3) ** 2 / 4, 1)
    assert np.abs(np.cumsum(histogram) - expected).max() < 0.02
