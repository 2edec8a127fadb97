"""Quotas: exact for single pairs, near for scenes of several."""

from dataclasses import dataclass
from itertools import islice

import numpy as np
import pytest

from lifelore.core.relations import CORE_RELATIONS, PairLabel
from lifelore.domains.tabletop.quota import count_relations, is_missed, to_mix, wanted_relation


@dataclass(frozen=True)
class Drawn:
    """What of a scene counts for the mix."""

    truth: tuple[PairLabel, ...]
    attempts: int = 1


THESIS = {"on": 70, "adjacent": 32, "both": 30}


@pytest.mark.parametrize("n", [1, 7, 40, 100])
def test_every_beginning_is_near_the_mix(n):
    wanted = [wanted_relation(i, THESIS) for i in range(n)]
    assert all(
        abs(wanted.count(relation) - THESIS.get(relation, 0) / 132 * n) < 1.5 for relation in CORE_RELATIONS
    )


def scene_of(rng):
    """Three pairs, none and too few on."""
    labels = rng.choice(CORE_RELATIONS, 3, p=[0.3, 0.2, 0.15, 0.35])
    truth = [PairLabel(2, 3, str(label)) for label in labels]
    return Drawn((*truth, PairLabel(2, 1, "on")))


def test_scenes_are_chosen_until_the_mix_is_met():
    rng = np.random.default_rng(0)
    drawn = (scene_of(rng) for _ in range(3000))
    chosen = list(islice(to_mix(drawn, {"on": 2, "adjacent": 1, "both": 1, "none": 1}), 150))
    shares = sum(count_relations(scene.truth) for scene in chosen) / 450
    assert shares == pytest.approx([0.4, 0.2, 0.2, 0.2], abs=0.02)


def test_a_mix_out_of_reach_costs_bounded_draws():
    labels = ["on"] * 20 + ["none"] * 120
    scenes = [Drawn((PairLabel(2, 3, label),)) for label in labels]
    # Up to three of none are within the slack of six (a pair astray moves two shares); then one in six is taken.
    assert 20 + 120 // 6 <= len(list(to_mix(scenes, {"on": 1}))) <= 20 + 3 + 120 // 6


@pytest.mark.parametrize(
    ("counts", "missed"),
    [
        ([70, 32, 30, 0], False),
        ([700, 320, 300, 27], True),  # 27 of 1347 astray move two shares by 0.04 in all
        ([700, 320, 300, 9], False),
        ([0, 1, 0, 0], False),  # of one pair nothing can be said
        ([0, 40, 0, 0], True),
        ([0, 0, 0, 0], False),
    ],
)
def test_when_a_mix_counts_as_missed(counts, missed):
    assert is_missed(counts, THESIS) is missed
