"""Lifelore: an agent that lives long in one kind of world and becomes good at that world."""

__version__ = "0.1.0"
