"""C4.2: the dynamic program on golf by brute force, and a tiny run."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.selection import Greedy
from reproduction.chapter4.c4_02_golf_holes.measure import measure, rows
from reproduction.chapter4.c4_02_golf_holes.run import program_gaps, run_cell
from reproduction.chapter4.golf.rounds import exact_library, play_holes
from reproduction.chapter4.reuse.rules import RULES_SHOWN
from reproduction.engine.estimates import is_above, is_below
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.2")
QUICK = dict(claim_of("C4.2").sizes["quick"])

SMALL = {**QUICK, "groups": 3, "holes": 12, "shots": 3, "horizon": 2}


@pytest.fixture(scope="module")
def cells():
    kept = [run_cell(SMALL, cell, 2) for cell in CLAIM.cells(SMALL) if cell.get("rule", "greedy") in SHOWN]
    return json.loads(json.dumps(kept))


SHOWN = ("greedy", "IDS", "sampling")


def test_two_shots_of_the_program_by_plain_loops():
    library = exact_library()
    mean, probs, prior = library.performance.mean, library.signal.probs, library.prior
    best = []
    for first in range(4):
        later = sum(max((prior * probs[:, first, c]) @ mean[:, p] for p in range(4)) for c in range(7))
        best.append(prior @ mean[:, first] + later)
    found = program_gaps(2)
    assert found["dynamic program"]["yards"] == pytest.approx(-max(best), abs=1e-5)
    assert found["dynamic program"]["first_club"] == "6-iron"
    assert set(RULES_SHOWN) <= set(found)
    assert min(way["gap"] for name, way in found.items() if name != "hole known") >= 0


def test_a_known_hole_beats_the_program_and_one_club_alone_does_not():
    found = program_gaps(2)
    assert found["hole known"]["gap"] < 0 < found["only the 3-iron"]["gap"]
    # By hand: 35 yards and more with the 6-iron on average, twice.
    assert found["only the 6-iron"]["yards"] == pytest.approx(2 * 33.697, abs=0.001)


def test_holes_are_played_with_their_luck():
    luck = np.array([[0.0, 1.0], [0.0, -1.0]])
    found = play_holes(Greedy(), exact_library(), np.array([150.0, 219.0]), luck, 0, first=2)
    assert found.error[:, 0].tolist() == [0.0, -69.0]
    # "Within 5" makes 150 yards likeliest, "short by > 50" 220: the 6-iron again, and the wood.
    assert found.clubs.tolist() == [[2, 2], [2, 0]]
    assert found.error[:, 1].tolist() == [6.0, 215 - 8 - 219]


def test_a_tiny_run(cells):
    found = measure(SMALL, cells)
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(found)
    assert found["gain_over_best_single_club_exact"].value > 0
    ways = [f"{first}{model}" for model in ("learnt", "exact", "uncertain") for first in ("", "wood_first_")]
    near = [is_below(found[f"error_shot_2_{way}"], 15.0) for way in ways]
    falls = [is_above(found[f"entropy_fall_first_{way.removeprefix('wood_first_')}"], 0.0) for way in ways]
    assert found["grid_within_15"].value == np.mean(np.logical_and(near, falls))
    assert found["entropy_fall_first_exact"].value > 0.5
    errors = np.array(next(c["error"] for c in cells if c.get("rule") == "greedy" and c["model"] == "exact"))
    assert errors.shape == (3, 3)
    assert found["error_shot_2_exact"].value == pytest.approx(errors[:, 1].mean())


def test_the_figure_is_drawn_from_rows_alone(cells):
    kept = json.loads(json.dumps(rows(SMALL, cells)))
    figure = CLAIM.draw({"settings": SMALL, "rows": kept})
    assert [axes.get_title("left") for axes in figure.axes] == [
        "Mean error, yards",
        "Entropy of the belief, nats",
        "Yards above the optimum",
    ]
    assert len(figure.axes[2].patches) == len(RULES_SHOWN)


def test_settings_that_limits_cannot_describe():
    with pytest.raises(InputError, match="yards must rise"):
        CLAIM.settings("quick", {"yards": "[220.0, 120.0]"})
