"""Small scenes made by hand: two boxes of points that stand on, beside or apart from one another."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from tests.perception.conftest import box_surface


def box(low, size) -> np.ndarray:
    return box_surface(low, np.add(low, size), 0.01)


def table() -> np.ndarray:
    x, y = np.meshgrid(np.arange(-0.3, 0.3, 0.02), np.arange(-0.3, 0.3, 0.02))
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)


def cloud_of(*parts: np.ndarray) -> LabelledCloud:
    """Objects 2, 3, … in the order given, and the table."""
    every = [table(), *parts]
    labels = [TABLE, *range(2, 2 + len(parts))]
    return LabelledCloud(
        np.concatenate(every), np.repeat(labels, [len(part) for part in every]), None, np.array([0.0, -1.0, 0.8])
    )


def pair(kind: str, rng: np.random.Generator) -> tuple[LabelledCloud, tuple[PairLabel, ...]]:
    """A scene of two boxes in a random place, either of them named first."""
    at = rng.uniform(-0.05, 0.05, 2)
    side = rng.uniform(0.05, 0.07)
    under = box((*at, 0.0), (0.08, 0.08, side))
    if kind == "on":
        other = box((*(at + 0.01), side + 0.002), (0.05, 0.05, 0.06))
    else:
        gap = 0.008 if kind == "adjacent" else 0.05
        angle = rng.uniform(0, 2 * np.pi)
        way = np.array([np.cos(angle), np.sin(angle)])
        other = box((*(at + way * (0.08 + gap) / np.abs(way).max()), 0.0), (0.08, 0.08, side))
    first = bool(rng.integers(2))
    top, bottom = (2, 3) if first else (3, 2)
    parts = (other, under) if first else (under, other)
    carried = kind == "on"
    truth = (
        PairLabel(top, bottom, kind),
        PairLabel(top, TABLE, "none" if carried else "on"),
        PairLabel(bottom, TABLE, "on"),
    )
    return cloud_of(*parts), truth


@pytest.fixture(scope="session")
def lesson():
    """Thirty-six scenes, twelve of each kind."""
    rng = np.random.default_rng(0)
    made = [pair(kind, rng) for _ in range(12) for kind in ("on", "adjacent", "none")]
    return [cloud for cloud, _ in made], [truth for _, truth in made]
