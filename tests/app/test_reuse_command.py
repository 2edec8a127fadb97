"""`lifelore reuse …`: what is printed, and one line for every mistake, with nothing lost."""

import re
import shutil

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.fitting.fit import fit
from lifelore.agent.personalise.study import open_study
from lifelore.interaction.selection import ExpectedImprovement
from lifelore.memory import open_memory

NOBODY = "01900000-0000-7000-8000-000000000000"
"""An identifier of no decision."""


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """Two kinds of users, each best served by another policy."""
    generator = np.random.default_rng(0)
    lines = ["user,policy,outcome"]
    for user in range(120):
        for _ in range(10):
            policy = generator.integers(2)
            chance = 0.9 if policy == user % 2 else 0.1
            lines.append(f"u{user},{('big', 'dark')[policy]},{int(generator.random() < chance)}")
    path = tmp_path_factory.mktemp("log") / "log.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture
def reuse(ask, tmp_path):
    """Ask with a memory of this test's own."""

    def asked(verb, *arguments):
        return ask("reuse", verb, *arguments, "--memory", tmp_path / "m.db")

    return asked


def test_from_a_log_to_a_report(reuse, log, tmp_path):
    said = reuse("fit", log, "--control", "0.4")
    assert said.status == 0
    assert said.out.startswith("study default: 1200 outcomes of 120 users, 2 policies, 2 types found, categorical")
    assert "best served by dark" in said.out
    for user in range(12):
        for _ in range(2):
            made = reuse("choose", "--user", f"n{user}", "--json").document
            outcome = int(made["policy"] == ("big", "dark")[user % 2])
            ended = reuse("update", "--decision", made["decision"], "--outcome", outcome, "--json").document
            assert ended["taken"]
            assert sum(ended["belief"].values()) == pytest.approx(1)
    document = reuse("report", "--out", tmp_path / "out", "--log", tmp_path / "d.csv", "--json").document
    assert (document["decisions"], document["pending"]) == (24, 0)
    assert document["uplift"]["value"] == pytest.approx(
        document["personal"]["value"] - document["control"]["value"]
    )
    assert (tmp_path / "out" / "report.png").exists()
    words = reuse("report", "--out", tmp_path / "out", "--log", tmp_path / "d.csv").out
    assert "uplift: " in words
    assert f"report.json, report.png and calibration.png written to {tmp_path / 'out'}\n" in words
    assert "calibration, quantiles of outcomes: mean distance 0." in words
    assert reuse("fit", log, tmp_path / "d.csv").out.startswith("study default: 1224 outcomes of 132 users")


def test_in_words(reuse, log):
    reuse("fit", log)
    policy, decision = reuse("choose", "--user", "ann").out.splitlines()
    assert policy in ("big", "dark")
    word, identifier, _ = decision.split(" ", 2)
    assert word == "decision"
    assert "(probability 1" in decision
    first = reuse("update", "--decision", identifier, "--outcome", "1")
    assert f"outcome 1 of {policy} stored; ann is most likely type" in first.out
    again = reuse("update", "--decision", identifier, "--outcome", "1")
    assert (again.status, "was stored already, nothing changed" in again.out) == (0, True)
    assert reuse("retire", "big").out == "big is retired\n"
    assert reuse("add", "big").out == "big is in use again\n"
    assert "given to the control group" in reuse("add", "round").out
    assert reuse("forget", "ann").out == "ann and 1 decision or line of the past forgotten\n"
    assert "no outcome yet" in reuse("report").out


def test_the_thesis_as_printed(reuse, log, tmp_path):
    found = reuse("fit", log, "--control", "0", "--variant", "thesis", "--json").document
    assert (found["rule"], found["models"], found["change"]) == ("expected-improvement", "plug-in", 0.0)
    with open_memory(tmp_path / "m.db") as memory:
        study = open_study(memory)
    assert study.selection == ExpectedImprovement("thesis")
    # Eq. 4.1 with the library's own probabilities.
    made = reuse("choose", "--user", "new", "--json").document
    belief = reuse("update", "--decision", made["decision"], "--outcome", "1", "--json").document["belief"]
    policy = study.library.index_of_policy(made["policy"])
    weight = study.library.prior * np.exp(study.library.performance.log_density(policy, 1.0))
    assert list(belief.values()) == pytest.approx(weight / weight.sum(), abs=1e-9)
    assert reuse("fit", log, "--variant", "thesis", "--rule", "knowledge-gradient").status == 0
    with open_memory(tmp_path / "m.db") as memory:
        assert open_study(memory).selection.variant == "thesis"


def test_the_probability_that_no_known_type_fits_is_there_when_asked_for(reuse, log):
    reuse("fit", log, "--control", "0")
    assert reuse("choose", "--user", "new", "--novelty").out.splitlines()[-1] == (
        "no known type fits: probability 0.15"
    )
    assert reuse("choose", "--user", "ann", "--novelty", "--json").document["novelty"] == pytest.approx(0.15, 0.99)
    assert "no known type fits" not in reuse("choose", "--user", "new").out
    assert reuse("choose", "--user", "new", "--json").document["novelty"] is None


def test_a_log_of_another_program_in_words(reuse, tmp_path):
    rows = [f"h{user};{brand};{int(brand == 'xy'[user % 2])},0" for user in range(8) for brand in "xyxy"]
    text = "Household;brand;took\n" + "\n".join([*rows, "h1;;1,0", "h2;x;NA", "h3;Süß;0,5"]) + "\n"
    (tmp_path / "log.csv").write_bytes(text.encode("latin-1"))
    form = ["--columns", "user=household,policy=brand,outcome=took", "--decimal-comma", "--encoding", "latin-1"]
    form += ["--missing", "NA"]
    assert "log.csv line 34: policy must be" in reuse("fit", tmp_path / "log.csv", *form).refusal
    said = reuse("fit", tmp_path / "log.csv", *form, "--missing-policy", "leave-out", "--types", "2").out
    assert said.startswith("study default: 33 outcomes of 8 users, 3 policies, 2 types found")
    assert "  1 line without an outcome yet left out\n" in said
    assert "  1 line without a policy left out\n" in said


def test_warm_in_words_and_a_first_choice_that_knows_the_past(reuse, log, tmp_path):
    reuse("fit", log, "--control", "0")
    (tmp_path / "later.csv").write_text("user,policy,outcome\n" + "ann,dark,1\nann,big,0\n" * 9)
    assert "no study 'none'" in reuse("warm", log, "--name", "none").refusal
    first = reuse("warm", tmp_path / "later.csv").out
    assert first.startswith("study default: 18 outcomes of 1 user added to the past\n  lines have no time: ")
    again = reuse("warm", tmp_path / "later.csv", "--json").document
    assert (again["rows"], again["known"]) == (0, 18)
    assert "  18 lines read before, not counted again\n" in reuse("warm", tmp_path / "later.csv").out
    made = reuse("choose", "--user", "ann", "--json").document
    assert made["policy"] == "dark"
    assert max(made["belief"].values()) > 0.99
    assert reuse("forget", "ann").out == "ann and 19 decisions and lines of the past forgotten\n"


def test_the_report_has_a_row_for_each_policy(reuse, log):
    reuse("fit", log, "--control", "0.5")
    for user in range(14):
        made = reuse("choose", "--user", f"n{user}", "--json").document
        reuse("update", "--decision", made["decision"], "--outcome", int(made["policy"] == "big"))
    said = reuse("report", "--incumbent", "dark").out
    for policy in ("big", "dark"):
        assert re.search(rf"^    {policy} +[01](\.\d+)?.*, \d+ users$", said, flags=re.M)
    assert "uplift over the best single policy, " in said
    assert "uplift over the incumbent, dark: " in said
    assert "0 decisions" not in reuse("report", "--split", "both").out
    assert "split must be one of user, time, both, got 'week'" in reuse("report", "--split", "week").refusal
    assert "incumbent must be a policy of the study" in reuse("report", "--incumbent", "none").refusal


def test_a_new_fit_says_what_it_sets_anew(reuse, log):
    assert reuse("fit", log, "--control", "0.4", "--json").document["changed"] == {}
    again = reuse("fit", log, "--incumbent", "big", "--json").document
    assert again["changed"] == {"control": 0.4, "incumbent": None}
    words = reuse("fit", log, "--rule", "greedy").out
    assert "  incumbent is None, was big until now (--incumbent big keeps it)\n" in words
    assert "  rule is greedy, was information-directed until now (--rule information-directed keeps it)\n" in words
    assert "control" not in words
    assert again["change"] == "learnt"
    assert (
        "  change is 0.0, was learnt until now (--change learnt keeps it)\n"
        in reuse("fit", log, "--change", "0").out
    )
    assert "--change must be a probability or 'learnt', got 'x'" in reuse("fit", log, "--change", "x").refusal


def test_a_context_that_no_log_has_is_said(reuse, tmp_path):
    rows = [f"u{user},{policy},{user},{('web', 'app')[user % 2]}" for user in range(6) for policy in "xy"]
    (tmp_path / "log.csv").write_text("\n".join(["user,policy,outcome,context", *rows]) + "\n")
    reuse("fit", tmp_path / "log.csv")
    assert "context wbe is not in the logs" in reuse("choose", "--user", "ann", "--context", "wbe").out
    assert "context" not in reuse("choose", "--user", "bo", "--context", "web").out
    assert reuse("choose", "--user", "ann", "--context", "app", "--json").document["context"] == "app"


def test_only_an_available_policy_is_chosen(reuse, log):
    reuse("fit", log, "--control", "0")
    made = reuse("choose", "--user", "ann", "--available", "big,big", "--available", "big", "--json").document
    assert (made["policy"], made["probability"], made["available"]) == ("big", 1.0, ["big"])
    made = reuse("choose", "--user", "ann", "--available", "big, dark", "--json").document
    assert made["available"] == ["big", "dark"]
    assert reuse("choose", "--user", "ann", "--json").document["available"] is None


def test_features_make_the_prior(reuse, log, tmp_path):
    rows = log.read_text().splitlines()
    path = tmp_path / "aged.csv"
    ages = [20 + 40 * (int(row[1 : row.index(",")]) % 2) for row in rows[1:]]
    path.write_text(
        "\n".join([rows[0] + ",Age", *(f"{row},{age}" for row, age in zip(rows[1:], ages, strict=True))])
    )
    assert (
        "the prior follows from age, by 120 users: 0."
        in reuse("fit", path, "--features", "age", "--control", "0").out
    )
    made = [
        reuse("choose", "--user", f"n{age}", "--features", f"age={age}", "--json").document for age in (20, 60)
    ]
    assert [one["policy"] for one in made] == ["big", "dark"]
    assert made[0]["features"] == {"age": 20.0}
    document = reuse("fit", path, "--features", "age", "--json").document
    assert document["features"]["strength"] > 0
    assert "unknown feature 'size'" in reuse("choose", "--user", "x", "--features", "age=1,size=2").refusal


@pytest.fixture(scope="module")
def lived(log):
    """A memory with a decision made, and one that ended with 1."""
    path = log.parent / "lived.db"
    with open_memory(path) as memory:
        fit([log], memory)
        study = open_study(memory)
        made, done = (choose(memory, study, user)["decision"] for user in ("ann", "bo"))
        update(memory, study, done, 1.0)
    return path, made, done


def test_a_bad_log_keeps_what_was_there(reuse, lived, tmp_path):
    shutil.copy(lived[0], tmp_path / "m.db")
    before = reuse("choose", "--user", "cy", "--json").document
    (tmp_path / "bad.csv").write_text("user,policy,outcome\na,x,nan\n")
    refusal = reuse("fit", tmp_path / "bad.csv").refusal
    assert "line 2: outcome must be a finite number, got 'nan'" in refusal
    assert reuse("choose", "--user", "di", "--json").document["belief"] == before["belief"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["fit", "nowhere.csv"], "log 'nowhere.csv' does not exist"),
        (["fit", "{log}", "--incumbent", "none"], "incumbent must be a policy in use, got 'none'"),
        (["fit", "{log}", "--variant", "none"], "variant must be 'standard' or 'thesis'"),
        (["fit", "{log}", "--variant", "thesis", "--rule", "information-directed"], "one that the thesis prints"),
        (["fit", "{log}", "--variant", "thesis", "--change", "0.1"], "change must be 0 with --variant thesis"),
        (["fit"], "Missing argument"),
        (["choose"], "Missing option '--user'"),
        (["choose", "--user", "ann", "--name", "none"], "no study 'none'"),
        (["update", "--decision", NOBODY, "--outcome", "1"], f"no decision {NOBODY}"),
        (["update", "--decision", "{made}", "--outcome", "nan"], "outcome must be a finite number, got 'nan'"),
        (["update", "--decision", "{done}", "--outcome", "0"], "ended with 1 already, got 0; nothing changed"),
        (["choose", "--user", "ann", "--available", "big,none"], "available must name policies of the study"),
        (["choose", "--user", "ann", "--features", "age"], "features must be NAME=NUMBER"),
        (["fit", "{log}", "--features", "age"], "it has no age"),
        (["report", "--out", "{log}"], "the file cannot be written to"),
        (["retire", "none"], "no policy 'none'; there are big, dark"),
        (["forget", "nobody"], "nothing is stored of user 'nobody'"),
        (["dance"], "No such command"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_mistakes_are_one_line_and_lose_nothing(arguments, said, reuse, log, lived, tmp_path):
    path, made, done = lived
    shutil.copy(path, tmp_path / "m.db")
    places = {"log": str(log), "made": made, "done": done}
    assert said in reuse(*(word.format(**places) for word in arguments)).refusal
    assert reuse("update", "--decision", made, "--outcome", "1", "--json").document["taken"]
    with open_memory(tmp_path / "m.db") as memory:
        assert memory.check() == []


def test_no_memory_is_made_into_a_study_by_asking(reuse):
    assert "m.db does not exist; check the path" in reuse("choose", "--user", "ann").refusal
