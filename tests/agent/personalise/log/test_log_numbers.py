"""Columns of numbers in logs (weights, features) and tables in memory as logs."""

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.log.log import read_log
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.past import warm
from lifelore.agent.personalise.study import open_study
from lifelore.core.errors import InputError
from lifelore.memory import open_memory

WEIGHTED = LogFormat({"weight": "ipw"})


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


@pytest.fixture
def written(tmp_path):
    def write(text, name="log.csv"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_weights_are_read_only_where_they_are_named(written):
    path = written("user,policy,outcome,weight\na,p,1,2.5\nb,p,2,0\n")
    assert read_log([path]).weights is None
    assert read_log([path], LogFormat({"weight": "weight"})).weights.tolist() == [2.5, 0]


def test_features_are_each_users_last_values(written):
    form = LogFormat(features=("Age", "visits"), decimal_comma=True, separator="semicolon", missing=("NA",))
    text = "user;policy;outcome;visits;age\na;p;1;4;31,5\na;p;2;;\na;p;3;7;NA\nb;p;;3;20\nb;p;1;;\nc;p;1;1;9\n"
    log = read_log([written(text), written(text.replace("\na;", "\nd;"), "more.csv")], form)
    # A line without an outcome is left out with its features.
    expected = {"a": [31.5, 7], "b": [np.nan, np.nan], "c": [9, 1], "d": [31.5, 7]}
    assert log.feature_names == ("Age", "visits")
    for user, values in zip(log.user.names, log.features_of_user, strict=True):
        np.testing.assert_array_equal(values, expected[user])


def test_a_head_that_the_log_of_decisions_escaped_names_its_features(written):
    log = read_log([written("user,policy,outcome,'=age\na,p,1,4\n")], LogFormat(features=("=age",)))
    assert log.features.tolist() == [[4.0]]


@pytest.mark.parametrize(
    ("text", "form", "words"),
    [
        ("user,policy,outcome\na,p,1\n", WEIGHTED, "it has no ipw"),
        ("user,policy,outcome\na,p,1\n", LogFormat(features=("age",)), "it has no age"),
        ("user,policy,outcome,ipw\na,p,1,-2\n", WEIGHTED, "line 2: ipw must be a weight of at least 0, got '-2'"),
        ("user,policy,outcome,ipw\na,p,1,\n", WEIGHTED, "line 2: ipw must be a weight of at least 0, got ''"),
        ("user,policy,outcome,ipw\na,p,1,much\n", WEIGHTED, "line 2: ipw must be a finite number, got 'much'"),
        ("user,policy,outcome,age\na,p,1,old\n", LogFormat(features=("age",)), "line 2: age must be a finite"),
        ("user,policy,outcome,age,age\na,p,1,2,3\n", LogFormat(features=("age",)), "must have one column 'age'"),
        ("user,policy,outcome,ipw\na,p,1,0\n", WEIGHTED, "weight must be above 0 on at least one line"),
    ],
)
def test_bad_numbers_are_refused_by_their_line(text, form, words, written, memory):
    with pytest.raises(InputError, match=words):
        fit([written(text)], memory, FitSettings(model="gaussian"), form)


@pytest.mark.parametrize("features", [("age", "age"), (" ",)])
def test_bad_names_of_features_are_refused(features):
    with pytest.raises(InputError, match="features must be names of columns, each once"):
        LogFormat(features=features)


LINES = ["a,k,x,1,1", "a,k,x,3,3", "b,l,x,5,2", "b,l,y,6,0", "b,l,z,9,1", "c,k,y,4,1"]
HEAD = "user,type,policy,outcome,w\n"


def test_a_fit_with_weights_by_hand(written, memory):
    form = LogFormat({"weight": "w"})
    document = fit([written(HEAD + "\n".join(LINES) + "\n")], memory, FitSettings(model="gaussian"), form)
    library = open_study(memory).library
    assert library.policies == ("x", "y", "z")
    # (1 + 3 · 3) / 4; y on type l has no weighted outcome and gets that of k, z on k that of l.
    assert library.performance.mean.tolist() == [[2.5, 4, 9], [5, 4, 9]]
    assert library.performance.moments.count[0].tolist() == pytest.approx([16 / 10, 1, 1])
    assert document["outcomes"] == [[2, 1, 0], [1, 0, 1]]
    assert document["borrowed"] == 2
    # The prior counts users: two of k, one of l, one more in each.
    assert library.prior == pytest.approx([3 / 5, 2 / 5])


def test_equal_weights_fit_the_library_of_none(written, memory):
    path = written("\n".join([HEAD.strip(), *(line[:-1] + "0.7" for line in LINES)]) + "\n")
    fit([path], memory, FitSettings(model="gaussian"))
    plain = open_study(memory).library.to_bytes()
    fit([path], memory, FitSettings(model="gaussian"), LogFormat({"weight": "w"}))
    assert open_study(memory).library.to_bytes() == plain


def frame_of(lines):
    columns = zip(*(line.split(",") for line in lines), strict=True)
    frame = dict(zip(("user", "type", "policy", "outcome", "w"), map(list, columns), strict=True))
    return frame | {"outcome": [float(value) for value in frame["outcome"]], "note": list(range(len(lines)))}


def tables():
    """The maker of each kind of table; those whose package is missing are skipped by `make`."""
    return {
        "dict": dict,
        "pandas": lambda columns: pytest.importorskip("pandas").DataFrame(columns),
        "polars": lambda columns: pytest.importorskip("polars").DataFrame(columns),
        "pyarrow": lambda columns: pytest.importorskip("pyarrow").table(columns),
    }


@pytest.mark.parametrize("kind", sorted(tables()))
def test_a_table_is_fitted_as_its_file(kind, written, memory, tmp_path):
    # Outcomes that need all their digits.
    lines = [f"u{i % 7},k{i % 2},{'xy'[i % 3 % 2]},{float(v)!r},1" for i, v in
             enumerate(np.random.default_rng(0).normal(size=40))]  # fmt: skip
    lines = [f"u{i % 8},k{i % 2},{line.split(',', 2)[2]}" for i, line in enumerate(lines)]
    from_file = fit([written(HEAD + "\n".join(lines) + "\n")], memory, FitSettings("file", "gaussian"))
    table = tables()[kind](frame_of(lines))
    from_table = fit(table, memory, FitSettings("table", "gaussian"))
    assert from_table | {"study": "file"} == from_file
    first, second = open_study(memory, "file"), open_study(memory, "table")
    assert first.library.to_bytes() == second.library.to_bytes()
    assert choose(memory, first, "u3")["belief"] == choose(memory, second, "u3")["belief"]
    # The same table again is known, a table that has grown adds its new rows.
    assert warm([table], memory, second)["rows"] == 0
    assert warm([tables()[kind](frame_of([*lines, "new,k0,x,1.5,1"]))], memory, second)["rows"] == 1


def test_missing_outcomes_of_a_table_are_pending_and_bools_are_numbers():
    frame = {"user": [1, 2, 3], "policy": ["p", "p", "q"], "outcome": [True, float("nan"), False]}
    log = read_log(frame)
    assert (log.user.words, log.policy.words, log.outcomes.tolist(), log.counts["pending"]) == (
        ["1", "3"],
        ["p", "q"],
        [1.0, 0.0],
        1,
    )


@pytest.mark.parametrize(
    ("frame", "words"),
    [
        ({"user": ["a"], "policy": ["p"]}, "must have the columns user, policy, outcome"),
        ({"user": ["a", "b"], "policy": ["p"], "outcome": [1]}, "columns of one length, got user 2, policy 1"),
        ({"user": ["a", "b"], "policy": ["p", "p"], "outcome": [1, "much"]}, "line 3: outcome must be a finite"),
        ({"user": [], "policy": [], "outcome": []}, "at least one line with an outcome"),
    ],
)
def test_bad_tables_are_refused(frame, words):
    with pytest.raises(InputError, match=words):
        read_log(frame)


def test_a_table_given_twice_is_refused():
    frame = {"user": ["a"], "policy": ["p"], "outcome": [1.0]}
    with pytest.raises(InputError, match="given twice"):
        read_log([frame, dict(frame)])
