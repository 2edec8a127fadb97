"""Heights of supports by hand."""

import pytest

from lifelore.perception.places.support_height import support_height


def test_the_table_is_at_0_and_an_object_carries_at_its_visible_top(make_scene, box):
    clouds = {2: box([0, 0, 0], [0.1, 0.1, 0.05]), 3: box([0, 0, 0.06], [0.1, 0.1, 0.1])}
    scene = make_scene(clouds, relations=[(2, 1, "on", 0.9), (3, 2, "both", 0.6)])
    assert support_height(scene, 2) == 0
    assert support_height(scene, 3) == pytest.approx(0.05)
    assert support_height(scene, 3, 0.7) is None


def test_in_a_bowl_it_is_no_higher_than_the_object_that_stands_in_it(make_scene, box):
    clouds = {2: box([0, 0, 0], [0.1, 0.1, 0.08]), 3: box([0.02, 0.02, 0.03], [0.05, 0.05, 0.1])}
    assert support_height(make_scene(clouds, relations=[(3, 2, "on")]), 3) == pytest.approx(0.03)


def test_of_several_supports_the_lowest_counts_and_neighbours_are_none(make_scene, box):
    clouds = {label: box([0.2 * label, 0, 0], [0.2 * label + 0.1, 0.1, 0.01 * label]) for label in (2, 3, 4)}
    clouds[5] = box([0.4, 0, 0.1], [1, 0.1, 0.2])
    rows = [(5, 3, "on"), (5, 2, "on"), (5, 4, "adjacent"), (2, 1, "none")]
    scene = make_scene(clouds, relations=rows)
    assert support_height(scene, 5) == pytest.approx(0.02)
    assert support_height(scene, 2) is None
