"""Scenes of the thesis's figures settle as they are named."""

import pytest

from lifelore.domains.tabletop.settings import TabletopSettings
from reproduction.chapter2.scenes.figure_scenes import FIGURES, figure_scene

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(FIGURES))
def test_every_figure_settles_as_named(name):
    scene = figure_scene(name, 1, 0, TabletopSettings())
    relations = {(label.a, label.b): label.relation for label in scene.truth}
    for pair in FIGURES[name].on:
        assert relations[pair] in ("on", "both")
