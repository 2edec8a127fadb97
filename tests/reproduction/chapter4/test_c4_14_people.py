"""C4.14: without people it cannot be tested; made-up people are measured; recorded people are read."""

import pytest

from lifelore.core.errors import InputError, NotFoundError
from reproduction.chapter4.c4_14_people.records import new_session, store_round
from reproduction.chapter4.c4_14_people.run import cells, measure, run_cell, study_settings
from reproduction.chapter4.c4_14_people.scripted_player import play_session
from reproduction.chapter4.c4_14_people.study_plan import BEAT, PERSON, SCRIPTED, STATIC, TEST, TRAINING
from reproduction.engine.registry import claim_of
from reproduction.engine.reproduce import judged
from reproduction.engine.statement import DIRECTION, REPRODUCED, UNTESTED

CLAIM = claim_of("C4.14")
QUICK = CLAIM.settings("quick", {})


def people(beat, static, confused=(2, 5), number=5):
    """Made-up sessions: the smallest ball is best fast and the largest slow; losses of BEAT and of the static."""
    sessions = []
    for player in range(number):
        scale = 1 + 0.01 * player
        rounds = [
            [TRAINING, size, speed, "", scale * (0.1 if (size == 60) == (speed == 30) else 0.9)]
            for size in QUICK["sizes"]
            for speed in QUICK["speeds"]
        ]
        rounds += [[TEST, size, None, BEAT, scale * beat] for size in QUICK["sizes"]]
        rounds += [[TEST, size, 30, STATIC, scale * static] for size in QUICK["sizes"]]
        ends = [confused, confused[::-1], (60, 60)]
        named = [{"size": size, "last": last, "ratio": [1.0]} for size, last in ends]
        sessions.append({"rounds": rounds, "named": named})
    return {"player": PERSON, "sessions": sessions}


def word(*results):
    return judged(CLAIM, {name: number.to_dict() for name, number in measure(QUICK, results).items()}, [])[0]


def test_without_people_it_cannot_be_tested_whatever_scripts_do():
    assert word() == UNTESTED
    assert word({**people(0.0, 0.5), "player": SCRIPTED}) == UNTESTED
    assert word(people(0.0, 0.5, number=2)) == UNTESTED


def test_people_decide():
    assert word(people(0.0, 0.5)) == REPRODUCED
    # A population of one size loses 0.1 at its best speed, less than with BEAT; the phase transition is found.
    assert word(people(0.3, 0.5)) == DIRECTION
    assert word(people(0.0, 0.5, confused=(5, 60))) == DIRECTION


def test_measures_by_hand():
    found = measure(QUICK, [people(0.3, 0.5)])
    # The losses of player k have the factor 1 + k / 100, on average 1.02.
    assert found["people_small_gains_by_fast"].value == pytest.approx(0.8 * 1.02)
    assert found["people_large_gains_by_slow"].value == pytest.approx(0.8 * 1.02)
    assert found["people_beat_less_static"].value == pytest.approx(-0.2 * 1.02)
    # At their best speeds populations of one size lose 0.1, of two sizes 0.1, 0.5 and 0.5, of all three 0.37; so
    # BEAT, which loses 0.3, gains least in populations of one size.
    assert found["people_least_gain_of_diversities"].value == pytest.approx(-0.2 * 1.02)
    assert found["people_pairs_confused_more_often"].value == 0
    assert found["scripted_sessions"].value == 0


def test_finished_sessions_of_people_are_read_from_a_file(tmp_path):
    where = tmp_path / "people.jsonl"
    for player, rounds in ((PERSON, None), (PERSON, None), (PERSON, 3), (SCRIPTED, None)):
        session = play_session(new_session(where, study_settings(QUICK, player), "consent"))
        for row in session.done[:rounds]:
            store_round(where, session, row)
    settings = CLAIM.settings("quick", {"people": str(where)})
    *scripted, recorded = cells(settings)
    assert [cell["player"] for cell in scripted] == 3 * [SCRIPTED]
    result = run_cell(settings, recorded, 0)
    assert (result["player"], len(result["sessions"])) == (PERSON, 2)
    assert all(len(one["rounds"]) == study_settings(QUICK, PERSON).rounds for one in result["sessions"])


def test_settings_that_are_no_session_are_refused(tmp_path):
    with pytest.raises(NotFoundError, match="is not a file"):
        CLAIM.settings("quick", {"people": str(tmp_path / "none.jsonl")})
    with pytest.raises(InputError, match="at least two each"):
        CLAIM.settings("quick", {"speeds": [30]})
    with pytest.raises(InputError, match="sizes must be distinct"):
        CLAIM.settings("quick", {"sizes": [2, 2]})
