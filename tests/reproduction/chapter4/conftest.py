"""Random worlds, as in the tests of core."""

from tests.core.conftest import draw_world

__all__ = ["draw_world"]
