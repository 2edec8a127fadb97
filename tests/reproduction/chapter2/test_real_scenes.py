"""The real scenes: found by LIFELORE_DATA alone, upright, labelled as their truth names them."""

import os

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter2.scenes.real_scenes import real_scenes, real_scenes_folder


@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
def test_scenes_are_upright_and_their_truths_name_what_is_there():
    scenes = real_scenes()
    assert [scene.name for scene in scenes] == sorted(scene.name for scene in scenes)
    assert len(scenes) == 26
    for scene in scenes:
        named = {end for label in scene.truth for end in (label.a, label.b)}
        assert named <= {1, *scene.cloud.objects}
        # The table lies at z = 0 within a depth camera's noise, and things stand above it.
        assert abs(np.median(scene.cloud.of(1)[:, 2])) < 0.005
        assert all(np.median(scene.cloud.of(thing)[:, 2]) > 0.005 for thing in scene.cloud.objects)
    assert real_scenes() is scenes


def test_without_data_one_line_says_what_to_set(monkeypatch, tmp_path):
    monkeypatch.delenv("LIFELORE_DATA", raising=False)
    assert real_scenes_folder() is None
    with pytest.raises(InputError, match="LIFELORE_DATA must name a folder"):
        real_scenes()
    monkeypatch.setenv("LIFELORE_DATA", str(tmp_path))
    assert real_scenes_folder() is None
