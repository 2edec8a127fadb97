"""`reuse evaluate`: off-policy estimates from logs, by hand and in simulation, and what a log cannot tell."""

import csv
import shutil
import time
from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.evaluate.evaluate import EvaluateSettings, evaluate
from lifelore.agent.personalise.evaluate.logged_decisions import read_decisions
from lifelore.agent.personalise.evaluate.target_policies import studies_of_others
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.study import open_study
from lifelore.agent.personalise.study_report import report
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.evaluation.reward_models import policy_means, user_folds
from lifelore.memory import open_memory

CHANCE = {"a": (0.9, 0.2, 0.5), "b": (0.1, 0.8, 0.5)}
POLICIES = ("x", "y", "z")


def write(path, rows, header=("user", "policy", "outcome", "probability")):
    with path.open("w", newline="") as file:
        csv.writer(file).writerows([header, *rows])
    return path


def simulated(path, n_users=80, n_decisions=6, probs=(0.5, 0.3, 0.2), seed=0):
    """Users of two types, alternately, each served at random."""
    generator = np.random.default_rng(seed)
    rows = []
    for user in range(n_users):
        for _ in range(n_decisions):
            policy = generator.choice(3, p=probs)
            outcome = int(generator.random() < CHANCE["ab"[user % 2]][policy])
            rows.append((f"u{user}", POLICIES[policy], outcome, probs[policy]))
    return write(path, rows)


@pytest.fixture
def log(tmp_path):
    return simulated(tmp_path / "log.csv")


def by_name(document):
    return {target["name"]: target for target in document["targets"]}


def test_each_single_policy_by_hand(log):
    document = evaluate([log])
    assert (document["decisions"], document["users"], document["group"]) == (480, 80, None)
    with log.open() as file:
        rows = list(csv.DictReader(file))
    found = by_name(document)
    assert set(found) == set(POLICIES)
    for name, target in found.items():
        own = [row for row in rows if row["policy"] == name]
        weighted = sum(float(row["outcome"]) / float(row["probability"]) for row in own)
        weight = sum(1 / float(row["probability"]) for row in own)
        estimates = target["estimates"]
        assert estimates["ips"]["value"] == pytest.approx(weighted / len(rows))
        assert estimates["self-normalised"]["value"] == pytest.approx(weighted / weight)
        assert target["weights"]["mean"] == pytest.approx(weight / len(rows))
        assert target["support"] == 1
        gain = estimates["doubly-robust"]["gain"]
        assert gain["value"] == pytest.approx(estimates["doubly-robust"]["value"] - document["logged"]["value"])
        truth = (CHANCE["a"][POLICIES.index(name)] + CHANCE["b"][POLICIES.index(name)]) / 2
        low, high = estimates["doubly-robust"]["ci95"]
        assert low < truth < high


def test_the_logs_own_probabilities_give_the_mean_of_the_log(log, tmp_path):
    table = write(tmp_path / "own.csv", [("x", 0.5), ("y", 0.3), ("z", 0.2)], ("policy", "probability"))
    document = evaluate([log], EvaluateSettings(tables=(table,)))
    (target,) = document["targets"]
    assert (target["name"], target["kind"], target["warnings"]) == ("own", "table", [])
    assert target["weights"]["largest"] == target["weights"]["mean"] == pytest.approx(1)
    for name in ("ips", "self-normalised"):
        assert target["estimates"][name]["value"] == pytest.approx(document["logged"]["value"])
        assert target["estimates"][name]["gain"]["value"] == pytest.approx(0, abs=1e-12)


@pytest.mark.slow
def test_a_rule_that_knows_types_beats_every_single_policy(log):
    document = evaluate([log], EvaluateSettings(policies=POLICIES, rules=("sampling",), types=2))
    found = by_name(document)
    rule = found.pop("sampling")
    assert (rule["kind"], rule["decision"]) == ("rule", "next")
    best = max(target["estimates"]["doubly-robust"]["value"] for target in found.values())
    assert rule["estimates"]["doubly-robust"]["value"] > best + 0.05
    whole = evaluate([log], EvaluateSettings(rules=("sampling",), types=2, first=3))
    assert whole["left_out"]["later_decisions"] == 480 - 240
    (target,) = whole["targets"]
    assert target["decision"] == "all"
    # Six of ten policies are drawn at random in each of three decisions: the weights leave fewer users.
    assert target["weights"]["effective_users"] < rule["weights"]["effective_users"]


@pytest.mark.slow
def test_the_library_of_a_part_of_the_users_does_not_depend_on_their_outcomes(tmp_path):
    log = read_decisions([simulated(tmp_path / "log.csv", n_users=10, n_decisions=4)])[0]
    folds = user_folds(log.user.codes, np.random.default_rng(0))
    other = replace(log, outcomes=np.where(folds == 1, 1 - log.outcomes, log.outcomes))
    before, after = (
        [study.library.to_bytes() for study in studies_of_others(one, folds, 2, 0)] for one in (log, other)
    )
    assert [a == b for a, b in zip(before, after, strict=True)] == [False, True, False, False, False]
    tables = [
        policy_means(part.outcomes, part.policy.codes, len(part.policy.names), folds).table
        for part in (other, log)
    ]
    assert np.array_equal(tables[0][1], tables[1][1])


@pytest.mark.slow
def test_the_library_model_is_more_precise_where_users_come_back(tmp_path):
    path = simulated(tmp_path / "long.csv", n_users=60, n_decisions=10, seed=3)
    settings = {
        model: EvaluateSettings(policies=("x", "y"), types=2, model=model) for model in ("means", "library")
    }
    errors = {
        model: [one["estimates"]["doubly-robust"]["standard_error"] for one in evaluate([path], own)["targets"]]
        for model, own in settings.items()
    }
    assert np.all(np.array(errors["library"]) < errors["means"])


def test_contexts_have_probabilities_of_their_own(tmp_path):
    rows = [
        ("a", "x", 1, 0.5, "web"),
        ("b", "y", 0, 0.5, "web"),
        ("c", "x", 0, 0.5, "app"),
        ("d", "y", 1, 0.5, "app"),
    ]
    path = write(tmp_path / "log.csv", rows, ("user", "policy", "outcome", "probability", "context"))
    header = ("policy", "probability", "context")
    table = write(tmp_path / "t.csv", [("x", 1, "web"), ("y", 0.75, "app"), ("x", 0.25, "app")], header)
    (target,) = evaluate([path], EvaluateSettings(tables=(table,)))["targets"]
    assert target["estimates"]["ips"]["value"] == pytest.approx((2 * 1 + 0 + 0.5 * 0 + 1.5 * 1) / 4)
    short = write(tmp_path / "s.csv", [("x", 1, "web")], header)
    with pytest.raises(InputError, match="probabilities of each context of the log, 'app' has none"):
        evaluate([path], EvaluateSettings(tables=(short,)))


# ---- what a log cannot tell -----------------------------------------------------------------------------


def test_where_nothing_else_was_possible_nothing_else_is_evaluated(tmp_path):
    rows = [(f"u{number}", "xy"[number % 2], number % 2, 1) for number in range(40)]
    document = evaluate([write(tmp_path / "log.csv", rows)])
    assert document["certain"] == 1
    for target in document["targets"]:
        assert set(target["estimates"].values()) == {None}
        assert target["support"] == 0.5
        assert target["warnings"] == [
            "in 50.0 % of the decisions the log had no alternative to another policy (probability 0): "
            "not evaluated"
        ]


def test_a_policy_that_was_never_chosen_is_not_evaluated(log, tmp_path):
    with pytest.raises(NotFoundError, match="policy 'q' was never chosen in the log, so nothing is known of it"):
        evaluate([log], EvaluateSettings(policies=("q",)))
    table = write(tmp_path / "t.csv", [("x", 0.9), ("q", 0.1)], ("policy", "probability"))
    (target,) = evaluate([log], EvaluateSettings(tables=(table,)))["targets"]
    assert target["estimates"]["doubly-robust"] is None
    assert target["support"] == pytest.approx(0.9)
    assert "the log never chose its policy (probability 0): not evaluated" in target["warnings"][0]


def test_few_effective_users_and_heavy_weights_are_named(tmp_path):
    generator = np.random.default_rng(0)
    rows = [(f"u{user}", "y" if generator.random() < 0.02 else "x", 1, 0) for user in range(300)]
    rows = [(user, policy, outcome, 0.02 if policy == "y" else 0.98) for user, policy, outcome, _ in rows]
    found = by_name(evaluate([write(tmp_path / "log.csv", rows)]))
    assert found["x"]["warnings"] == []
    assert "do not trust intervals below 20" in found["y"]["warnings"][0]


def test_wrong_probabilities_show_in_the_mean_weight(tmp_path):
    path = simulated(tmp_path / "log.csv", n_users=300)
    wrong = tmp_path / "wrong.csv"
    wrong.write_text(path.read_text().replace(",0.3", ",0.6"))
    found = by_name(evaluate([wrong]))
    assert any("and should be 1: the logged probabilities are wrong" in line for line in found["y"]["warnings"])
    assert found["x"]["warnings"] == []


def test_lines_without_an_outcome_are_left_out_and_counted(log, tmp_path):
    path = tmp_path / "open.csv"
    path.write_text(log.read_text() + "u1,x,,0.5\nu2,y,,0.3\n")
    document = evaluate([path])
    assert (document["decisions"], document["left_out"]["pending"]) == (480, 2)


# ---- the log of a study ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """A study and the log of its decisions for 60 new users, a part of them in the control group."""
    folder = tmp_path_factory.mktemp("served")
    generator = np.random.default_rng(0)
    with open_memory(folder / "m.db") as memory:
        fit([simulated(folder / "log.csv")], memory, FitSettings(model="categorical", types=2, control=0.4))
        study = open_study(memory)
        for user in range(60):
            for _ in range(4):
                made = choose(memory, study, f"new {user}")
                chance = CHANCE["ab"[user % 2]][POLICIES.index(made["policy"])]
                update(memory, study, made["decision"], float(generator.random() < chance))
        report(memory, study, log=folder / "decisions.csv")
    return folder


@pytest.mark.slow
def test_of_a_studys_log_the_control_group_is_read(served):
    document = evaluate([served / "decisions.csv"])
    assert document["group"] == "control"
    assert document["left_out"]["other_groups"] + document["decisions"] == 240
    assert document["certain"] == 0
    whole = evaluate([served / "decisions.csv"], EvaluateSettings(group="all"))
    assert (whole["group"], whole["decisions"]) == (None, 240)
    assert whole["certain"] > 0.3
    with pytest.raises(
        NotFoundError, match="group must be one of the logs' or 'all', got 'men'; there are control"
    ):
        evaluate([served / "decisions.csv"], EvaluateSettings(group="men"))


@pytest.mark.slow
def test_a_study_is_replayed_on_users_whom_it_does_not_know(served):
    with open_memory(served / "m.db") as memory:
        settings = EvaluateSettings(study="default", first=2)
        document = evaluate([served / "decisions.csv"], settings, memory=memory)
        (target,) = document["targets"]
        assert (target["name"], target["kind"], target["decision"]) == ("study default", "study", "all")
        own = evaluate(
            [served / "decisions.csv"], EvaluateSettings(study="default", group="personal"), memory=memory
        )
        with pytest.raises(InputError, match="study 'default' was fitted to all users of the log or knows"):
            evaluate([served / "log.csv"], EvaluateSettings(study="default"), memory=memory)
    # Its own choices were replayed with the probabilities that they had: every weight is 1.
    (target,) = own["targets"]
    assert target["weights"]["largest"] == pytest.approx(1)
    assert target["weights"]["mean"] == pytest.approx(1)
    assert target["estimates"]["ips"]["value"] == pytest.approx(own["logged"]["value"])


@pytest.mark.slow
def test_a_study_is_not_judged_on_decisions_that_a_later_fit_may_have_read(served, tmp_path, monkeypatch):
    shutil.copy(served / "m.db", tmp_path / "m.db")
    now = time.time()
    monkeypatch.setattr("lifelore.agent.personalise.fitting.fit.time.time", lambda: now + 10)
    with open_memory(tmp_path / "m.db") as memory:
        logs = [served / "log.csv", served / "decisions.csv"]
        fit(logs, memory, FitSettings(model="categorical", types=2, control=0.4))
        with pytest.raises(InputError, match="was fitted to all users of the log or knows their past"):
            evaluate([served / "decisions.csv"], EvaluateSettings(study="default"), memory=memory)


def test_a_study_needs_its_memory(log):
    with pytest.raises(InputError, match="study 'default' needs the memory that holds it"):
        evaluate([log], EvaluateSettings(study="default"))


# ---- mistakes -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("word", ["0", "-0.1", "1.01", "nan", "inf", "often", ""])
def test_a_bad_probability_is_refused_with_file_and_line(tmp_path, word):
    path = write(tmp_path / "log.csv", [("a", "x", 1, 0.5), ("b", "y", 0, word)])
    with pytest.raises(
        InputError, match=r"log\.csv line 3: probability must be a (number above 0 and at|finite number)"
    ):
        read_decisions([path])


def test_a_log_without_probabilities_is_refused(tmp_path):
    path = write(tmp_path / "log.csv", [("a", "x", 1)], ("user", "policy", "outcome"))
    with pytest.raises(InputError, match="it has no probability"):
        evaluate([path])


def test_columns_and_decimals_of_other_programs(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("who;what;went;p\na;x;1,5;0,5\nb;y;0,5;0,5\nc;x;2;0,25\n")
    columns = {"user": "who", "policy": "what", "outcome": "went", "probability": "p"}
    log, _ = read_decisions([path], LogFormat(columns, decimal_comma=True))
    assert log.probability.tolist() == [0.5, 0.5, 0.25]
    assert log.outcomes.tolist() == [1.5, 0.5, 2]


def test_fit_ignores_a_column_of_probabilities(tmp_path):
    """Only evaluation reads it, so no other program's column of that name can stop a fit."""
    path = write(tmp_path / "log.csv", [("a", "x", 1, "often\n"), ("b", "x", 0, "")])
    with open_memory(tmp_path / "m.db") as memory:
        assert fit([path], memory)["rows"] == 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("policy,share\nx,1\n", "must have the columns policy,probability"),
        ("policy,probability\nx,0.5\n", "probabilities must sum to 1, got 0.5"),
        ("policy,probability\nx,0.5\nx,0.5\n", "line 3: policy must be named once"),
        ("policy,probability\nx,1.5\n", "line 2: probability must be a number from 0 to 1, got '1.5'"),
        ("policy,probability\nx\n", "line 2: probability must be"),
        ("policy,probability\n", "at least one line"),
        ('policy,probability\n"x,1\n', "not CSV"),
        ("", "must have the columns"),
    ],
)
def test_a_bad_table_is_refused(log, tmp_path, text, words):
    path = tmp_path / "t.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        evaluate([log], EvaluateSettings(tables=(path,)))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"model": "forest"}, "model must be one of means, library"),
        ({"first": 0}, "first must be at least 1, got 0"),
        ({"explore": 1.5}, "explore must lie between 0 and 1"),
        ({"rules": ("best",)}, "best"),
    ],
)
def test_bad_settings_are_refused(settings, words):
    with pytest.raises((InputError, NotFoundError), match=words):
        EvaluateSettings(**settings)


def test_one_user_is_too_few(tmp_path):
    path = write(tmp_path / "log.csv", [("a", "x", 1, 0.5), ("a", "y", 1, 0.5)])
    with pytest.raises(InputError, match="at least 2 users"):
        evaluate([path])


@pytest.mark.slow
def test_the_folder_gets_document_and_picture(log, tmp_path):
    evaluate([log], out=tmp_path / "out")
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"evaluation.json", "evaluation.png"}
