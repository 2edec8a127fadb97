"""Kinds of figures that several claims draw: curves, bars with intervals, points, and a gallery of scenes."""
