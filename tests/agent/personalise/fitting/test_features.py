"""Numbers known of a user before the first choice: from the log to a prior, stored with the user."""

import csv

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.log.log_format import LogFormat, parse_features
from lifelore.agent.personalise.past import warm
from lifelore.agent.personalise.study import open_study
from lifelore.agent.personalise.study_report import report
from lifelore.core.errors import InputError, NotFoundError

FORM = LogFormat(features=("age", "visits"))
OLD, YOUNG = {"age": 70.0, "visits": 3.0}, {"age": 20.0, "visits": 3.0}


def lines(first=0, users=60, typed=True):
    """Old users like x, young users y; visits mean nothing; every seventh user has no age."""
    random = np.random.default_rng(first)
    head = "user,policy,outcome,age,visits,context" + (",type" if typed else "")
    rows = [head]
    for user in range(first, first + users):
        age = random.integers(18, 80)
        kind = "old" if age + random.normal(0, 4) > 50 else "young"
        for policy in "xy":
            good = (policy == "x") == (kind == "old")
            shown = "" if user % 7 == 0 else age
            row = f"u{user},{policy},{random.normal(3 * good, 1):.3f},{shown},{random.integers(9)},shop"
            rows.append(row + (f",{kind}" if typed else ""))
    return "\n".join(rows) + "\n"


@pytest.fixture
def memory(file_memory):
    """Features are text in both back ends."""
    return file_memory


def features_of(memory, study, user):
    with memory.studies.reading(study.number) as rows:
        return rows.users([user])[user].features


@pytest.fixture
def study(memory, tmp_path):
    (tmp_path / "log.csv").write_text(lines())
    fit([tmp_path / "log.csv"], memory, FitSettings(model="gaussian", control=0.0), FORM)
    return open_study(memory)


def test_a_fit_says_what_the_features_tell(memory, tmp_path):
    (tmp_path / "log.csv").write_text(lines())
    document = fit([tmp_path / "log.csv"], memory, FitSettings(model="gaussian"), FORM)
    assert document["features"]["names"] == ["age", "visits"]
    # Users 0, 7, …, 56 have no age.
    assert document["features"]["users"] == 60 - 9
    assert document["features"]["gain"] > 0.2
    assert fit([tmp_path / "log.csv"], memory, FitSettings(model="gaussian"))["features"] is None


def test_the_prior_follows_the_features_and_is_stored_bit_for_bit(memory, study):
    said = choose(memory, study, "ann", features=OLD)
    prior = study.feature_prior.prior(OLD)
    assert list(said["belief"].values()) == pytest.approx(prior.tolist(), rel=1e-12)
    assert said["belief"]["old"] > 0.8
    assert (said["features"], said["context"]) == (OLD, None)
    assert choose(memory, study, "bob", features=YOUNG)["belief"]["old"] < 0.2
    again = open_study(memory)
    assert again.feature_prior.to_dict() == study.feature_prior.to_dict()


def test_features_are_remembered_and_the_newest_count(memory, study):
    made = choose(memory, study, "ann", features=OLD)
    update(memory, study, made["decision"], 3.0)
    later = choose(memory, study, "ann")
    assert later["features"] == OLD
    changed = choose(memory, study, "ann", features=YOUNG)
    assert changed["belief"]["old"] < later["belief"]["old"]
    other = choose(memory, study, "bob", features=YOUNG)
    update(memory, study, other["decision"], 3.0)
    if other["policy"] == made["policy"]:
        assert choose(memory, study, "bob")["belief"] == changed["belief"]
    assert memory.check() == []


def test_features_come_before_the_context_and_the_context_before_everybody(memory, study):
    said = choose(memory, study, "ann", features=OLD, context="shop")
    assert (said["features"], said["context"]) == (OLD, None)
    said = choose(memory, study, "bob", context="shop")
    assert (said["features"], said["context"]) == (None, "shop")
    assert list(said["belief"].values()) == pytest.approx(study.contexts["shop"].tolist())
    said = choose(memory, study, "cid")
    assert list(said["belief"].values()) == pytest.approx(study.library.prior.tolist())


def test_users_of_the_log_come_back_with_their_features(memory, study, tmp_path):
    assert features_of(memory, study, "u1").keys() == {"age", "visits"}
    assert features_of(memory, study, "u7") is None
    assert choose(memory, study, "u1")["features"] == features_of(memory, study, "u1")
    (tmp_path / "later.csv").write_text(lines(100, 20, typed=False))
    warm([tmp_path / "later.csv"], memory, study, FORM)
    said = choose(memory, study, "u101")
    assert said["features"] == features_of(memory, study, "u101") is not None
    assert choose(memory, study, "u105")["features"] is None


def test_a_new_fit_with_other_features_leaves_the_old_ones_unused(memory, study, tmp_path):
    # Types are static, so that a choice leaves the belief as it is.
    log, settings = [tmp_path / "log.csv"], FitSettings(model="gaussian", control=0.0, change=0.0)
    fit(log, memory, settings, FORM)
    before = choose(memory, open_study(memory), "ann", features=OLD)["belief"]
    fit(log, memory, settings, LogFormat(features=("visits",)))
    said = choose(memory, open_study(memory), "ann")
    assert said["features"] is None
    assert said["belief"] != before
    # The features stay with the user, and count again.
    fit(log, memory, settings, FORM)
    assert choose(memory, open_study(memory), "ann")["belief"] == before


def test_the_log_of_decisions_has_the_features_and_can_be_fitted(memory, study, tmp_path):
    made = choose(memory, study, "ann", features=OLD)
    update(memory, study, made["decision"], 2.0)
    choose(memory, study, "bob")
    report(memory, study, log=tmp_path / "d.csv")
    with (tmp_path / "d.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["age"], row["visits"]) for row in rows] == [("70.0", "3.0"), ("", "")]
    document = fit([tmp_path / "log.csv", tmp_path / "d.csv"], memory, FitSettings(model="gaussian"), FORM)
    assert document["features"]["users"] >= 51
    assert features_of(memory, study, "ann") == OLD


@pytest.mark.parametrize(
    ("features", "error", "words"),
    [
        ({"age": 3.0}, InputError, "features must have all of age, visits, got no visits"),
        ({"age": 3.0, "visits": 1.0, "size": 2.0}, NotFoundError, "unknown feature 'size'"),
        ({"age": float("inf"), "visits": 1.0}, InputError, "feature 'age' must be a finite number"),
        ({}, InputError, "got no age, visits"),
    ],
)
def test_bad_features_are_refused_and_nothing_is_stored(features, error, words, memory, study):
    with pytest.raises(error, match=words):
        choose(memory, study, "ann", features=features)
    with memory.studies.reading(study.number) as rows:
        assert rows.users(["ann"]) == {}


def test_a_study_without_features_says_how_to_get_them(memory, tmp_path):
    (tmp_path / "log.csv").write_text(lines())
    fit([tmp_path / "log.csv"], memory, FitSettings(model="gaussian"))
    with pytest.raises(InputError, match="was fitted without --features"):
        choose(memory, open_study(memory), "ann", features=OLD)


def test_a_log_whose_users_all_miss_a_feature_is_refused(memory, tmp_path):
    (tmp_path / "log.csv").write_text("user,policy,outcome,age,visits\na,x,1,,2\nb,x,2,3,\n")
    with pytest.raises(InputError, match="no user has all of age, visits"):
        fit([tmp_path / "log.csv"], memory, FitSettings(model="gaussian"), FORM)


@pytest.mark.parametrize("words", [["age=31,visits=4"], ["age = 31", "visits=4.0"]])
def test_features_in_words(words):
    assert parse_features(words) == {"age": 31.0, "visits": 4.0}


@pytest.mark.parametrize("word", ["age", "age=old", "age=1,age=2", "=3"])
def test_bad_words_are_refused(word):
    with pytest.raises(InputError, match=r"features must be NAME=NUMBER|feature 'age' must be a number"):
        parse_features([word])
