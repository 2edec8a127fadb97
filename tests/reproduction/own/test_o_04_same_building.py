"""O4: edits of a map, the rule of recognition, and measures of made-up comparisons."""

import pytest

from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.registration import Fit, Registration
from reproduction.own.o_04_same_building.edits import EDITS, cropped, noisy, refurnished, turned
from reproduction.own.o_04_same_building.run import OTHERS, measure, recognised


def test_edits_leave_the_same_building():
    office = office_map(0, 16.0, 12.0)
    quarter = turned(turned(office, 90.0), -90.0)
    inside = (slice(2, -2), slice(2, -2))
    assert (
        quarter.state[: office.state.shape[0], : office.state.shape[1]][inside] == office.state[inside]
    ).mean() > 0.98
    assert cropped(office, 0.5).state.shape[1] == office.state.shape[1] // 2
    changed = (noisy(office, 1).state != office.state).mean()
    assert 0 < changed < 0.1
    moved = refurnished(office, 1.0, 1)
    assert (moved.state != office.state).any()
    for kind in (FREE, OCCUPIED):  # furniture that finds no place in twenty draws is lost
        assert (moved.state == kind).sum() == pytest.approx((office.state == kind).sum(), rel=0.2)


def test_the_rule_of_recognition():
    def fit(match):
        return Fit((0.0, 0.0, 0.0), match, 0.9)

    assert recognised(Registration(fit(0.97), None))
    assert recognised(Registration(fit(0.97), fit(0.8)))
    assert not recognised(Registration(fit(0.97), fit(0.9)))
    assert not recognised(Registration(fit(0.95), None))


def test_measures_by_hand():
    def made(missed):
        compared = {name: {"match": 0.99, "recognised": name not in missed} for name in EDITS}
        return {"compared": compared | {name: {"match": 0.5, "recognised": name in missed} for name in OTHERS}}

    first = next(iter(EDITS))
    found = measure({}, [made(()), made((first, OTHERS[0]))])
    assert found["recognised"].value == 7 / 8
    assert found["false_recognitions"].value == 1
    assert found["largest_false_match"].value == 0.5
