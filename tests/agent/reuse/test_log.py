"""Logs as they come: what is read, and the line that says what is wrong."""

import numpy as np
import pytest

from lifelore.agent.reuse.log import read_log, read_outcome
from lifelore.core.errors import InputError, NotFoundError

HEAD = "user,policy,outcome\n"


@pytest.fixture
def written(tmp_path):
    def write(text, name="log.csv", encoding="utf-8"):
        path = tmp_path / name
        path.write_bytes(text.encode(encoding))
        return path

    return write


def test_columns_in_any_order_and_others_passed_over(written):
    log = read_log([written('outcome,shop, policy ,user,note\n1.5,x, dark ,"Ann, of 7",hi\n\n-2e1,y,big,Bo,\n')])
    assert (log.users, log.policies, log.outcomes.tolist()) == (["Ann, of 7", "Bo"], ["dark", "big"], [1.5, -20])
    assert (log.types, log.contexts, log.pending, log.says_types) == (["", ""], ["", ""], 0, False)


def test_types_contexts_and_outcomes_not_yet_known(written):
    log = read_log([written("user,policy,outcome,type,context\na,p,1,kind,web\na,p,,,\nb,q,0,,app\n")])
    assert log.pending == 1
    assert log.of_users(log.types) == {"a": "kind"}
    assert log.of_users(log.contexts) == {"a": "web", "b": "app"}


def test_several_logs_are_one(written):
    first, second = written(HEAD + "a,p,1\n"), written("policy,user,outcome\nq,b,2\n", "more.csv")
    log = read_log([first, second])
    assert (log.users, log.policies) == (["a", "b"], ["p", "q"])
    assert np.array_equal(log.outcomes, [1.0, 2.0])


def test_a_byte_order_mark_is_no_letter(written):
    assert len(read_log([written(HEAD + "a,p,1\n", encoding="utf-8-sig")])) == 1


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
    assert (log.users, log.policies, log.outcomes.tolist(), log.types) == (["a"], ["p"], [1.0], ["k"])


def test_a_separator_of_another_log_is_a_letter(written):
    log = read_log([written("user,policy,outcome\na;b,p,1\n"), written("user;policy;outcome\na,b;q;2\n", "b.csv")])
    assert log.users == ["a;b", "a,b"]


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
        (HEAD + "a,p,yes\n", "line 2: outcome must be a finite number, got 'yes'"),
        (HEAD + "a,p\n", "line 2: must have 3 fields like the header, got 2"),
        (HEAD + "a,p,1,\n", "line 2: must have 3 fields like the header, got 4"),
        (HEAD + ",p,1\n", "line 2: user must be 1 to 200 printable characters, got ''"),
        (HEAD + "a, ,1\n", "line 2: policy must be 1 to 200 printable characters"),
        (HEAD + f"{'a' * 201},p,1\n", "line 2: user must be 1 to 200 printable"),
        (HEAD + '"a\nb",p,1\n', "line 3: user must be 1 to 200 printable"),
        (HEAD + '"a,p,1\n', "not CSV"),
    ],
)
def test_bad_logs(text, said, written):
    with pytest.raises(InputError, match=said.replace("(", r"\(")):
        read_log([written(text)])


def test_no_file_and_no_text(tmp_path, written):
    with pytest.raises(NotFoundError, match="does not exist; give a CSV file"):
        read_log([tmp_path / "none.csv"])
    with pytest.raises(NotFoundError, match="is no file; give a CSV file"):
        read_log([tmp_path])
    with pytest.raises(InputError, match="must be CSV in UTF-8"):
        read_log([written(HEAD + "Zoë,p,1\n", encoding="latin-1")])


def test_an_outcome_is_a_finite_number():
    assert read_outcome("-1e-3") == -0.001
    with pytest.raises(InputError, match="outcome must be a finite number, got '1,5'"):
        read_outcome("1,5")
