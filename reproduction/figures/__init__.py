"""Kinds of figures that several claims draw: curves, bars with intervals, and a gallery of scenes."""
