"""What choosing was worth: numbers by hand, and the files."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from lifelore.agent.personalise.decision_log import COLUMNS
from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.agent.personalise.explanation import explain
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.study import Study, open_study
from lifelore.agent.personalise.study_report import report
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.figures.reuse_report import draw_reuse_report
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory

ONE_TYPE = FitSettings(model="gaussian", control=0.0, types=1)


@pytest.fixture
def memory(file_memory):
    return file_memory


@pytest.fixture
def study(memory):
    library = PolicyLibrary.from_means([[8.0, 2.0], [2.0, 6.0]], 1.0, policies=["x", "y"])
    return Study("s", library, {"x": "active", "y": "active"}, control=0.5, rule="greedy", change=0.0).keep(memory)


def lived(memory, study, users=12, times=3):
    """Outcomes by user and decision, all known but the last decision's."""
    generator = np.random.default_rng(0)
    said = {}
    for user in range(users):
        for time in range(times):
            made = choose(memory, study, f"u{user}")
            if time < times - 1:
                outcome = float(generator.normal(5, 2))
                update(memory, study, made["decision"], outcome)
                said.setdefault((f"u{user}", made["control"]), []).append((made["policy"], outcome))
    return said


@pytest.mark.slow
def test_numbers_by_hand(memory, study):
    said = lived(memory, study)
    document = report(memory, study)
    means = {
        control: [np.mean([outcome for _, outcome in rows]) for (_, held), rows in said.items() if held == control]
        for control in (False, True)
    }
    assert (document["decisions"], document["pending"]) == (36, 12)
    assert document["personal"]["value"] == pytest.approx(np.mean(means[False]))
    assert document["control"]["n"] == len(means[True]) > 2
    assert document["uplift"]["value"] == pytest.approx(np.mean(means[False]) - np.mean(means[True]))
    welch = stats.ttest_ind(means[False], means[True], equal_var=False).confidence_interval()
    assert document["uplift"]["ci95"] == pytest.approx([welch.low, welch.high])
    first = [rows[0][1] for (_, held), rows in said.items() if held]
    assert document["by_decision"][0]["control"]["value"] == pytest.approx(np.mean(first))
    assert [point["decision"] for point in document["by_decision"]] == [1, 2]
    of_x = [[o for p, o in rows if p == "x"] for (_, held), rows in said.items() if held]
    expected = np.mean([np.mean(outcomes) for outcomes in of_x if outcomes])
    assert document["policies"][0]["outcome"]["value"] == pytest.approx(expected)


@pytest.mark.slow
def test_the_interval_of_many_users_is_students(memory, study, monkeypatch):
    said = lived(memory, study, 20)
    resampled = report(memory, study)["personal"]
    monkeypatch.setattr("lifelore.agent.personalise.study_report.MANY", 4)
    document = report(memory, study)
    means = [np.mean([outcome for _, outcome in rows]) for (_, held), rows in said.items() if not held]
    half = stats.t.ppf(0.975, len(means) - 1) * stats.sem(means)
    assert document["personal"] == {
        "value": pytest.approx(np.mean(means)), "median": pytest.approx(np.median(means)),
        "ci95": pytest.approx([np.mean(means) - half, np.mean(means) + half]), "n": len(means),
    }  # fmt: skip
    assert set(document["personal"]) == set(resampled)


@pytest.mark.slow
def test_regret_is_what_the_last_belief_says(memory, study):
    """One user, surely of the first type in the end: x brings 8, y 2."""
    user = next(f"u{i}" for i in range(99) if study.holds_out(f"u{i}"))
    chosen = []
    for _ in range(30):
        made = choose(memory, study, user)
        chosen.append(made["policy"])
        update(memory, study, made["decision"], 8.0 if made["policy"] == "x" else 2.0)
    document = report(memory, study)
    assert document["regret"]["control"]["value"] == pytest.approx(6 * chosen.count("y") / 30)
    assert document["personal"] is document["uplift"] is document["regret"]["personal"] is None


@pytest.mark.slow
def test_the_folder_and_the_log(memory, study, tmp_path):
    lived(memory, study)
    document = report(memory, study, tmp_path / "a" / "b", tmp_path / "log.csv")
    assert json.loads((tmp_path / "a/b/report.json").read_text()) == document
    assert (tmp_path / "a/b/report.png").read_bytes().startswith(b"\x89PNG")
    head, *lines = (tmp_path / "log.csv").read_text().splitlines()
    assert head == ",".join(COLUMNS)
    assert len(lines) == 36
    fields = dict(zip(COLUMNS, lines[2].split(","), strict=True))
    assert (fields["user"], fields["outcome"], fields["outcome_time"]) == ("u0", "", "")
    assert fields["probability"] == ("0.5" if fields["group"] == "control" else "1.0")


@pytest.mark.slow
def test_names_are_drawn_as_they_are(memory, tmp_path):
    """Neither a formula, which may be a wrong one, nor a warning about letters that the font has not."""
    names = ["$\\nothing$", "用户"]
    library = PolicyLibrary.from_means([[8.0, 2.0]], 1.0, policies=names)
    odd = Study("a $\\study$", library, dict.fromkeys(names, "active"), control=0.5).keep(memory)
    lived(memory, odd)
    document = report(memory, odd, tmp_path)
    assert (tmp_path / "report.png").exists()
    curve, bars = draw_reuse_report(document).axes[:2]
    assert set(names) < {label.get_text() for label in bars.get_yticklabels()}
    assert all(tick == round(tick) for tick in curve.get_xticks()), "a decision is a whole number"


@pytest.mark.slow
def test_nobody_yet_and_nothing_that_varies(memory, study, tmp_path):
    empty = report(memory, study, tmp_path / "empty")
    assert empty["uplift"] is None
    assert empty["by_decision"] == []
    for user in range(12):
        update(memory, study, choose(memory, study, f"u{user}")["decision"], 1.0)
    same = report(memory, study, tmp_path / "same")
    assert same["uplift"]["value"] == 0
    assert same["uplift"]["ci95"] is None
    assert (same["personal"]["value"], same["personal"]["ci95"]) == (1.0, None)
    for folder in ("empty", "same"):
        assert (tmp_path / folder / "report.png").exists()


def test_a_place_that_cannot_be_written(memory, study, tmp_path):
    (tmp_path / "file").write_text("")
    for places in ({"out": tmp_path / "file"}, {"log": tmp_path / "none" / "log.csv"}):
        with pytest.raises(StoreError, match=r"cannot be written to .*; choose another place"):
            report(memory, study, **places)


def test_a_user_who_changed_groups_counts_in_each_by_its_own_decisions(memory, study):
    for control, outcome in ((0.0, 4.0), (0.9999, 6.0)):
        now = replace(study, control=control).keep(memory)
        update(memory, now, choose(memory, now, "ann")["decision"], outcome)
    document = report(memory, study)
    assert (document["personal"]["value"], document["control"]["value"]) == (4.0, 6.0)


def test_the_best_single_policy_and_the_incumbent_are_measured_on_the_control_group(memory, study):
    said = lived(memory, study, 30)
    document = report(memory, study, incumbent="y")
    personal = [np.mean([o for _, o in rows]) for (_, held), rows in said.items() if not held]
    for key, policy in (("best_single", "x"), ("incumbent", "y")):
        own = [[o for p, o in rows if p == policy] for (_, held), rows in said.items() if held]
        means = [np.mean(outcomes) for outcomes in own if outcomes]
        found = document[key]
        assert found["name"] == policy
        assert found["outcome"]["value"] == pytest.approx(np.mean(means))
        assert found["outcome"]["n"] == len(means)
        assert found["uplift"]["value"] == pytest.approx(np.mean(personal) - np.mean(means))
        welch = stats.ttest_ind(personal, means, equal_var=False).confidence_interval()
        assert found["uplift"]["ci95"] == pytest.approx([welch.low, welch.high])
    assert report(memory, study)["incumbent"] is None
    with pytest.raises(NotFoundError, match="incumbent must be a policy of the study, got 'none'"):
        report(memory, study, incumbent="none")


def test_the_best_single_policy_is_that_of_the_fit_and_not_of_the_control_group(memory, study):
    """Of the control group, `y` is best; the users of the fit say `x` (5 against 4)."""
    for user in range(12):
        made = choose(memory, study, f"u{user}")
        update(memory, study, made["decision"], 9.0 if made["policy"] == "y" else 0.0)
    assert report(memory, study)["best_single"]["name"] == "x"
    retired = replace(study, states={"x": "retired", "y": "active"})
    assert report(memory, retired)["best_single"]["name"] == "y"


def test_a_control_group_with_an_incumbent_does_not_measure_the_best_single_policy(memory, study):
    held = replace(study, incumbent="y").keep(memory)
    lived(memory, held)
    document = report(memory, held)
    assert (document["best_single"]["outcome"], document["best_single"]["uplift"]) == (None, None)
    assert document["incumbent"]["uplift"]["value"] == pytest.approx(document["uplift"]["value"])


def test_a_user_whose_decisions_a_later_fit_read_is_known_to_it(memory, tmp_path):
    lines = [f"u{user},{policy},{user + (policy == 'x')}" for user in range(6) for policy in "xy"]
    (tmp_path / "log.csv").write_text("\n".join(["user,policy,outcome", *lines]) + "\n")
    fit([tmp_path / "log.csv"], memory, ONE_TYPE)
    study = open_study(memory)
    for user, outcome in (("ann", 2.0), ("bo", 4.0)):
        update(memory, study, choose(memory, study, user)["decision"], outcome)
    report(memory, study, log=tmp_path / "decisions.csv")
    before = choose(memory, study, "ann")["belief"]
    fit([tmp_path / "log.csv", tmp_path / "decisions.csv"], memory, ONE_TYPE)
    study = open_study(memory)
    update(memory, study, choose(memory, study, "cy")["decision"], 6.0)
    # Only cy is new to the later fit; the decisions of the others still count once in their beliefs.
    assert report(memory, study, split="user")["decisions"] == 1
    assert report(memory, study, split="user")["personal"]["value"] == 6.0
    made = choose(memory, study, "ann")
    assert list(made["belief"].values()) == pytest.approx(list(before.values()))
    assert forget(memory, study, "bo") > 0
    with pytest.raises(NotFoundError):
        explain(memory, study, "bo")


def test_splits_leave_out_what_the_fit_has_seen(memory, tmp_path, monkeypatch):
    clock = [1000.0]
    monkeypatch.setattr("time.time", lambda: clock[0])
    monkeypatch.setattr("time.time_ns", lambda: int(1e9 * clock[0]))
    lines = [f"u{user},{policy},{user + (policy == 'x')}" for user in range(6) for policy in "xy"]
    (tmp_path / "log.csv").write_text("\n".join(["user,policy,outcome", *lines]) + "\n")

    def one_more(user, outcome):
        clock[0] += 10
        now = open_study(memory)
        update(memory, now, choose(memory, now, user)["decision"], outcome)

    fit([tmp_path / "log.csv"], memory, ONE_TYPE)
    one_more("u1", 1.0)
    one_more("ann", 2.0)
    clock[0] += 10
    fit([tmp_path / "log.csv"], memory, ONE_TYPE)
    one_more("u1", 3.0)
    one_more("ann", 6.0)
    study = open_study(memory)
    found = {split: report(memory, study, split=split) for split in (None, "user", "time", "both")}
    assert {split: document["personal"]["value"] for split, document in found.items()} == {
        None: 3.0, "user": 4.0, "time": 4.5, "both": 6.0,
    }  # fmt: skip
    assert {split: document["decisions"] for split, document in found.items()} == {
        None: 4, "user": 2, "time": 2, "both": 1,
    }  # fmt: skip
    with pytest.raises(InputError, match="split must be one of user, time, both, got 'none'"):
        report(memory, study, split="none")
    with pytest.raises(InputError, match="knows when it was fitted; fit it anew"):
        report(memory, replace(study, fitted={}), split="time")


def test_a_large_study_is_reported_by_a_sample(memory, study, monkeypatch):
    """Sums are of all users; curve, regret and calibration of the users drawn."""
    monkeypatch.setattr("lifelore.agent.personalise.calibration.SAMPLE", 10)
    said = lived(memory, study, 40)
    document = report(memory, study)
    assert document["personal"]["n"] + document["control"]["n"] == len(said) == 40
    assert document["sample"] == 10
    assert document["calibration"]["outcomes"]["groups"] == 10
    assert document == report(memory, study)


@pytest.mark.parametrize(("by", "starts"), [("day", [0, 1, 9]), ("week", [-1, 6])])
def test_periods_are_each_compared_by_users_means(where, clock, by, starts):
    """Tuesday, Wednesday and Thursday of the next week, by SciPy's test of users' means in a period."""
    begin = 1_699_920_000  # Tuesday, 2023-11-14
    library = PolicyLibrary.from_means([[8.0, 2.0]], 1.0, policies=["x", "y"])
    lived: dict[int, dict[tuple[bool, str], list[float]]] = {start: {} for start in starts}
    with open_memory(where) as memory:
        study = Study("s", library, {"x": "active", "y": "active"}, control=0.5, change=0.0).keep(memory)
        generator = np.random.default_rng(1)
        for day in (0, 1, 9):
            clock[0] = (begin + 86_400 * day + 50_000) * 10**9
            own = lived[max(start for start in starts if start <= day)]
            for user in [*range(14), *range(5)]:
                outcome = 1e6 + float(generator.normal())
                made = choose(memory, study, f"u{user}")
                update(memory, study, made["decision"], outcome)
                own.setdefault((made["control"], f"u{user}"), []).append(outcome)
            choose(memory, study, "no outcome")
        document = report(memory, study, by=by)
        assert report(memory, study)["by_time"] is None
        with pytest.raises(InputError, match="by must be one of day, week, got 'month'"):
            report(memory, study, by="month")
    assert [one["time"] for one in document["by_time"]] == [begin + 86_400 * start for start in starts]
    assert sum(one["decisions"] for one in document["by_time"]) == 3 * 20
    for one, own in zip(document["by_time"], lived.values(), strict=True):
        personal, control = ([np.mean(values) for (held, _), values in own.items() if held == c] for c in (0, 1))
        welch = stats.ttest_ind(personal, control, equal_var=False).confidence_interval()
        assert one["users"] == 15
        assert one["uplift"]["n"] == [len(personal), len(control)]
        assert one["uplift"]["value"] == pytest.approx(np.mean(personal) - np.mean(control), abs=1e-8)
        assert one["uplift"]["ci95"] == pytest.approx([welch.low, welch.high], abs=1e-6)
        assert (one["control"]["value"], one["control"]["n"]) == (pytest.approx(np.mean(control)), len(control))


def test_periods_in_which_no_counted_user_came_are_left_out(where, clock):
    library = PolicyLibrary.from_means([[8.0, 2.0]], 1.0, policies=["x", "y"])
    with open_memory(where) as memory:
        study = Study("s", library, {"x": "active", "y": "active"}, control=0.5, change=0.0).keep(memory)
        update(memory, study, choose(memory, study, "of the fit")["decision"], 8.0)
        with memory.studies.writing(study.number) as rows:
            rows.mark_fitted([rows.users(["of the fit"])["of the fit"].number])
        clock[0] += 3 * 86_400 * 10**9
        update(memory, study, choose(memory, study, "stranger")["decision"], 8.0)
        assert [one["users"] for one in report(memory, study, by="day")["by_time"]] == [1, 1]
        (period,) = report(memory, study, by="day", split="user")["by_time"]
    assert period["time"] == clock[0] // 10**9 // 86_400 * 86_400


def test_users_of_no_known_type_are_counted(memory):
    library = PolicyLibrary.from_means([[8.0, 2.0], [2.0, 8.0]], 1.0, policies=["x", "y"], count=40)
    study = Study("s", library, dict.fromkeys(library.policies, "active"), control=0.0).keep(memory)
    assert report(memory, study)["strangers"] is None
    for user, outcome in (("known", 8.0), ("stranger", 5.0), ("silent", None)):
        for _ in range(6):
            made = choose(memory, study, user)
            if outcome is not None:
                value = outcome if user == "stranger" or made["policy"] == "x" else 2.0
                update(memory, study, made["decision"], value)
    assert report(memory, study)["strangers"] == {"users": 1, "n": 2}
    exact = PolicyLibrary.from_means([[8.0, 2.0]], 1.0, policies=["x", "y"])
    alone = Study("alone", exact, study.states, control=0.0).keep(memory)
    update(memory, alone, choose(memory, alone, "known")["decision"], 8.0)
    assert report(memory, alone)["strangers"] is None
