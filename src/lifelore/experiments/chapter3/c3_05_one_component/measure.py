"""Measures and rows of claim C3.5."""

from lifelore.experiments.chapter3.factory.gains import measure, rows

__all__ = ["measure", "rows"]
