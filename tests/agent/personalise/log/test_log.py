"""Logs as they come: what is read, and the line that says what is wrong."""

import numpy as np
import pytest

from lifelore.agent.personalise.log import log_reader
from lifelore.agent.personalise.log.log import read_log
from lifelore.agent.personalise.log.log_format import LogFormat, parse_columns, read_outcome
from lifelore.core.errors import InputError, NotFoundError

HEAD = "user,policy,outcome\n"


@pytest.fixture
def written(tmp_path):
    def write(text, name="log.csv", encoding="utf-8"):
        path = tmp_path / name
        path.write_bytes(text.encode(encoding))
        return path

    return write


def named(log, column, of_user):
    return {log.user.names[user]: column.names[place] for user, place in enumerate(of_user) if place >= 0}


def test_columns_in_any_order_and_others_passed_over(written):
    log = read_log([written('outcome,shop, policy ,user,note\n1.5,x, dark ,"Ann, of 7",hi\n\n-2e1,y,big,Bo,\n')])
    assert (log.user.words, log.policy.words, log.outcomes.tolist()) == (
        ["Ann, of 7", "Bo"],
        ["dark", "big"],
        [1.5, -20],
    )
    assert (log.type.words, log.context.words, log.counts["pending"], log.says_types) == (
        ["", ""],
        ["", ""],
        0,
        False,
    )


def test_types_contexts_and_outcomes_not_yet_known(written):
    log = read_log([written("user,policy,outcome,type,context\na,p,1,kind,web\na,p,,,\nb,q,0,,app\n")])
    assert log.counts["pending"] == 1
    assert named(log, log.type, log.type_of_user) == {"a": "kind"}
    assert named(log, log.context, log.context_of_user) == {"a": "web", "b": "app"}


def test_several_logs_are_one(written):
    first, second = written(HEAD + "a,p,1\n"), written("policy,user,outcome\nq,b,2\n", "more.csv")
    log = read_log([first, second])
    assert (log.user.words, log.policy.words) == (["a", "b"], ["p", "q"])
    assert np.array_equal(log.outcomes, [1.0, 2.0])


def test_a_byte_order_mark_is_no_letter(written):
    assert len(read_log([written(HEAD + "a,p,1\n", encoding="utf-8-sig")])) == 1


def test_the_line_of_excel_about_the_separator_is_none_of_the_log(written):
    text = ("sep=;\n" + HEAD + "a,p,1\n").replace(",", ";")
    assert read_log([written(text)]).outcomes.tolist() == [1.0]
    with pytest.raises(InputError, match="line 4: outcome must be a finite number"):
        read_log([written(text + "a;p;?\n")])


@pytest.mark.parametrize(
    "text",
    [
        ' User ,"POLICY",Outcome,Type\na,p,1,k\n',
        "user;policy;outcome;type\r\na;p;1;k\r\n",
        '"user"\t"policy"\t"outcome"\t"type"\na\tp\t1\tk\n',
    ],
)
def test_capitals_and_separators_as_other_programs_write_them(text, written):
    log = read_log([written(text)])
    assert (log.user.words, log.policy.words, log.outcomes.tolist(), log.type.words) == (
        ["a"],
        ["p"],
        [1.0],
        ["k"],
    )


def test_a_separator_of_another_log_is_a_letter(written):
    log = read_log([written("user,policy,outcome\na;b,p,1\n"), written("user;policy;outcome\na,b;q;2\n", "b.csv")])
    assert log.user.words == ["a;b", "a,b"]


def test_a_log_given_twice_is_refused(written, tmp_path):
    path = written(HEAD + "a,p,1\n")
    with pytest.raises(InputError, match="is given twice; its lines would count twice"):
        read_log([path, tmp_path / "." / "log.csv"])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "must begin with a header that names user, policy, outcome, it is empty"),
        ("\n\n", "must begin with a header"),
        (HEAD, "must hold at least one line with an outcome, got none"),
        (HEAD + "a,p,\n", "must hold at least one line with an outcome"),
        ("user,outcome\na,1\n", "it has no policy, its header is 'user,outcome'"),
        ("user:policy:outcome\na:p:1\n", "separated by commas; it has no user and no policy and no outcome"),
        ("user;policy;outcome\na;p;1,5\n", "got '1,5'; write decimals with a point"),
        ("user;policy;outcome\na,p,1\n", "line 2: must have 3 fields like the header, got 1"),
        ("User,policy,outcome,USER\na,p,1,b\n", "must have one column 'user', its header names 2"),
        ("user,user,policy,outcome\na,b,p,1\n", "must have one column 'user', its header names 2"),
        (HEAD + "a,p,1\nb,q,nan\n", "line 3: outcome must be a finite number, got 'nan'"),
        (HEAD + "a,p,inf\n", "line 2: outcome must be a finite number, got 'inf'"),
        (
            HEAD + "a,p,maybe\n",
            "line 2: outcome must be a finite number, got 'maybe'; yes and no count as 1 and 0",
        ),
        (HEAD + "a,p\n", "line 2: must have 3 fields like the header, got 2"),
        (HEAD + "a,p,1,\n", "line 2: must have 3 fields like the header, got 4"),
        (HEAD + ",p,1\n", "got ''; leave the line out, or give it a user"),
        (HEAD + "a, ,1\n", "line 2: policy must be 1 to 200 printable characters"),
        (HEAD + f"{'a' * 201},p,1\n", "line 2: user must be 1 to 200 printable"),
        (HEAD + '"a\nb",p,1\n', "line 3: user must be 1 to 200 printable"),
        (HEAD + '"a,p,1\n', "not CSV"),
    ],
)
def test_bad_logs(text, said, written):
    with pytest.raises(InputError, match=said.replace("(", r"\(")):
        read_log([written(text)])


def test_columns_by_their_own_names(written):
    form = LogFormat(parse_columns(["user=Household, policy=brand", "outcome=took it"]))
    log = read_log([written("week;household;took it;brand;policy\n1;a;1;x;other\n2;b;0;y;other\n")], form)
    assert (log.user.words, log.policy.words, log.outcomes.tolist()) == (["a", "b"], ["x", "y"], [1.0, 0.0])
    with pytest.raises(
        InputError, match=r"must have the columns Household, brand, took it.* it has no brand".lower()
    ):
        read_log([written("household,policy,took it\na,x,1\n")], form)


@pytest.mark.parametrize("words", [["user"], ["user="], ["=a"], ["user=a,user=b"], ["user=a", "user=b"], [""]])
def test_names_of_columns_that_say_nothing(words):
    with pytest.raises(InputError, match="columns must be OURS=THEIRS, each once"):
        parse_columns(words)
    with pytest.raises(InputError, match="columns must name user, policy, outcome"):
        LogFormat({"shop": "x"})


def test_decimal_commas_latin_1_and_a_separator_by_option(written):
    text = "user;policy;outcome\nZoë;p;1,5\nBo;p;-0,25\nCy;p;7\n"
    form = LogFormat(decimal_comma=True, encoding="latin-1")
    log = read_log([written(text, encoding="latin-1")], form)
    assert (log.user.words, log.outcomes.tolist()) == (["Zoë", "Bo", "Cy"], [1.5, -0.25, 7.0])
    with pytest.raises(
        InputError, match=r"line 3: outcome must have a comma before its decimals, and no point .*, got '1\.500'"
    ):
        read_log([written("user;policy;outcome\na;p;1,5\na;p;1.500\n")], LogFormat(decimal_comma=True))
    tabs = LogFormat(separator="tab")
    assert read_log([written("user\tpolicy\toutcome\na,b\tp\t1\n")], tabs).user.words == ["a,b"]
    for settings in ({"separator": "dot"}, {"encoding": "klingon"}):
        with pytest.raises(NotFoundError, match=f"{next(iter(settings))} must be one"):
            LogFormat(**settings)


GAPS = HEAD + "a,p,1\nb,,0\nc,q,\nd,,\ne,NA,NA\nf,p,2\n"


@pytest.mark.parametrize(
    ("settings", "rows", "counts"),
    [
        ({"missing_policy": "leave-out"}, [("a", "p", 1), ("f", "p", 2)], (1, 0, 0, 3)),
        ({"missing_policy": "nothing"}, [("a", "p", 1), ("b", "nothing", 0), ("f", "p", 2)], (3, 0, 3, 0)),
        (
            {"missing_policy": "leave-out", "missing_outcome": "-1"},
            [("a", "p", 1), ("c", "q", -1), ("f", "p", 2)],
            (0, 3, 0, 3),
        ),
        (
            {"missing_policy": "nothing", "missing_outcome": "0"},
            [
                ("a", "p", 1),
                ("b", "nothing", 0),
                ("c", "q", 0),
                ("d", "nothing", 0),
                ("e", "nothing", 0),
                ("f", "p", 2),
            ],
            (0, 3, 3, 0),
        ),
    ],
)
def test_what_is_missing_is_counted(settings, rows, counts, written):
    log = read_log([written(GAPS)], LogFormat(missing=("NA",), **settings))
    assert list(zip(log.user.words, log.policy.words, log.outcomes.tolist(), strict=True)) == rows
    assert tuple(log.counts.values()) == counts


def test_what_is_missing_is_refused_with_its_line(written):
    with pytest.raises(
        InputError, match="line 3: policy must be 1 to 200 printable characters, got ''; --missing-policy"
    ):
        read_log([written(GAPS)], LogFormat(missing=("NA",)))
    with pytest.raises(InputError, match="line 4: outcome is missing; --missing-outcome says"):
        read_log([written(GAPS)], LogFormat(missing=("NA",), missing_policy="leave-out", missing_outcome="refuse"))
    with pytest.raises(InputError, match=r"got 'NA'; .* leave it empty .*, or say --missing WORD"):
        read_log([written(HEAD + "a,p,NA\n")])
    with pytest.raises(InputError, match="missing_outcome must be leave-out, refuse or a number, got 'none'"):
        read_log([written(GAPS)], LogFormat(missing_outcome="none"))


@pytest.mark.parametrize("outcome", ["1e308", "-1e308", "1.01e100"])
def test_an_outcome_whose_sums_would_overflow_is_refused_with_its_line(outcome, written):
    with pytest.raises(InputError, match=rf"line 3: outcome must be at most 1e\+100 in size, got '{outcome}'"):
        read_log([written(HEAD + f"a,p,1\nb,p,{outcome}\n")])


def test_a_user_with_two_types_is_refused_with_both_lines(written):
    head = "user,policy,outcome,type\n"
    first = written(head + "a,p,1,old\nb,p,1,\nb,p,1,young\na,p,1,\n")
    assert read_log([first]).says_types
    with pytest.raises(
        InputError,
        match=r"log.csv line 5: a user must have one type, got 'old' for 'b', who is 'young' in .*line 4",
    ):
        read_log([written(head + "a,p,1,old\nb,p,1,\nb,p,1,young\nb,p,1,old\n", "log.csv")])
    first = written(head + "a,p,1,old\n")
    with pytest.raises(
        InputError, match=r"more.csv line 2: a user must have one type, got 'new' for 'a', who is 'old'"
    ):
        read_log([first, written(head + "a,p,2,new\n", "more.csv")])


def test_as_many_policies_as_lines_look_like_the_wrong_column(written):
    lines = [f"u{i % 60},session {i},{i % 2}\n" for i in range(1702)]
    said = (
        "policy must name a configuration that recurs; 1,702 policies in 1,702 lines looks like the wrong column"
    )
    with pytest.raises(InputError, match=said):
        read_log([written(HEAD + "".join(lines))])
    few = [f"u{i},p{i},{i % 2}\n" for i in range(20)]
    assert len(read_log([written(HEAD + "".join(few))])) == 20


def test_chunks_make_no_difference(written, monkeypatch):
    path = written(HEAD + "".join(f"u{i % 7},p{i % 3},{i / 4 if i % 5 else ''}\n" for i in range(50)))
    whole = read_log([path])
    monkeypatch.setattr(log_reader, "CHUNK", 7)
    parts = read_log([path])
    assert (parts.user.words, parts.policy.words, parts.counts["pending"]) == (
        whole.user.words,
        whole.policy.words,
        whole.counts["pending"],
    )
    assert np.array_equal(parts.outcomes, whole.outcomes)
    assert np.array_equal(parts.line, whole.line)
    assert whole.line.tolist() == [i + 2 for i in range(50) if i % 5]


def test_equal_logs_are_refused(written):
    paths = [written(HEAD + "a,p,1\n"), written(HEAD + "a,p,1\n", "copy.csv")]
    with pytest.raises(InputError, match="are equal; its lines would count twice"):
        read_log(paths)


def test_no_file_and_no_text(tmp_path, written):
    with pytest.raises(NotFoundError, match="does not exist; give a CSV file"):
        read_log([tmp_path / "none.csv"])
    with pytest.raises(NotFoundError, match="is no file; give a CSV file"):
        read_log([tmp_path])
    with pytest.raises(InputError, match="must be CSV in UTF-8"):
        read_log([written(HEAD + "Zoë,p,1\n", encoding="latin-1")])
    with pytest.raises(InputError, match=r"say --encoding utf-16$"):
        read_log([written(HEAD + "a,p,1\n", encoding="utf-16")])


def test_an_outcome_is_a_finite_number_or_a_truth():
    assert [read_outcome(word) for word in ("yes", "No", "TRUE", "false")] == [1, 0, 1, 0]
    assert read_outcome("-1e-3") == -0.001
    with pytest.raises(InputError, match="outcome must be a finite number, got '1,5'"):
        read_outcome("1,5")


def test_a_wrong_number_with_a_decimal_comma_is_not_told_of_the_decimal_comma():
    with pytest.raises(
        InputError, match=r"comma before its decimals, and no point between thousands, got '1\.500,5'"
    ):
        read_outcome("1.500,5", decimal_comma=True)
    with pytest.raises(InputError, match=r"got '1,5 €'$"):
        read_outcome("1,5 €", decimal_comma=True)


def test_whole_floats_of_a_table_are_the_names_that_a_file_has():
    frame = {"user": [5.0, 6.5], "policy": [1.0, 2.0], "outcome": [1.0, 0.25]}
    log = read_log(frame)
    assert (log.user.words, log.policy.words, log.outcomes.tolist()) == (["5", "6.5"], ["1", "2"], [1.0, 0.25])


def test_of_many_bad_lines_the_first_is_named(written):
    text = HEAD + "".join(f"{'a' * (201 + number)},p,1\n" for number in range(40))
    with pytest.raises(InputError, match="line 2: user must be 1 to 200 printable"):
        read_log([written(text)])
