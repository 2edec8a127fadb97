"""`bench raw_frames` with a room of each kind replaced by frames made by hand."""

import numpy as np
import pytest

from benchmarks.perception import raw_frames
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.raw_room import ROOMS, RawRoom


def frame(seed, number):
    """A table with one box seen from above, filled up with missing pixels; no table in the last kind."""
    kind = list(ROOMS)[number % len(ROOMS)]
    rng = np.random.default_rng(number)
    table = rng.uniform([-0.4, -0.3, 1.0], [0.4, 0.3, 1.0], (9000, 3))
    box = rng.uniform([0, 0, 0.9], [0.1, 0.1, 1.0], (3000, 3))
    face = rng.integers(0, 3, 3000)
    box[face == 0, 0], box[face == 1, 1], box[face == 2, 2] = 0, 0, 0.9
    points = np.full((480 * 640, 3), np.nan)
    labels = np.zeros(480 * 640, np.int64)
    parts = [box] if kind == "glass table" else [table, box]
    measured = np.concatenate(parts)
    points[: len(measured)] = measured
    labels[: len(measured)] = 2 if len(parts) == 1 else np.repeat([1, 2], [len(table), len(box)])
    plane = None if len(parts) == 1 else np.array([0, 0, -1.0, 1.0])
    return RawRoom(
        "room", kind, points, np.zeros((480 * 640, 3), np.uint8), labels, plane, Pose(np.zeros(3), np.eye(3))
    )


@pytest.mark.slow
def test_tables_and_objects_are_counted(monkeypatch):
    monkeypatch.setattr(raw_frames, "raw_room", frame)
    steps = []
    result = raw_frames.bench_raw_frames(1, lambda *step: steps.append(step))
    value = {row["name"]: row["value"] for row in result["rows"]}
    assert len(steps) == len(ROOMS)
    assert value["plain, 1 frames, evidence: right"] == 1
    assert value["plain, 1 frames, largest plane: right"] == 1
    assert value["glass table, 1 frames, evidence: right"] == 1
    # The largest plane of a box alone is its own face.
    assert value["glass table, largest plane: false table"] == 1
    true, cut, found = (value[f"all rooms: objects {part}"] for part in ("true", "cut", "found"))
    # Whether one of the boxes is cut in two is nearly a tie (confidence 0.06), and processors round differently.
    assert (true, found) == (5, 4)
    assert cut in (4, 5)
    assert all(goal["met"] for goal in result["goals"])
