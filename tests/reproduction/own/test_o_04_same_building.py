"""O4: edits of a map, the rule of recognition, and measures of made-up comparisons."""

from lifelore.domains.buildings.registration import Fit, Registration
from reproduction.own.o_04_same_building.edits import EDITS
from reproduction.own.o_04_same_building.run import OTHERS, measure, recognised


def test_the_rule_of_recognition():
    def fit(match):
        return Fit((0.0, 0.0, 0.0), match, 0.9, 1 - match)

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
