"""Colours and markers of relations and methods, distinguishable with every common colour blindness."""

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, YELLOW

RELATION_COLOURS = {"on": BLUE, "adjacent": ORANGE, "both": GREEN, "none": GREY}
RELATION_MARKERS = {"on": "o", "adjacent": "s", "both": "^", "none": "x"}
METHOD_COLOURS = (VERMILION, PURPLE, SKY, YELLOW, INK)
"""Of the methods of a figure, in the order in which they are drawn."""
