"""Scenes put together by hand, as in the tests of perception."""

from tests.perception.conftest import make_scene, meet

__all__ = ["make_scene", "meet"]
