"""Random worlds, as in the tests of core."""

from tests.core.conftest import big_random, draw_world

__all__ = ["big_random", "draw_world"]
