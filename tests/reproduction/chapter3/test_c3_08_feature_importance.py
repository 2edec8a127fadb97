"""Measures of C3.8 from made-up importances, by hand, and importances of counts worked by hand."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.domains.factory.contexts import PHI
from reproduction.chapter3.c3_08_feature_importance.measure import gaps, measure, rows
from reproduction.chapter3.c3_08_feature_importance.run import (
    counted_actions,
    counted_states,
    grid_of,
    importance,
    run_cell,
)
from reproduction.chapter3.factory.modified_tasks import CARDINALS, FULL_SET, contexts_of, problem_of
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.8")
QUICK = dict(claim_of("C3.8").sizes["quick"])

SETTINGS = {**QUICK, "runs": 4, "policies": [3], "over": ["all", "way"], "actions": ["tied"]}
"""A grid of two cells."""
OTHERS = {"PosMM": 0.03, "Items": 0.02}


def increases(run, others=OTHERS, four=0.10):
    """Δ by set: the four cells from 0.10 on, more by run; diagonals 0.04 in φ4."""
    delta = {"PosUM": four, "PosML": four + 0.01, "PosMR": four + 0.02, "PosDM": four + 0.03}
    delta = {name: value + 0.001 * run for name, value in delta.items()} | others
    return {phi: {name: delta.get(name, 0.04) for name in names} for phi, names in PHI.items()}


def made_up(way=OTHERS, way_four=0.10, chosen=CARDINALS):
    def numbers(how, run):
        of_way = how["over"] == "way"
        found = increases(run, way, way_four) if of_way else increases(run)
        selected = {phi: list(chosen) for phi in PHI}
        return {**how, "increase": found, "entropy": dict.fromkeys(PHI, 1.5 + run), "chosen": selected}

    return [{"run": run, "found": [numbers(how, run) for how in grid_of(SETTINGS).cells]} for run in range(4)]


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_gaps_and_shares_by_hand():
    found = measure(SETTINGS, made_up())
    # The least of the four is 0.10 + 0.001 r, 0.1015 on average.
    assert found["gap_phi4"].value == pytest.approx(0.1015 - 0.04)
    assert found["gap_phi3"].value == pytest.approx(0.1015 - 0.03)
    assert found["gap_phi2_to_phi1"].value == pytest.approx(0.1015 - 0.03)
    assert found["diagonal_share_phi4"].value == pytest.approx(0.04 / 0.1015)
    assert found["own_cell_share_phi4"].value == pytest.approx(0.03 / 0.1015)
    assert found["items_share_phi4"].value == pytest.approx(0.02 / 0.1015)
    assert rows(SETTINGS, made_up())[0]["increase"]["phi3"]["PosDM"]["value"] == pytest.approx(0.1315)
    assert found["entropy_phi1"].value == 3.0
    assert found["exactly_four_selected"].value == 1.0
    assert found["grid_consistent"].value == 1.0


def test_a_cell_in_which_another_feature_comes_first_is_not_consistent():
    found = measure(SETTINGS, made_up(way={**OTHERS, "Items": 0.3}))
    assert found["grid_consistent"].value == 0.5
    assert gaps([{"increase": increases(r, {**OTHERS, "Items": 0.3})} for r in range(3)])["gap_phi3"].value < 0


def test_verdicts():
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up()))) == "holds"
    more = measure(SETTINGS, made_up(chosen=(*CARDINALS, "Items")))
    assert more["exactly_four_selected"].value == 0.0
    assert CLAIM.predicate.verdict(plain(more)) == "holds in part"
    settings = {**SETTINGS, "default": {**SETTINGS["default"], "over": "way"}}
    # Items come first in all sets and are chosen: nothing of the claim is left but a small own cell.
    worse = measure(settings, made_up(way={**OTHERS, "Items": 0.3}, chosen=("Items",)))
    assert CLAIM.predicate.verdict(plain(worse)) == "does not hold"


def test_every_condition_asks_of_something_measured():
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(measure(SETTINGS, made_up()))


def test_importance_of_counts_by_hand():
    # Only N tells: where it is free (0) go north, where it is a wall (1) south, six states each.
    values = np.zeros((12, 10), np.int64)
    values[6:, FULL_SET.names.index("PosUM")] = 1
    values[::2, FULL_SET.names.index("Items")] = 1
    best = np.zeros((12, 6), bool)
    best[:6, 0] = best[6:, 1] = True
    prior = ActionPrior(6)
    prior.update(FULL_SET.codes(values), best)
    found = importance(prior)
    # Without N both actions are as likely: one bit. φ1 has no N, so its one bit stays whatever is left out.
    assert found["entropy"] == {"phi1": 1.0, "phi2": 0.0, "phi3": 0.0, "phi4": 0.0}
    assert found["increase"]["phi4"] == {name: float(name == "PosUM") for name in FULL_SET.names}
    assert found["increase"]["phi1"] == {"PosMM": 0.0, "Items": 0.0}
    assert found["chosen"]["phi2"] == ["PosUM"]
    assert found["chosen"]["phi1"] == ["PosMM", "Items"]  # where nothing tells, the mean keeps everything


def test_first_best_actions_by_hand():
    best = np.array([[0, 1, 1], [0, 0, 0], [1, 0, 1]], bool)
    assert counted_actions(best, "first").tolist() == [[False, True, False], [False] * 3, [True, False, False]]
    assert counted_actions(best, "tied") is best


@pytest.fixture(scope="module")
def small():
    settings = {**QUICK, "policies": [1, 2], "default": {**QUICK["default"], "policies": 2}}
    return settings, run_cell(settings, {"run": 0}, 4)


def test_a_small_run_agrees_with_counts_made_anew(small):
    settings, result = small
    prior = ActionPrior(6)
    for i in range(2):
        problem = problem_of(settings, (4, "C3.8", 0, "training", i))
        codes, states = contexts_of(problem, "phi4"), counted_states(problem, "way")
        for state in states:
            prior.update(codes[[state]], problem.best[[state]])
    ours = next(f for f in result["found"] if (f["policies"], f["over"], f["actions"]) == (2, "way", "tied"))
    assert ours["increase"] == importance(prior)["increase"]
    assert len(result["found"]) == len(grid_of(settings).cells) == 8


def test_the_figure_is_drawn_from_rows_alone():
    results = made_up()
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, results)), "rows": rows(SETTINGS, results)}
    bars, grid = CLAIM.draw(result).axes
    assert len(bars.patches) == sum(map(len, PHI.values())) == 22
    assert [text.get_text() for text in grid.texts][:5] == ["102", "112", "122", "132", "30"]
    assert [text.get_fontweight() for text in grid.texts][3:5] == ["bold", "normal"]
