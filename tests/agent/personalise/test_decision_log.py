"""The log of decisions: what a spreadsheet, a program and a new fit read, a part at a time."""

import csv
import io
import json

import pytest

from lifelore.agent.personalise.decision_log import COLUMNS, log_parts
from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.registration import register
from lifelore.agent.personalise.study import open_study
from lifelore.agent.personalise.study_report import report
from lifelore.core.errors import InputError

from .studies import POLICIES, n_past, study_of

USERS = ("eva", "=1+2", "+x", "-y", "@z", 'quote "me", please', "grüße 🙂", "'plain")
FORMULAS = "=+-@"
SECOND = 10**9
START = 1_700_000_000


@pytest.fixture
def kept(memory):
    return study_of(control=0.3, policies=("big", "=dark", "plain")).keep(memory)


def lived(memory, study, clock, users=USERS, **known):
    """A decision a second; every other one ends at once. The documents of the choices."""
    made = []
    for number, user in enumerate(users):
        clock[0] = (START + number) * SECOND
        made.append(choose(memory, study, user, **known))
        if number % 2 == 0:
            update(memory, study, made[-1]["decision"], number + 0.5)
    return made


def text(memory, study, form, **bounds):
    return b"".join(log_parts(memory, study, form, **bounds)).decode()


def lines(memory, study, **bounds):
    return [json.loads(line) for line in text(memory, study, "ndjson", **bounds).splitlines()]


def names(memory, study, **bounds):
    return [line["decision"] for line in lines(memory, study, **bounds)]


def test_a_document_a_line(memory, kept, clock):
    made = lived(memory, kept, clock, context="DE", available=["big", "plain"], request="r1")
    found = lines(memory, kept)
    assert len(found) == len(USERS)
    for number, (one, line) in enumerate(zip(made, found, strict=True)):
        assert tuple(line) == COLUMNS
        for name in ("user", "policy", "probability", "decision"):
            assert line[name] == one[name]
        assert line["group"] == ("control" if one["control"] else "personal")
        assert (line["context"], line["available"], line["request"]) == ("DE", ["big", "plain"], "r1")
        assert (line["version"], line["rule"]) == (1, "sampling")
        assert line["time"] == pytest.approx(START + number, abs=0.5)
        ended = number % 2 == 0
        assert line["outcome"] == (number + 0.5 if ended else None)
        assert (line["outcome_time"] is not None) == ended


def test_csv_reads_back_and_no_cell_is_a_formula(memory, kept, clock):
    lived(memory, kept, clock, context="=cmd()", request="@r")
    rows = list(csv.DictReader(io.StringIO(text(memory, kept, "csv"), newline="")))
    assert [list(row) for row in rows] == [list(COLUMNS)] * len(USERS)
    for row, line in zip(rows, lines(memory, kept), strict=True):
        assert not any(cell.startswith(tuple(FORMULAS)) for cell in row.values())
        for name in ("user", "policy", "context", "request"):
            assert row[name] == ("'" if line[name][0] in FORMULAS else "") + line[name]
        for name in ("outcome", "time", "probability", "outcome_time"):
            assert (float(row[name]) if row[name] else None) == line[name]
        assert (row["group"], row["decision"], row["available"]) == (line["group"], line["decision"], "")


def test_a_fit_reads_the_names_of_a_log_as_they_were(memory, clock, tmp_path):
    study = register(memory, "s", study_of(policies=("=big", "@dark", "plain")).library)
    users = [f"{'=+-@'[number % 4]}user{number}" for number in range(12)]
    for number, user in enumerate(users * 6):
        clock[0] = (START + number) * SECOND
        made = choose(memory, study, user, context="-DE")
        update(memory, study, made["decision"], float(number % 7))
    (tmp_path / "log.csv").write_bytes(b"".join(log_parts(memory, study)))
    assert (tmp_path / "log.csv").read_bytes() == text(memory, study, "csv").encode()
    fit([tmp_path / "log.csv"], memory, FitSettings("again", "gaussian", control=0.0, types=2))
    again = open_study(memory, "again")
    used = {line["policy"] for line in lines(memory, study)}
    assert set(again.library.policies) == used <= set(study.library.policies)
    assert list(again.contexts) == ["-DE"]
    with memory.studies.reading(again.number) as rows:
        assert set(rows.users(users)) == set(users)
        assert n_past(rows) == len(users) * 6


@pytest.mark.parametrize("limit", [1, 3, 8, 9])
def test_parts_follow_each_other_without_a_gap(memory, kept, clock, limit):
    everything = [one["decision"] for one in lived(memory, kept, clock)]
    parts, cursor = [], None
    while found := names(memory, kept, cursor=cursor, limit=limit):
        parts.append(found)
        cursor = found[-1]
    assert [one for part in parts for one in part] == everything
    assert all(len(part) == limit for part in parts[:-1])


def test_parts_of_a_stream_follow_each_other_without_a_gap(memory, kept, clock, monkeypatch):
    everything = [one["decision"] for one in lived(memory, kept, clock)]
    for size in (1, 3, 8):
        for name, number in (("ROWS", size), ("AT_ONCE", 2)):
            monkeypatch.setattr(f"lifelore.agent.personalise.decision_log.{name}", number)
        assert names(memory, kept) == everything
        assert names(memory, kept, limit=5) == everything[:5]
        rows = list(csv.DictReader(io.StringIO(text(memory, kept, "csv"), newline="")))
        assert [row["decision"] for row in rows] == everything, "one head"


def test_bounds_of_time_part_the_log(memory, kept, clock):
    made = [one["decision"] for one in lived(memory, kept, clock)]
    assert names(memory, kept, since=START, until=START + 8) == made
    for second in range(9):
        before, after = names(memory, kept, until=START + second), names(memory, kept, since=START + second)
        assert (before, after) == (made[:second], made[second:])
    assert names(memory, kept, since=START + 2, until=START + 5) == made[2:5]
    assert names(memory, kept, since=START + 2, cursor=made[4], limit=2) == made[5:7]
    assert names(memory, kept, since=START + 5, cursor=made[1]) == made[5:]
    assert names(memory, kept, since=0.0, until=float(START)) == []
    assert names(memory, kept, limit=0) == []


def test_an_empty_log_has_its_head(memory, kept):
    assert text(memory, kept, "csv") == ",".join(COLUMNS) + "\r\n"
    assert text(memory, kept, "ndjson") == ""


def test_a_log_has_its_own_study_alone_and_no_forgotten_user(memory, kept, clock):
    other = study_of("other").keep(memory)
    lived(memory, kept, clock)
    clock[0] += 60 * SECOND
    assert choose(memory, other, "eva")["policy"] in POLICIES
    forget(memory, kept, "eva")
    assert [line["user"] for line in lines(memory, kept)] == list(USERS[1:])
    assert [line["user"] for line in lines(memory, other)] == ["eva"]


def test_another_format_or_cursor_is_refused_before_the_first_part(memory, kept):
    with pytest.raises(InputError, match="format must be csv or ndjson, got 'xml'"):
        log_parts(memory, kept, "xml")
    with pytest.raises(InputError, match="decision must be the identifier"):
        log_parts(memory, kept, cursor="u1/3")


def test_the_report_writes_the_log(file_memory, clock, tmp_path):
    study = study_of().keep(file_memory)
    lived(file_memory, study, clock)
    report(file_memory, study, log=tmp_path / "log.csv")
    assert (tmp_path / "log.csv").read_bytes() == text(file_memory, study, "csv").encode()
