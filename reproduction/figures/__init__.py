"""Kinds of figures that several claims draw: curves, and bars with intervals."""
