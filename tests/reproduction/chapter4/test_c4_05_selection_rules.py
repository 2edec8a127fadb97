"""C4.5: the figure's statements by hand, and a tiny run."""

import json

import pytest

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from reproduction.chapter4.c4_05_selection_rules.measure import (
    all_certain,
    late_by_seen,
    measure,
    rows,
    sooner_than_next,
    verdicts,
)
from reproduction.chapter4.c4_05_selection_rules.run import run_cell
from reproduction.chapter4.reuse.rules import STANDARD
from reproduction.chapter4.surveillance.runs import CASES, DOUBTING, RULES
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.5")
QUICK = dict(claim_of("C4.5").sizes["quick"])

SMALL = {
    **QUICK,
    "tasks": 2,
    "groups": 2,
    "grid_groups": 2,
    "episodes": 6,
    "noises": ["deviation 20"],
    "after": [5],
}


@pytest.fixture(scope="module")
def cells():
    return json.loads(json.dumps([run_cell(SMALL, cell, 1) for cell in CLAIM.cells(SMALL)]))


def _summary(ended: float, late: float):
    return {"ended_median": Estimate(ended, ended, None, 1), "late_median": Estimate(late, late, None, 1)}


def test_statements_by_hand():
    found = {name: _summary(15, 0.0) for name in RULES} | {"EI": _summary(6, 0.0), "PI": _summary(51, 80.0)}
    found |= {"eps-greedy": _summary(51, 5.0), "EI, printed": _summary(20, 0.0)}
    assert verdicts(found) == {
        "BE converges": True, "KG converges": True, "sampling converges": True, "EI fastest": True,
        "PI fails": True, "eps-greedy fails": False,
    }  # fmt: skip
    printed = verdicts(found, printed=True)
    assert not printed["EI fastest"]
    assert not printed["PI fails"]


def test_a_tiny_run(cells):
    # Rules that trust their models in every case of theirs; the standard forms in the cases that doubt.
    assert len(cells) == len(RULES) * (len(CASES) - len(DOUBTING)) + len(STANDARD) * len(DOUBTING)
    found = measure(SMALL, cells)
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(found)
    assert found["stuck_EI_printed_exact"].n == 4
    assert found["grid_all"].n == 1
    # Three cases beside the default with exact models, in two forms each.
    assert found["grid_statements_certain"].n == 8


def _cells(**ended):
    """Results of six rules, four groups of two tasks: the two that fail end stuck, EI after 3 and 5 episodes."""
    ended = {"EI": (3, 5), "BE": (10, 12), "KG": (9, 9), "sampling": (15, 15)} | ended
    found = {}
    for name in RULES:
        own, late, form = (51, 51), 60.0, name.partition(",")[0]
        if form in ended:
            own, late = ended[form], 0.0
        shifted = [number + group * (form != "EI") for group in range(4) for number in own]
        found[name] = {"groups": 4, "ended": shifted, "late": [late] * 8}
    return found


def test_statements_for_certain():
    # KG is the soonest other: 6 and 4 episodes later, and one more in each further group.
    assert sooner_than_next(_cells()).value == pytest.approx(5 + 1.5)
    assert all_certain(_cells(sampling=(10, 10)), False)
    assert all_certain(_cells(sampling=(10, 10)), True)
    # Its interval reaches 18 episodes; then KG is sooner than EI in the first group; then PI converges.
    assert not all_certain(_cells(sampling=(15, 15)), False)
    assert not all_certain(_cells(sampling=(10, 10), KG=(1, 4)), False)
    assert not all_certain(_cells(sampling=(10, 10), PI=(20, 20)), False)


def test_late_regret_on_seen_and_unseen_tasks():
    assert late_by_seen({"late": [1.0, 3.0, 5.0], "seen": [1, 0, 1]}) == {"seen": 3.0, "unseen": 3.0}
    assert late_by_seen({"late": [1.0], "seen": [1]}) == {"seen": 1.0}


def test_the_figure_is_drawn_from_rows_alone(cells):
    kept = json.loads(json.dumps(rows(SMALL, cells)))
    figure = CLAIM.draw({"settings": SMALL, "rows": kept})
    assert len(figure.axes) == 6
    standard, others = figure.axes[:2]
    assert len(standard.lines) + len(others.lines) == len(RULES)
    assert len(others.lines) == sum("printed" in name or "κ" in name for name in RULES)


def test_settings_that_limits_cannot_describe():
    with pytest.raises(InputError, match="layouts must include the default, X"):
        CLAIM.settings("quick", {"layouts": '["ring"]'})
