"""Colours of relations, objects and methods are fixed, and different."""

from lifelore.figures.scenes.object_palette import mixed, object_palette
from reproduction.figures.palettes import method_palette, relation_palette


def test_colours_are_fixed_and_differ():
    assert mixed("#000000", "#ffffff", 0.5) == "#808080"
    assert len(set(object_palette(range(2, 17)).values())) == 15
    assert relation_palette(["left_of"])["on"] == relation_palette([])["on"]
    palette = method_palette(["lifelore", "mine", "yours"])
    assert palette["lifelore"] == method_palette(["lifelore"])["lifelore"]
    assert len(set(palette.values())) == 3
    assert method_palette(["thesis", "mine"])["mine"] != method_palette(["thesis"])["thesis"]
    everybody = ["bounding-box rule", "orientation histogram", "thesis", "lifelore"]
    assert len(set(method_palette(everybody).values())) == len(everybody)
