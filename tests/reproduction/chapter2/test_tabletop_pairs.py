"""Pairs as rows: what a row holds of blocks built by hand, which pairs have one, and how lots are cut."""

from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import ADJACENT, NONE, ON, PairLabel
from lifelore.perception.separation.separator import separate
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import (
    KERNELS,
    LOT,
    MIX,
    STANDARD,
    kernel_name,
    pair_cells,
    pair_rows,
    run_cell,
)
from tests.perception.conftest import box_surface

CAMERA = np.array([0.05, -1.0, 0.6])
SETTINGS = {"data_sets": 2, "pairs": 50, "camera": "stereo", "real": False}


@pytest.fixture(scope="module")
def blocks() -> LabelledCloud:
    """3 stands on 2 with 2 mm between them, 4 far off; a patch of table, and three points of nobody."""
    parts = {
        0: np.full((3, 3), 0.3),
        1: box_surface((0, 0, -0.01), (0.1, 0.1, -0.005), 0.01),
        2: box_surface((0, 0, 0), (0.1, 0.08, 0.05)),
        3: box_surface((0.02, 0.02, 0.052), (0.06, 0.06, 0.102)),
        4: box_surface((0.5, 0.5, 0), (0.55, 0.55, 0.05)),
    }
    labels = np.repeat(list(parts), [len(part) for part in parts.values()])
    return LabelledCloud(np.vstack(list(parts.values())), labels, None, CAMERA)


TRUTH = (PairLabel(3, 2, ON, 3), PairLabel(2, 4, NONE, 2), PairLabel(4, 3, ADJACENT, 1), PairLabel(2, 1, ON, 3))


@pytest.fixture(scope="module")
def rows(blocks):
    return pair_rows("by hand", blocks, TRUTH)


def test_the_doubtful_and_the_table_have_no_row(rows):
    assert [(row["a"], row["b"], row["relation"], row["confidence"]) for row in rows] == [
        (3, 2, ON, 3),
        (2, 4, NONE, 2),
    ]
    assert {row["scene"] for row in rows} == {"by hand"}


def test_a_far_pair_has_its_truth_alone(rows):
    assert rows[1] == {
        "scene": "by hand",
        "a": 2,
        "b": 4,
        "relation": NONE,
        "confidence": 2,
        "centres": rows[1]["centres"],
        "gap": None,
        "contacts": {},
    }
    # Middles at (50, 40, 25) and (525, 525, 25) mm; thinning moves them by less than a millimetre.
    np.testing.assert_allclose(rows[1]["centres"], [-0.475, -0.485, 0], atol=1e-3)


def test_a_near_pair_is_in_the_order_of_the_truth(rows):
    row = rows[0]
    assert row["gap"] == 0.002
    np.testing.assert_allclose(row["centres"], [-0.01, 0, 0.052], atol=1e-3)
    three, two = (row["contacts"][STANDARD][side] for side in "ab")
    # Contacts of 2 lie on or in 2, up to its top at 50 mm; those of 3 start at 52 mm, over the same place.
    assert all(0 <= x <= 0.1 and 0 <= y <= 0.08 and 0 <= z <= 0.05 for x, y, z, _ in two)
    assert all(0.02 <= x <= 0.06 and 0.02 <= y <= 0.06 and z >= 0.052 for x, y, z, _ in three)
    assert two[0][2] > 0.045
    assert three[0][2] < 0.057


def test_each_kernel_finds_its_contacts_and_none_is_dropped(rows, blocks):
    contacts = rows[0]["contacts"]
    assert list(contacts) == [kernel_name(*kernel) for kernel in KERNELS]
    for length, cost in KERNELS:
        found = separate(blocks.of(2), blocks.of(3), length=length, cost=cost)
        sides = (found.support_second, found.support_first)
        counted = [sum(n for *_, n in contacts[kernel_name(length, cost)][side]) for side in "ab"]
        assert counted == list(map(len, sides))
    narrow, wide = (contacts[kernel_name(length, 10.0)]["a"] for length in (0.03, 0.12))
    assert narrow != wide


def test_the_truths_order_turns_contacts_and_centres(rows, blocks):
    (turned,) = pair_rows("by hand", blocks, [PairLabel(2, 3, ON, 3)])
    row = rows[0]
    assert (turned["a"], turned["b"], turned["gap"]) == (2, 3, row["gap"])
    assert turned["centres"] == [-x for x in row["centres"]]
    for kernel, sides in turned["contacts"].items():
        assert [sides["a"], sides["b"]] == [row["contacts"][kernel][side] for side in "ba"]


# --- lots -------------------------------------------------------------------------------------------------


def test_data_sets_are_cut_into_lots():
    assert pair_cells(SETTINGS) == [{"data_set": n, "first": first} for n in (0, 1) for first in (0, 22, 44)]
    assert len(pair_cells({**SETTINGS, "pairs": LOT})) == 2


@pytest.fixture
def drawn(monkeypatch, blocks):
    """Every third scene is beyond doubt; the seeds, numbers and settings that were asked for."""
    asked: list[tuple] = []

    def sample_scene(seed, number, settings):
        asked.append((seed, number, settings))
        sure = 3 if len(asked) % 3 == 0 else 1
        return SimpleNamespace(cloud=blocks, truth=[PairLabel(2, 4, NONE, sure), PairLabel(2, 1, ON, 1)])

    monkeypatch.setattr(tabletop_pairs, "sample_scene", sample_scene)
    return asked


def test_a_lot_ends_with_its_data_set_and_doubtful_scenes_are_drawn_anew(drawn):
    result = run_cell({**SETTINGS, "pairs": 46}, {"data_set": 1, "first": 44}, 7)
    assert result["set"] == 1
    assert [row["scene"] for row in result["rows"]] == ["1-44", "1-45"]
    assert {row["confidence"] for row in result["rows"]} == {3}
    # What is said of the table is no reason to draw anew: twice two doubtful ones and a good one.
    assert [number for _, number, _ in drawn] == [44, 44, 44, 45, 45, 45]
    assert len({seed for seed, *_ in drawn}) == 6
    settings = drawn[0][2]
    assert (settings.arrangement, settings.camera, settings.shapes) == ("pair", "stereo", "all")
    assert settings.mix == MIX
