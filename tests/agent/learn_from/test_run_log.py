"""Runs read from CSV: how they are parted, and which line is refused."""

import numpy as np
import pytest

from lifelore.agent.learn_from.run_log import Run, cut_runs, read_runs
from lifelore.core.errors import InputError, NotFoundError


def log(tmp_path, text: str):
    path = tmp_path / "runs.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_runs_by_name(tmp_path):
    runs = read_runs(log(tmp_path, "Run; TIME;x;y;heading;outcome;battery\n"
                                   "a;0;1;2;0.5;;9\na;1;1,5;2;;BUMP;9\n".replace("1,5", "1.5")
                                   + "b;0;0;0;;;9\n\nb;2;0;1;;goal;9\n"))  # fmt: skip
    assert [run.name for run in runs] == ["a", "b"]
    assert runs[0].points.tolist() == [[1, 2], [1.5, 2]]
    assert np.isnan(runs[0].heading).tolist() == [False, True]
    assert runs[0].outcome == ["", "bump"]
    assert [run.reached_goal for run in runs] == [False, True]


def test_without_names_a_run_ends_with_an_outcome_or_a_gap(tmp_path):
    runs = read_runs(
        log(tmp_path, "time,x,y,outcome\n0,0,0,\n1,0,0,goal\n2,0,0,\n3,0,0,failed\n4,0,0,\n15,0,0,\n")
    )
    assert [(run.name, len(run.time)) for run in runs] == [("0", 2), ("1", 2), ("2", 1), ("3", 1)]
    assert [run.reached_goal for run in runs] == [True, False, False, False]


def test_equal_runs_have_equal_digests_in_whatever_file(tmp_path):
    one = read_runs(log(tmp_path, "time,x,y\n0,0,0\n1,1,0\n50,7,7\n"))
    two = read_runs(log(tmp_path, "run,time,x,y,outcome\nq,0,0,0,\nq,1,1,0,\nr,1,1,0.5,\n"))
    assert one[0].digest == two[0].digest
    assert len({run.digest for run in one + two}) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1: column 'time' is missing"),
        ("time,x\n", "line 1: column 'y' is missing"),
        ("time,x,y\n", "at least one pose"),
        ("time,x,y\n0,1\n", "line 2: must have 3 values, got 2"),
        ("time,x,y\n\n0,1,two\n", "line 3: y must be a number"),
        ("time,x,y\n0,1,nan\n", "line 2: y must be a number"),
        ("time,x,y\n0,1e7,0\n", "line 2: x must be a number of metres, of magnitude 1e\\+06"),
        ("time,x,y\n1e5,0,0\n5e9,0,0\n", r"line 3: time must be seconds, .* in all lines, got 5e\+09"),
        ("time,x,y\n1704067200,0,0\n1704067201000,0,0\n", "line 3: time must be seconds"),
        (
            "time,x,y,heading\n" + "".join(f"{t},{t / 10},0,{90 * (t % 4)}\n" for t in range(9)),
            r"6 of 9 headings are beyond 2π, as degrees are; give radians within one turn",
        ),
        ("time,x,y\n1,0,0\n0,0,0\n", r"line 3: time must ascend within a run, got 0 after 1; .* \(column run\)"),
        ("time,x,y\n1700000010.5,0,0\n1700000009,0,0\n", "got 1700000009 after 1700000010.5"),
        ("time,x,y,outcome\n0,0,0,crash\n", "outcome must be empty or one of bump, goal, failed, got 'crash'"),
        ('time,x,y\n"0,0,0\n', "is no CSV"),
    ],
)
def test_a_line_that_breaks_its_rule_is_named(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        read_runs(log(tmp_path, text))


@pytest.mark.parametrize("unit", [1e3, 1e6, 1e9])
def test_parts_of_seconds_since_1970_are_known_by_their_size(tmp_path, unit):
    times = "".join(f"{round((1704067200 + t) * unit)},{t},0\n" for t in range(3))
    assert read_runs(log(tmp_path, "time,x,y\n" + times))[0].time.tolist() == [1704067200, 1704067201, 1704067202]


def test_a_robot_that_has_turned_round_a_few_times_is_read(tmp_path):
    rows = "".join(f"{t},{t / 10},0,{t / 20}\n" for t in range(140))
    assert read_runs(log(tmp_path, "time,x,y,heading\n" + rows))[0].heading[-1] == 6.95


def test_a_log_is_cut_where_runs_end():
    points = np.arange(10.0).reshape(5, 2)
    whole = Run("bag", np.arange(5.0), points, np.zeros(5), ["", "goal", "", "", "bump"])
    parts = cut_runs(whole, np.array([False, True, False, False, True]))
    assert [(part.name, part.time.tolist()) for part in parts] == [("bag 0", [0, 1]), ("bag 1", [2, 3, 4])]
    assert parts[1].points.tolist() == points[2:].tolist()
    assert [part.reached_goal for part in parts] == [True, False]
    assert [one.name for one in cut_runs(whole, np.zeros(5, bool))] == ["bag"]


def test_other_files_are_refused(tmp_path):
    with pytest.raises(NotFoundError, match="does not exist; give a CSV file"):
        read_runs(tmp_path / "none.csv")
    (tmp_path / "latin.csv").write_bytes("time,x,y,Straße\n".encode("latin-1"))
    with pytest.raises(InputError, match="must be UTF-8"):
        read_runs(tmp_path / "latin.csv")
