"""The pictures of a ward and of advice are drawn from worlds and walks, and pages show each."""

from pathlib import Path

import numpy as np
import pytest

from docs.pictures.buildings import plates, walk
from docs.pictures.figure_advice_system import BLOCKS

ROOT = Path(__file__).parents[2]
PAGES = {
    "assistive_robot": "long_lived.md", "advised_walk": "action_priors.md", "advice_system": "action_priors.md",
}  # fmt: skip


def test_every_picture_is_drawn_and_shown():
    drawn = dict(plates())
    assert drawn.keys() == PAGES.keys()
    for name, page in PAGES.items():
        assert f"](pictures/{name}.png)" in (ROOT / "docs" / page).read_text(encoding="utf-8")
        assert (ROOT / "docs" / "pictures" / f"{name}.png").stat().st_size < 300_000
    words = [text.get_text() for text in drawn["advice_system"].axes[0].texts]
    assert {name for _, _, name, _, _ in BLOCKS.values()} < set(words)


def test_the_walk_is_advised_and_reaches_its_goal():
    done = walk()
    assert done["advised"][done["shown"]]
    assert 0 < done["advised"].mean() < 1
    assert done["theta"].sum() == pytest.approx(1)
    # The last step leads to the goal from the cell beside it.
    assert np.abs(done["path"][-1] - done["goal"]).sum() == 1


def test_twelve_pairs_of_objects():
    pytest.importorskip("mujoco", reason="needs the extra sim")
    from docs.pictures.object_pairs import draw_pairs, pairs

    seen = pairs(n=3)
    assert all(len(cloud.objects) == 2 for cloud, _ in seen)
    assert len(draw_pairs(seen).axes) == len(seen)
    assert {relation for _, relation in seen} <= {"on", "adjacent", "both"}
    assert "](pictures/object_pairs.png)" in (ROOT / "docs" / "perception.md").read_text(encoding="utf-8")
