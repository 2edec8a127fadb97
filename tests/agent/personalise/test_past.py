"""The past of users: each line counts once, whatever the order or window of the log that has it."""

import random
from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.agent.personalise.explanation import explain
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.log.log_format import parse_time
from lifelore.agent.personalise.past import Line, add_lines, warm
from lifelore.agent.personalise.study import NAMED_TYPE, open_study
from lifelore.agent.personalise.study_report import report
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import open_memory

from .studies import n_past, one_more, study_of, twin

HEAD = "user,policy,outcome\n"
SETTINGS = FitSettings(model="categorical", control=0.0, types=3)


def households(first=0, n=30, each=12):
    """Of each household, the brand taken at all times but one is its own; lines of a log."""
    generator = np.random.default_rng(first)
    lines = []
    for user in range(first, first + n):
        for _ in range(each):
            brand = generator.integers(3)
            lines.append(f"h{user},b{brand},{int(generator.random() < (0.95 if brand == user % 3 else 0.05))}")
    return lines


def written(path, lines, head=HEAD):
    path.write_text(head + "\n".join(lines) + "\n")
    return [path]


def of_user(lines, user):
    fields = (line.split(",") for line in lines)
    return [(one[1], float(one[2])) for one in fields if one[0] == user]


@pytest.fixture
def log(tmp_path):
    return written(tmp_path / "log.csv", households())


@pytest.fixture
def study(memory, log):
    fit(log, memory, SETTINGS)
    return open_study(memory)


def lines_of_the_past(memory, study):
    with memory.studies.reading(study.number) as rows:
        return n_past(rows)


def same_as_twin(memory, study, user, shown, prior=None):
    agent = twin(study, shown, prior)
    belief = list(choose(memory, study, user)["belief"].values())
    assert belief == pytest.approx(agent.belief.tolist(), abs=1e-9)


def test_users_of_the_log_are_no_strangers(memory, study, log):
    lines = households()
    for user in range(9):
        assert choose(memory, study, f"h{user}")["policy"] == f"b{user % 3}"
        same_as_twin(memory, study, f"h{user}", of_user(lines, f"h{user}"))
    same_as_twin(memory, study, "stranger", [])
    shown = [(one_more(memory, study, "h5", outcome), outcome) for outcome in (1.0, 0.0, 1.0)]
    same_as_twin(memory, study, "h5", of_user(lines, "h5") + shown)


def test_lines_without_times_count_once_in_any_order_and_as_a_part_of_more(memory, study, tmp_path):
    lines = households(100, 6)
    more = [*lines, "h900,b0,1", "h900,b1,0"]
    shuffled = random.Random(0).sample(lines, len(lines))
    document = warm(written(tmp_path / "a.csv", lines), memory, study)
    assert (document["rows"], document["users"], document["known"]) == (72, 6, 0)
    assert not document["by_time"]
    same_as_twin(memory, study, "h104", of_user(lines, "h104"))
    for name, part, new in (("b", shuffled, 0), ("c", more, 2), ("d", households(), 0), ("e", more[30:], 0)):
        document = warm(written(tmp_path / f"{name}.csv", part), memory, study)
        assert (document["rows"], document["known"]) == (new, len(part) - new), name
    same_as_twin(memory, study, "h104", of_user(lines, "h104"))
    same_as_twin(memory, study, "h900", [("b0", 1.0), ("b1", 0.0)])


def test_lines_with_times_count_once_in_overlapping_windows(memory, study, tmp_path):
    head = "user,policy,outcome,time\n"
    lines = [f"t{i % 5},b{i % 3},{i % 2},2026-01-01T00:{i:02d}:00Z" for i in range(40)]
    for at in (0, 10, 5, 20):
        document = warm(written(tmp_path / "w.csv", lines[at : at + 20][::-1], head), memory, study)
        assert document["by_time"]
        assert document["rows"] == {0: 20, 10: 10, 5: 0, 20: 10}[at]
    # The order is that of the times, not of the lines.
    same_as_twin(memory, study, "t3", of_user(lines, "t3"))
    # An outcome that was corrected later is the same line.
    assert warm(written(tmp_path / "w.csv", ["t0,b0,1,2026-01-01T00:00:00Z"], head), memory, study)["rows"] == 0


def test_lines_of_overlapping_logs_count_once_in_one_call(memory, tmp_path):
    lines = [f"{line},{1_700_000_000 + number}" for number, line in enumerate(households())]
    lines += lines[:3]  # in one log, these are other visits in the same second
    head = "user,policy,outcome,time\n"
    whole = written(tmp_path / "whole.csv", lines, head)
    parts = [*written(tmp_path / "a.csv", lines[:250], head), *written(tmp_path / "b.csv", lines[100:], head)]
    expected, found = (fit(log, memory, replace(SETTINGS, name=log[0].stem)) for log in (whole, parts))
    assert (expected["rows"], expected["repeated"]) == (363, 0)
    # The three lines at the end of b.csv are the first of their kind there, as those of a.csv.
    assert (found["rows"], found["repeated"]) == (360, 153)
    assert warm(parts, memory, study_of_parts := open_study(memory, parts[0].stem))["known"] == 360
    assert lines_of_the_past(memory, study_of_parts) == 360
    untimed = [*written(tmp_path / "c.csv", households()[:9]), *written(tmp_path / "d.csv", households()[:8])]
    assert warm(untimed, memory, study_of_parts)["repeated"] == 0


def test_lines_with_identifiers_count_once_by_them(memory, study, tmp_path):
    head = "decision,user,policy,outcome\n"
    lines = ["x-1,ida,b0,1", "x-2,ida,b0,1", "x-3,idb,b1,0"]
    assert warm(written(tmp_path / "w.csv", lines, head), memory, study)["rows"] == 3
    more = ["x-3,idb,b1,0", "x-4,idb,b1,0", "x-1,ida,b0,1"]
    document = warm(written(tmp_path / "w.csv", more, head), memory, study)
    assert (document["rows"], document["known"], document["by_time"]) == (1, 2, True)
    same_as_twin(memory, study, "ida", [("b0", 1.0)] * 2)


def test_equal_lines_are_as_many_as_the_log_has(memory, study, tmp_path):
    for head, line in ((HEAD, "eq,b0,1"), ("user,policy,outcome,time\n", "eqt,b0,1,7"),
                       ("user,policy,outcome,time\n", "eqw,b0,1,monday")):  # fmt: skip
        user = line.split(",")[0]
        assert warm(written(tmp_path / "w.csv", [line] * 2, head), memory, study)["rows"] == 2
        assert warm(written(tmp_path / "w.csv", [line], head), memory, study)["rows"] == 0
        assert warm(written(tmp_path / "w.csv", [line] * 3, head), memory, study)["rows"] == 1
        same_as_twin(memory, study, user, [("b0", 1.0)] * 3)


def test_a_time_that_is_no_time_tells_lines_apart(memory, study, tmp_path):
    head = "user,policy,outcome,time\n"
    lines = ["w,b0,1,monday", "w,b0,1,tuesday", "w,b0,0,monday"]
    assert warm(written(tmp_path / "w.csv", lines, head), memory, study)["rows"] == 3
    document = warm(written(tmp_path / "w.csv", ["w,b0,1,wednesday", "w,b0,1,7", *lines], head), memory, study)
    assert (document["rows"], document["unread_times"]) == (2, 4)


@pytest.mark.parametrize(
    ("word", "milliseconds"),
    [
        ("", 0), ("1700000000", 1_700_000_000_000), ("1700000000.25", 1_700_000_000_250),
        ("1700000000250", 1_700_000_000_250), ("1970-01-02", 86_400_000),
        ("1970-01-01T00:00:01+01:00", -3_599_000), ("monday", None), ("inf", None),
    ],
)  # fmt: skip
def test_words_of_times(word, milliseconds):
    assert parse_time(word) == milliseconds


def test_a_new_fit_replaces_the_lines_of_fits_and_keeps_those_of_warm(memory, study, log, tmp_path):
    later = written(tmp_path / "later.csv", households(100, 3))
    warm(later, memory, study)
    assert lines_of_the_past(memory, study) == 33 * 12
    fit(written(tmp_path / "shorter.csv", households()[:-12]), memory, SETTINGS)
    study = open_study(memory)
    assert lines_of_the_past(memory, study) == 32 * 12
    same_as_twin(memory, study, "h29", [])
    same_as_twin(memory, study, "h101", of_user(households(100, 3), "h101"))
    fit([*log, *later], memory, SETTINGS)
    assert lines_of_the_past(memory, open_study(memory)) == 33 * 12
    assert warm(log, memory, open_study(memory))["rows"] == 0


def test_decisions_that_memory_has_are_no_past(memory, study, log, tmp_path, new_place):
    made = choose(memory, study, "ann")
    update(memory, study, made["decision"], 1.0)
    report(memory, study, log=tmp_path / "decisions.csv")
    exported = [tmp_path / "decisions.csv"]
    assert warm(exported, memory, study)["decisions"] == 1
    same_as_twin(memory, study, "ann", [(made["policy"], 1.0)])
    document = fit([*log, *exported], memory, SETTINGS)
    assert document["kept"]["in_log"] == 1
    again = open_study(memory)
    same_as_twin(memory, again, "ann", [(made["policy"], 1.0)])
    with open_memory(new_place("sqlite")) as other:
        fit(log, other, SETTINGS)
        new = open_study(other)
        assert warm(exported, other, new)["rows"] == 1
        assert warm(exported, other, new)["known"] == 1
        same_as_twin(other, new, "ann", [(made["policy"], 1.0)])


def test_a_named_type_and_a_context_of_the_log_count(memory, tmp_path):
    lines = [f"u{i},b{i % 2},{i % 3},{'k' if i < 6 else 'l'},{'web' if i < 5 else 'app'}" for i in range(12)]
    log = written(tmp_path / "log.csv", lines, "user,policy,outcome,type,context\n")
    fit(log, memory, FitSettings(control=0.0, model="gaussian"))
    study = open_study(memory)
    prior = NAMED_TYPE * np.array([1.0, 0.0]) + (1 - NAMED_TYPE) * study.prior_of("web")
    assert choose(memory, study, "u4")["context"] == "web"
    same_as_twin(memory, study, "u4", [("b0", 1.0)], prior)
    more = written(tmp_path / "more.csv", ["v,b0,1,other", "v,none,1,"], "user,policy,outcome,type\n")
    document = warm(more, memory, study)
    assert (document["unknown_types"], document["unknown_policies"]) == (["other"], 1)
    same_as_twin(memory, study, "v", [("b0", 1.0), ("none", 1.0)])


def test_the_control_group_is_chosen_for_without_its_past(file_memory, log):
    fit(log, file_memory, FitSettings(control=0.9999, types=3))
    study = open_study(file_memory)
    made = [choose(file_memory, study, f"h{user}") for user in range(30)]
    assert all(one["control"] and one["probability"] == pytest.approx(1 / 3) for one in made)
    # Chosen by its past, each household would get its own brand: 30 of 30. Five deviations of 30 draws of a third.
    assert sum(one["policy"] == f"b{user % 3}" for user, one in enumerate(made)) < 10 + 5 * (30 * 2 / 9) ** 0.5


def test_a_past_that_comes_after_decisions_comes_before_them(memory, study, tmp_path):
    policy = one_more(memory, study, "ann", 1.0)
    warm(written(tmp_path / "w.csv", ["ann,b0,1", "ann,b0,1"]), memory, study)
    same_as_twin(memory, study, "ann", [("b0", 1.0), ("b0", 1.0), (policy, 1.0)])


def test_forgetting_takes_the_past_too(memory, study):
    assert forget(memory, study, "h7") == 12
    with pytest.raises(NotFoundError, match="nothing is stored of user 'h7'"):
        explain(memory, study, "h7")
    same_as_twin(memory, study, "h7", [])
    one_more(memory, study, "h8", 1.0)
    assert forget(memory, study, "h8") == 13
    assert lines_of_the_past(memory, study) == 28 * 12


@pytest.mark.parametrize("line", [Line("", "b0", 1.0), Line("a", "b\n0", 1.0), Line("a", "b0", 1.0, context="\t")])
def test_bad_names_are_refused_and_nothing_is_stored(line, file_memory):
    study = study_of().keep(file_memory)
    with pytest.raises(InputError, match="printable"):
        add_lines(file_memory, study, [Line("good", "big", 1.0), line])
    assert lines_of_the_past(file_memory, study) == 0
