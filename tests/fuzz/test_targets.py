"""Readers under damaged input: seeds are read, findings stay mended, small damage is at most refused."""

from contextlib import suppress
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fuzz.targets import Target, targets
from lifelore.core.errors import LifeloreError

FINDINGS = Path(__file__).parents[2] / "fuzz" / "findings"
FOUND = sorted(FINDINGS.glob("*/*")) if FINDINGS.exists() else []
NAMES = (
    "pcd", "ply", "npz", "depth", "camera", "bag", "map", "jobs", "runs", "log", "memory", "prior", "library",
    "relations", "demonstrations", "steps", "goal", "service",
)  # fmt: skip
SLOW = {"memory": 10, "service": 20, "bag": 20, "relations": 40}
"""Number of damaged inputs of targets that take milliseconds each; others have 200."""


@cache
def known() -> dict[str, Target]:
    return targets()


def test_every_target_is_tested():
    assert tuple(known()) == NAMES


@pytest.mark.parametrize("name", [name for name in NAMES if name != "bag"])
def test_seeds_are_read(name):
    for seed in known()[name].seeds:
        known()[name].read(seed)


@pytest.mark.parametrize("name", NAMES)
def test_damage_is_read_or_refused(name):
    target, random = known()[name], np.random.default_rng(0)
    for number in range(SLOW.get(name, 200)):
        content = bytearray(target.seeds[number % len(target.seeds)])
        if random.random() < 1 / 3:
            content = content[: random.integers(len(content))]
        for _ in range(random.integers(5)):
            if content:
                content[random.integers(len(content))] = random.integers(256)
        try:
            target.read(bytes(content))
        except LifeloreError as error:
            assert "\n" not in str(error)  # noqa: PT017


@pytest.mark.parametrize("file", FOUND, ids=lambda file: f"{file.parent.name}-{file.name[:20]}")
def test_a_finding_stays_mended(file):
    with suppress(LifeloreError):
        known()[file.parent.name].read(file.read_bytes())
