"""Measures of C4.4 from made-up cells, by hand, and a tiny run."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.pacman.pacman import STRATEGIES
from reproduction.chapter4.c4_04_pacman.measure import measure, rows
from reproduction.chapter4.c4_04_pacman.run import LEARNERS, REUSERS
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.registry import claim_of
from reproduction.engine.reproduce import reproduce

CLAIM = claim_of("C4.4")
QUICK = dict(claim_of("C4.4").sizes["quick"])

SETTINGS = {**QUICK, "layouts": 3, "episodes": 10_000}
N_BLOCKS = len(block_edges(10_000)) - 1


def task(strategy, bpr=2, prq=1000, scaled=5000, q=None, greedy=400):
    needed = dict.fromkeys((*REUSERS, *LEARNERS), 10) | {"bpr": bpr, "prq": prq, "prq_scaled": scaled, "q": q}
    curves = {name: [float(bpr or 0)] * N_BLOCKS for name in ("bpr", "prq", "q")}
    return {
        "type": strategy,
        "best": 140.0,
        "needed": needed,
        "stretch": dict.fromkeys(REUSERS, 4),
        "regret": dict.fromkeys(REUSERS, 30.0),
        "greedy": dict.fromkeys(LEARNERS, greedy),
        "curves": curves,
    }


def cell(layout, **changes):
    moved = [{"type": s, "best": 20.0} | dict.fromkeys(("bpr", *LEARNERS), 15.0) for s in STRATEGIES]
    plain = {"layout": layout, "foods": [0, 1, 2, 3], "mean": [[0.0] * 4] * 4, "deviation": [[0.0] * 4] * 4}
    return {**plain, "tasks": [task(s, **changes) for s in STRATEGIES], "moved": moved}


def test_powers_of_ten_by_hand():
    found = measure(SETTINGS, [cell(0), cell(1), cell(2, bpr=None)])
    # Never counts as all 10,000. Q-learning: 10,000 / 2 twice, 10,000 / 10,000 once.
    assert found["orders_q"].value == pytest.approx((2 * np.log10(5000) + 0) / 3)
    # The faster of PRQ's two readings, 1000: 500 twice, a tenth once.
    assert found["orders_prq"].value == pytest.approx((2 * np.log10(500) - 1) / 3)
    assert found["orders_prq_as_returned"].value == found["orders_prq"].value
    assert found["orders_greedy_q"].value == pytest.approx((2 * np.log10(200) + np.log10(0.04)) / 3)
    # With more samples every task took ten.
    assert found["orders_q_more_samples"].value == pytest.approx(3)
    # With models in doubt every task took ten too, and by the learners' own stretch four.
    assert found["orders_q_doubting_needed"].value == pytest.approx(3)
    assert found["orders_prq_doubting_stretch"].value == pytest.approx(np.log10(250))
    assert found["reached_stretch_bpr_doubting"].value == 1
    assert found["regret_bpr_doubting"].value == 30
    assert found["median_needed_bpr"].value == 2
    assert found["orders_q"].n == 3
    # A mean power of 3 with samples of more, 3.4 by the learners' stretch; as many of PRQ are 2 and 2.4.
    assert found["grid_orders"].n == 7 * 2
    assert found["reached_bpr"].value == pytest.approx(2 / 3)
    assert found["reached_q"].value == 0
    assert (found["moved_best"].value, found["moved_bpr"].value) == (20, 15)
    # Four policies and sixteen pairs of ten samples.
    assert found["training_episodes"].value == 4 * 20_000 + 160


def test_the_faster_reading_is_chosen_task_by_task():
    mixed = cell(0)
    mixed["tasks"][0] = task("top row", prq=None, scaled=200)
    found = measure(SETTINGS, [mixed])
    assert found["orders_prq"].value == pytest.approx((np.log10(100) + 3 * np.log10(500)) / 4)


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({"greedy": 400}, "holds"),
        ({"greedy": 20}, "holds in part"),
        ({"prq": 20, "greedy": 20}, "holds in part"),
        ({"q": 20, "prq": 20}, "does not hold"),
    ],
)
def test_verdicts(changes, verdict):
    # Three layouts that differ a little, so that there is an interval.
    cells = [cell(layout, **changes) for layout in range(3)]
    for layout, one in enumerate(cells):
        one["tasks"][0]["needed"]["bpr"] = 1 + layout
    measured = {name: number.to_dict() for name, number in measure(SETTINGS, cells).items()}
    assert CLAIM.predicate.verdict(measured) == verdict


def test_rows_hold_libraries_tasks_and_curves():
    found = rows(SETTINGS, [cell(0), cell(1, bpr=4)])
    assert [row["layout"] for row in found if "layout" in row] == [0, 1]
    assert sum("task_of" in row for row in found) == 8
    curves = {row["curve_of"]: row for row in found if "curve_of" in row}
    # Four tasks of 2 and four of 4: mean 3, standard deviation √(8/7).
    assert curves["bpr"]["mean"] == [3.0] * N_BLOCKS
    assert curves["bpr"]["deviation"] == [1.1] * N_BLOCKS


def test_a_tiny_run_and_its_figure(tmp_path):
    tiny = {"layouts": 3, "training_episodes": 2000, "episodes": 200, "peer_episodes": 100, "checkpoints": [50]}
    (result,) = reproduce(["C4.4"], overrides=tiny, out=tmp_path, jobs=1)
    assert result["verdict"] in ("holds", "holds in part", "does not hold")
    assert (tmp_path / "C4.4" / "figure.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"checkpoints": "[100, 30]"}, "checkpoints must rise"),
        ({"checkpoints": "[5000]"}, "checkpoints must rise"),
        ({"checkpoints": "[0.5]"}, "checkpoints must"),
        ({"rows": 6}, "rows must be odd"),
        ({"samples": 50}, "must have 30 between them, got 50 and 100"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
