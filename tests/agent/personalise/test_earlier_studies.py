"""A study that an earlier Lifelore kept as lore becomes rows: `earlier/make_earlier.py.txt` made it."""

import gzip
import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.agent.personalise.explanation import explain
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.past import warm
from lifelore.agent.personalise.registration import register
from lifelore.agent.personalise.study import open_study, study_states
from lifelore.agent.personalise.study_report import report
from lifelore.core.errors import InputError, StoreError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory

from .studies import twin

EARLIER = Path(__file__).with_name("earlier")
ABOUT = json.loads((EARLIER / "about.json").read_text())
KINDS = ("reuse_study", "reuse_user", "reuse_past", "reuse_panel", "reuse_request", "reuse_available")
ODD = "o/ä%21"


@pytest.fixture
def old(tmp_path):
    """The file of the earlier Lifelore."""
    with gzip.open(EARLIER / "study.db.gz") as packed, (tmp_path / "m.db").open("wb") as file:
        shutil.copyfileobj(packed, file)
    return tmp_path / "m.db"


@pytest.fixture
def memory(old):
    with open_memory(old) as opened:
        yield opened


def test_nothing_of_the_old_records_is_left_and_the_study_has_its_name(memory):
    assert [*study_states(memory)] == ["shop"]
    assert [kind for kind in KINDS if memory.keys(kind)]
    study = open_study(memory, "shop")
    assert (study.version, study.control, [*study_states(memory)]) == (1, 0.3, ["shop"])
    assert not [kind for kind in KINDS if memory.keys(kind)]
    assert memory.robots() == []
    assert memory.check() == []
    # Once.
    assert open_study(memory, "shop").number == study.number


def test_the_numbers_of_the_report_are_those_of_the_earlier_one(memory):
    """But for users of the panel, who were in no report before."""
    study, before = open_study(memory, "shop"), ABOUT["report"]
    assert report(memory, study)["decisions"] == before["decisions"] + 4
    for user in range(4):
        forget(memory, study, f"v{user}")
    now = report(memory, study)
    for key in ("decisions", "pending", "control_gets", "incumbent"):
        assert now[key] == before[key], key
    # Intervals of few users are of random samples, which depend on the order of the users.
    found = [(now, before), *zip(now["policies"], before["policies"], strict=True)]
    found += zip(now["by_decision"], before["by_decision"], strict=True)
    for one, earlier in found:
        for key in ("personal", "control", "outcome", "name", "state", "decision"):
            if key in earlier and isinstance(earlier[key], dict):
                numbers = {name: one[key][name] for name in ("value", "median", "n")}
                assert numbers == pytest.approx({name: earlier[key][name] for name in numbers}, rel=1e-12)
            else:
                assert one.get(key) == earlier.get(key)
    for one, earlier in ((now["uplift"], before["uplift"]), (now["best_single"], before["best_single"])):
        assert one.get("ci95") == (earlier.get("ci95") and pytest.approx(earlier["ci95"], rel=1e-12))
    assert now["uplift"]["value"] == pytest.approx(before["uplift"]["value"], rel=1e-12)
    assert now["best_single"]["name"] == before["best_single"]["name"]
    # Types now change from outcome to outcome, not from decision to decision, and late outcomes count when they
    # come: beliefs differ a little, and with them what the last belief calls the best policy.
    for group in ("personal", "control"):
        assert now["regret"][group]["n"] == before["regret"][group]["n"]
        assert now["regret"][group]["value"] == pytest.approx(before["regret"][group]["value"], rel=0.2)


def test_old_identifiers_of_open_decisions_take_their_outcomes(memory):
    study = open_study(memory, "shop")
    for decision in [*ABOUT["open"], f"{ABOUT['batch']}/2"]:
        assert update(memory, study, decision, 5.0)["taken"]
        assert not update(memory, study, decision, 5.0)["taken"]
        with pytest.raises(InputError, match="ended with 5 already"):
            update(memory, study, decision, 6.0)
    with pytest.raises(InputError, match=r"ended with 5\.5 already"):
        update(memory, study, f"{ABOUT['batch']}/0", 1.0)
    assert report(memory, study)["pending"] == 1


def test_users_of_the_panel_are_found_by_name_with_their_beliefs(memory):
    study = open_study(memory, "shop")
    for user, outcome, earlier in zip(("v0", "v1"), (5.5, 3.25), ABOUT["beliefs"], strict=True):
        (one,) = explain(memory, study, user)["last"]
        assert one["outcome"] == outcome
        belief = dict(zip(study.library.types, twin(study, [(one["policy"], outcome)]).belief, strict=True))
        assert choose(memory, study, user)["belief"] == pytest.approx(belief, abs=1e-9)
        # The earlier panel took users of a type to be all alike, other than single decisions did.
        assert belief == pytest.approx(earlier, abs=0.1)
        assert explain(memory, study, user)["decisions"] == 2
    with memory.studies.reading(study.number) as rows:
        assert set(rows.users(["v0", "v1", "v2"])) == {"v0", "v1"}, "a user gets the name when it comes"
    assert forget(memory, study, "v3") == 1
    assert explain(memory, study, ODD)["last"][0]["policy"] in ("p0", "p1")
    (some,) = (one for one in explain(memory, study, "u6")["last"] if one["outcome"] is None)
    assert some["available"] == ["p1"]


def test_lines_of_the_old_logs_count_once(memory):
    study = open_study(memory, "shop")
    document = warm([EARLIER / "warm.csv", EARLIER / "fit.csv"], memory, study)
    assert (document["rows"], document["known"]) == (0, 42)
    fit([EARLIER / "fit.csv"], memory, FitSettings("shop", control=0.3))
    document = warm([EARLIER / "warm.csv", EARLIER / "fit.csv"], memory, open_study(memory, "shop"))
    assert (document["rows"], document["known"]) == (0, 42)


def test_a_fit_takes_the_study_of_the_earlier_lifelore(memory):
    document = fit([EARLIER / "fit.csv"], memory, FitSettings("shop", control=0.3))
    assert document["kept"] == {"users": 26, "decisions": 40, "pending": 8, "in_log": 0}
    study = open_study(memory, "shop")
    assert study.version == 2
    assert forget(memory, study, "v2") == 1, "users of whom the key alone is known are still found"


def test_a_registration_takes_the_study_of_the_earlier_lifelore(memory):
    library = PolicyLibrary.from_means([[1.0, 2.0, 3.0]], 1.0, policies=["p0", "p1", "new"])
    study = register(memory, "shop", library)
    assert not [kind for kind in KINDS if memory.keys(kind)]
    assert (report(memory, study)["decisions"], forget(memory, study, "v2")) == (40, 1)


def test_a_damaged_study_stays_as_it_was(old):
    with open_memory(old) as memory:
        (key,) = (key for key, _, _ in memory.keys("reuse_past") if "/" in key)
        record = memory.recall("reuse_past", key, 1)
        broken = replace(record, values=record.values ^ 1)
        memory.contribute("x", [broken], process="p", seq=0, task={})
        with pytest.raises(StoreError, match=r"study 'shop' of an earlier Lifelore is damaged .*restore"):
            open_study(memory, "shop")
        assert memory.studies.newest("shop") is None
        assert memory.keys("reuse_user")


def test_names_of_old_users_leave_no_byte(old):
    with open_memory(old) as memory:
        study = open_study(memory, "shop")
        forget(memory, study, ODD)
        files = [side for side in old.parent.iterdir() if side.name.startswith(old.name)]
        assert not [side for side in files if ODD.encode() in side.read_bytes()]


def test_decisions_without_times_in_their_identifiers_are_before_a_time_too(memory):
    study = open_study(memory, "shop")
    with memory.studies.reading(study.number) as rows:
        users = rows.users([f"u{number}" for number in range(200)])
        decisions = rows.decisions_of([user.number for user in users.values()])
    times = [one.time for own in decisions.values() for one in own]
    with memory.studies.totals(study.number) as totals:
        assert not totals.any_before(min(times))
        assert totals.any_before(min(times) + 1)
        assert totals.n_decisions(since=min(times))[0] == totals.n_decisions()[0]
        assert totals.n_decisions(since=min(times) + 1)[0] < totals.n_decisions()[0]
