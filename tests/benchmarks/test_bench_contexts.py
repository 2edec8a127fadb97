"""`bench contexts`, small: what the pixel world shows, and that every kind of context is compared."""

import json
from pathlib import Path

import numpy as np

from benchmarks.action.contexts import (
    BY_HAND,
    PIXELS,
    PixelCrossing,
    bench_contexts,
    images_of_walks,
)


def test_the_view_by_hand_is_what_stands_beside_the_agent():
    env = PixelCrossing()
    (x, y, facing), image, free = env.reset(seed=3)[0]
    assert image.shape == (28, 28, 3)
    # A crossing starts in the upper left corner, facing right: the wall is to the left, the way right is free.
    assert (x, y, facing) == (1, 1, 0)
    assert not free[0]
    turned = env.step(0)[0]
    assert turned[0] == (1, 1, 3)
    assert turned[2][:2] == (False, False)
    assert not np.array_equal(turned[1], image)


def test_the_images_of_a_run_are_its_own():
    env = PixelCrossing()
    one, again, other = (images_of_walks(env, run) for run in (0, 0, 1))
    assert np.array_equal(one, again)
    assert one.shape != other.shape or not np.array_equal(one, other)


def test_every_kind_of_context_is_compared():
    ticks = []
    life = {"tasks": 2, "episodes": 60, "max_steps": 200}
    result = bench_contexts(1, lambda *tick: ticks.append(tick), life=life, codes=(4,))
    assert [tick[:2] for tick in ticks] == [(1, 3), (2, 3), (3, 3)]
    sizes = {
        row["name"].split(": ")[1]: row["value"] for row in result["rows"] if row["name"].startswith("contexts")
    }
    assert list(sizes) == [BY_HAND, "4 learnt codes", PIXELS]
    assert 0 < sizes["4 learnt codes"] <= 4
    assert sizes[BY_HAND] <= 8
    assert sizes[PIXELS] > sizes["4 learnt codes"]
    assert len(result["rows"]) == 3 + 3 * 2 * 2


def test_the_page_shows_the_committed_numbers():
    root = Path(__file__).parents[2]
    page = (root / "docs" / "start" / "learning.md").read_text(encoding="utf-8")
    rows = json.loads((root / "results" / "bench_contexts.json").read_text(encoding="utf-8"))["rows"]
    for row in rows:
        measure, _, name = row["name"].partition(": ")
        if measure.startswith("all episodes"):
            told = [f"{number:+.3f}".replace("-", "−") for number in (row["value"], *row["ci95"])]
            (line,) = [line for line in page.splitlines() if line.startswith(f"| {name} |")]
            assert f"{told[0]} ({told[1]} to {told[2]})" in line
