"""Figure of claim C3.6."""

from reproduction.chapter3.c3_05_one_component.figure import draw

__all__ = ["draw"]
