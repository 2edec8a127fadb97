"""What a pick shows of relations: labels of pairs by Bayes' rule, by hand."""

from lifelore.agent.long_lived.families.pick_lessons import FALLS, TrayPairs
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import PairBelief


def pairs(*beliefs: PairBelief) -> TrayPairs:
    return TrayPairs(None, beliefs, {0: 2, 1: 3, 2: 4})  # pyright: ignore[reportArgumentType]


def belief(a: int = 2, b: int = 3, **shares: float) -> PairBelief:
    return PairBelief(a, b, 0.0, {name.replace("under", "~on"): share for name, share in shares.items()})


def test_what_falls_lay_on_the_lifted_object_though_perception_doubted_it():
    # P(on | fell) = 0.7 · 0.2 / (0.7 · 0.2 + 0.02 · 0.8) = 0.90: probable, not certain
    tray = pairs(belief(on=0.2, adjacent=0.8))
    assert FALLS == {True: 0.7, False: 0.02}
    assert tray.shown_by(1, fallen=(0,), knocked=()) == [PairLabel(2, 3, "on", 2)]


def test_what_stays_did_not_lie_on_it():
    tray = pairs(belief(on=0.6, adjacent=0.4))
    assert tray.shown_by(1, fallen=(), knocked=()) == [PairLabel(2, 3, "adjacent", 1)]


def test_a_surprise_that_fingers_may_have_caused_is_doubtful():
    tray = pairs(belief(on=0.02, adjacent=0.98))
    assert tray.shown_by(1, fallen=(0,), knocked=())[0].confidence == 1


def test_the_order_of_a_pair_is_kept():
    tray = pairs(belief(under=0.9, none=0.1))  # ~on(2, 3) is on(3, 2)
    assert tray.shown_by(0, fallen=(1,), knocked=()) == [PairLabel(3, 2, "on", 3)]
    # The upper one is lifted, and the lower one stays: perception is confirmed.
    assert tray.shown_by(1, fallen=(), knocked=()) == [PairLabel(3, 2, "on", 2)]


def test_nothing_is_said_of_knocked_objects_other_pairs_the_table_and_parts():
    tray = pairs(belief(on=1.0), belief(2, 4, on=1.0), belief(2, TABLE, on=1.0), belief(3, 9, on=1.0))
    assert tray.shown_by(1, fallen=(), knocked=(0,)) == []
