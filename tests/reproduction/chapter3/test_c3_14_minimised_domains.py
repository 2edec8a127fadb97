"""Measures of C3.14 from made-up cells, by hand."""

import pytest

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from reproduction.chapter3.c3_14_minimised_domains.measure import measure, rows, worst
from reproduction.chapter3.c3_14_minimised_domains.run import FORMS, WHOLE, WITHIN
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.14")
QUICK = dict(claim_of("C3.14").sizes["quick"])

FIRST, LAST = "lattice, every start", "random, few starts"
SETTINGS = {**QUICK, "kinds": [FIRST, LAST], "runs": 4}


def task(traps, left, within):
    return {
        "return_kept": True, "policy_kept": True, "traps": traps, "traps_left": left, "traps_within": within,
        "states": 9,
    }  # fmt: skip


def made_up(repaired=(6, 2), to_80=40, undefined=1):
    """Four runs: in the lattice no traps; in random worlds four in the domain, `repaired` in the repaired one."""
    cells = []
    for run in range(4):
        for kind in SETTINGS["kinds"]:
            here = {"repaired": repaired, "printed": (2, 0), "closed": (1, 0)} if kind == LAST else {}
            exact = {}
            for form in FORMS:
                within = here.get(form, (0, 0))
                each = [task(4, 1, within[0] + run % 2), task(0, 0, within[1])] if here else [task(0, 0, 0)]
                found = undefined if form == "printed" and here else 0
                exact[form] = {"tasks": each, "undefined": found}
            learning = []
            for schedule in SETTINGS["schedules"]:
                for form, ends in ((WHOLE, ""), *WITHIN):
                    episodes = 50 + run if form == WHOLE else to_80 + run
                    collisions = 0.4 + 0.01 * run if form == WHOLE else 0.1
                    learning.append({
                        "form": form, "dead_ends": ends, "schedule": schedule, "to_80": episodes,
                        "never_80": False, "first_ten": 1.0 + run, "regret": 0.1, "collisions": 5.0,
                        "explored_collisions": collisions, "explored_reached": 0.5,
                    })  # fmt: skip
            cells.append({"kind": kind, "run": run, "exact": [exact], "learning": learning})
    return cells


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_numbers_by_hand():
    found = measure(SETTINGS, made_up())
    # A set in four kinds of cells: of eight sets four are undefined as printed.
    assert found["theorem_printed"].value == found["theorem_repaired"].value == 1
    assert found["undefined_printed"].value == 0.5
    # Twelve tasks: eight of random worlds have more in the repaired form (6 or 7 for 4, and 2 for none).
    assert found["more_traps"].value == pytest.approx(8 / 12)
    assert found["more_traps_printed"].value == 0
    assert found["trap_difference_with_traps"].value == pytest.approx(2.5)
    assert found["trap_difference_with_traps_printed"].value == pytest.approx(-1.5)
    assert found["own_traps_left"].value == 0.25
    assert found["traps_where_none"].value == 0.5
    assert found["traps_where_none_closed"].value == 0
    assert found["to_80_ratio_worst"].value == pytest.approx(166 / 206)
    assert found["collisions_ratio_worst"].value == pytest.approx(0.4 / 1.66)


def test_the_worst_is_what_reaches_highest():
    low, high = Estimate(0.9, 0.9, (0.8, 1.0), 4), Estimate(0.8, 0.8, (0.5, 1.4), 4)
    assert worst([low, high]) is high
    same = Estimate(1.5, 1.5, None, 4)
    assert worst([low, same, high]) == Estimate(1.5, 1.5, (1.5, 1.5), 4)
    assert worst([low, Estimate(float("nan"), 0.0, None, 4)]).n == 4


def test_verdicts():
    # The repaired form mends what is undefined and adds traps; the printed one is undefined.
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up()))) == "holds in part"
    # Either would do: the repaired one without new traps, or the printed one if it were defined.
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up((2, 0))))) == "holds"
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(undefined=0)))) == "holds"
    slow = plain(measure(SETTINGS, made_up((2, 0), to_80=80)))
    assert CLAIM.predicate.verdict(slow) == "holds in part"
    nothing = {name: {"value": 9.0, "median": 9.0, "ci95": [9.0, 9.0], "n": 4} for name in slow}
    for form in ("printed", "repaired"):
        nothing[f"theorem_{form}"] = {"value": 0.5, "median": 0.5, "ci95": None, "n": 4}
    assert CLAIM.predicate.verdict(nothing) == "does not hold"


def test_every_condition_asks_of_something_measured():
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(measure(SETTINGS, made_up()))


def test_rows_and_figure():
    cells = made_up()
    found = rows(SETTINGS, cells)
    random = next(row for row in found if row.get("kind") == LAST)
    assert random["printed"]["defined"] == 0
    assert random["repaired"]["traps_within"] == pytest.approx((6.5 + 2) / 2)
    assert random["repaired"]["no_more_traps"] == 0
    assert len([row for row in found if "learnt_in" in row]) == 2 * 2 * (1 + len(WITHIN))
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, cells)), "rows": found}
    kept, walks, learning = CLAIM.draw(result).axes
    assert [tick.get_text() for tick in kept.get_yticklabels()] == SETTINGS["kinds"]
    assert kept.texts[0].get_text() == "100"
    assert walks.texts[0].get_text() == "42"
    assert learning.texts[0].get_text() == "0.81"


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"kinds": '["random, few starts"]'}, "kinds must hold one of lattice, every start"),
        ({"kinds": '["lattice, every start"]'}, "kinds must hold one of random, few starts"),
        ({"size": 8}, "size must be odd"),
        ({"random_states": 5}, "random_states must be at least"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
