"""Colours of objects are fixed, and different."""

from lifelore.figures.scenes.object_palette import mixed, object_palette


def test_colours_are_fixed_and_differ():
    assert mixed("#000000", "#ffffff", 0.5) == "#808080"
    assert len(set(object_palette(range(2, 17)).values())) == 15
