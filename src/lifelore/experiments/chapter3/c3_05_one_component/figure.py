"""Figure of claim C3.5."""

from lifelore.experiments.chapter3.factory.gains_figure import draw

__all__ = ["draw"]
