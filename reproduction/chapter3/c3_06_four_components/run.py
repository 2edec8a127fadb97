"""C3.6: the same as C3.5 with four components, of whose tasks only a fraction is met.

Thesis: §3.4.3, Figure 3.9.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from reproduction.chapter3.c3_05_one_component import run as one_component
from reproduction.chapter3.c3_05_one_component.run import cells, run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    """Refuse settings without one component to compare with."""
    one_component.check(settings)
    if settings["components"][1] != 1:
        raise InputError(f"components must be a number and 1 to compare it with, got {settings['components']}")
