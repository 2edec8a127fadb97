"""People in a log are not strangers: their past seeds the belief, counts once, and goes when asked to."""

import numpy as np
import pytest
from lifelore.agent.reuse.history import open_history, user_key
from lifelore.agent.personalise.past import read_past
from lifelore.agent.reuse.user_belief import NAMED_TYPE, open_belief

from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.agent.personalise.fit.fit import FitSettings, fit
from lifelore.agent.personalise.past import warm
from lifelore.agent.personalise.report import report
from lifelore.agent.personalise.study import open_study
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.novelty.novelty_detector import MASS
from lifelore.memory import open_memory

HEAD = "user,policy,outcome\n"


def households(first=0, n=40, each=18):
    """Of each household, the brand taken at all times but one is its own."""
    generator = np.random.default_rng(first)
    lines = []
    for user in range(first, first + n):
        for _ in range(each):
            brand = generator.integers(3)
            lines.append(f"h{user},b{brand},{int(generator.random() < (0.95 if brand == user % 3 else 0.05))}")
    return "\n".join(lines) + "\n"


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


@pytest.fixture
def log(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(HEAD + households())
    return path


@pytest.fixture
def study(memory, log):
    fit([log], memory, FitSettings(control=0.0, types=3))
    return open_study(memory)


def head_of(memory, study, user):
    return open_belief(memory, study, user_key(study.name, user), user).state.head


def naive(study, rows, prior=None):
    agent = BayesianPolicyReuse(study.library, prior=prior, dynamics=study.dynamics)
    for policy, outcome in rows:
        agent.update(policy, outcome)
    return agent


def rows_of(text, user):
    lines = (line.split(",") for line in text.splitlines())
    return [(fields[1], float(fields[2])) for fields in lines if fields[0] == user]


def test_a_household_of_the_log_gets_its_own_brand_at_the_first_choice(memory, study, log):
    text = log.read_text()
    for user in range(12):
        made = choose(memory, study, f"h{user}")
        assert made["number"] == 0
        assert made["policy"] == f"b{user % 3}"
        agent = naive(study, rows_of(text, f"h{user}"))
        assert list(made["belief"].values()) == agent.belief.tolist()
        assert made["surprise"] == agent.surprise
        assert made["novelty"] is None
    assert choose(memory, study, "stranger")["belief"] == pytest.approx(
        dict(zip(study.library.types, study.library.prior, strict=True))
    )


def test_decisions_come_after_the_past_bit_for_bit(memory, study, log):
    rows = rows_of(log.read_text(), "h5")
    for outcome in (1.0, 0.0, 1.0):
        made = choose(memory, study, "h5")
        update(memory, study, made["decision"], outcome)
        rows.append((made["policy"], outcome))
    assert np.array_equal(head_of(memory, study, "h5").log_belief, naive(study, rows).log_belief)


def test_the_probability_that_no_known_type_fits_counts_past_and_decisions(memory, study, log):
    rows = rows_of(log.read_text(), "h5")
    for outcome in (1.0, 0.0, None, 0.0):
        made = choose(memory, study, "h5", novelty=True)
        agent = BayesianPolicyReuse(study.library, dynamics=study.dynamics, novelty=MASS)
        for policy, seen in rows:
            agent.end_episode() if seen is None else agent.update(policy, seen)
        assert agent.novelty is not None
        assert made["novelty"] == agent.novelty.probability
        if outcome is not None:
            update(memory, study, made["decision"], outcome)
        rows.append((made["policy"], outcome))
    assert choose(memory, study, "nobody", novelty=True)["novelty"] == pytest.approx(MASS, rel=1e-12)


def test_warm_gives_later_users_a_past_and_leaves_the_library(memory, study, tmp_path):
    (tmp_path / "later.csv").write_text(HEAD + households(100, 9))
    before = study.library.to_bytes()
    document = warm([tmp_path / "later.csv"], memory, study)
    assert (document["rows"], document["users"], document["known"]) == (162, 9, 0)
    agent = naive(study, rows_of(households(100, 9), "h104"))
    assert np.array_equal(head_of(memory, study, "h104").log_belief, agent.log_belief)
    assert open_study(memory).library.to_bytes() == before


def test_the_same_log_counts_once(memory, study, log, tmp_path):
    (tmp_path / "later.csv").write_text(HEAD + households(100, 3))
    (tmp_path / "copy.csv").write_text(HEAD + households(100, 3))
    warm([tmp_path / "later.csv"], memory, study)
    first = head_of(memory, study, "h101").log_belief
    for path in (tmp_path / "later.csv", tmp_path / "copy.csv", log):
        document = warm([path], memory, study)
        assert document["rows"] == 0
        assert document["known"] > 0
    assert np.array_equal(head_of(memory, study, "h101").log_belief, first)
    with pytest.raises(InputError, match="are equal; lines would count twice"):
        warm([tmp_path / "later.csv", tmp_path / "copy.csv"], memory, study)


def test_a_log_that_has_grown_adds_its_new_lines_alone(memory, study, tmp_path):
    path, more = tmp_path / "later.csv", "h900,b0,1\nh900,b1,0\n"
    path.write_text(HEAD + households(100, 3))
    warm([path], memory, study)
    path.write_text(path.read_text() + more)
    document = warm([path], memory, study)
    assert (document["rows"], document["known"], document["users"]) == (2, 54, 1)
    assert np.array_equal(
        head_of(memory, study, "h900").log_belief, naive(study, rows_of(more, "h900")).log_belief
    )
    assert warm([path], memory, study)["rows"] == 0
    path.write_text(HEAD + "h900,b0,1\n")
    with pytest.raises(InputError, match="was read before with other lines; put the new lines"):
        warm([path], memory, study)


def test_a_last_line_that_went_on_is_no_known_line(memory, study, tmp_path):
    path = tmp_path / "later.csv"
    path.write_text(HEAD + "h900,b0,1")
    warm([path], memory, study)
    path.write_text(HEAD + "h900,b0,10")
    with pytest.raises(InputError, match="was read before with other lines"):
        warm([path], memory, study)


def test_a_new_fit_replaces_the_past_of_the_old_and_keeps_warm_logs_it_does_not_read(memory, study, log, tmp_path):
    later = tmp_path / "later.csv"
    later.write_text(HEAD + households(100, 3))
    warm([later], memory, study)
    shorter = tmp_path / "shorter.csv"
    shorter.write_text(HEAD + households(0, 39))
    fit([shorter], memory, FitSettings(control=0.0, types=3))
    past = read_past(memory, "default")
    assert user_key("default", "h39") not in past.users
    assert len(past.users) == 42
    fit([log, later], memory, FitSettings(control=0.0, types=3))
    past = read_past(memory, "default")
    assert len(past.users) == 43
    assert past.n_rows == 43 * 18
    assert len(memory.robots()) == 2, "the study and one generation of the past"


def test_decisions_that_memory_has_are_no_past(memory, study, log, tmp_path):
    made = choose(memory, study, "ann")
    update(memory, study, made["decision"], 1.0)
    report(memory, study, log=tmp_path / "decisions.csv")
    before = head_of(memory, study, "ann").log_belief
    assert warm([tmp_path / "decisions.csv"], memory, study)["decisions"] == 1
    assert np.array_equal(head_of(memory, study, "ann").log_belief, before)
    fit([log, tmp_path / "decisions.csv"], memory, FitSettings(control=0.0, types=3))
    again = open_study(memory)
    assert np.array_equal(
        head_of(memory, again, "ann").log_belief, naive(again, [(made["policy"], 1.0)]).log_belief
    )
    with open_memory(tmp_path / "new.db") as other:
        fit([log], other, FitSettings(control=0.0, types=3))
        new = open_study(other)
        assert warm([tmp_path / "decisions.csv"], other, new)["rows"] == 1
        assert not np.array_equal(head_of(other, new, "ann").log_belief, head_of(other, new, "bo").log_belief)


def test_a_named_type_and_a_context_of_the_log_count(memory, tmp_path):
    lines = [f"u{i},b{i % 2},{i % 3},{'k' if i < 6 else 'l'},{'web' if i < 5 else 'app'}" for i in range(12)]
    (tmp_path / "log.csv").write_text("\n".join(["user,policy,outcome,type,context", *lines]) + "\n")
    fit([tmp_path / "log.csv"], memory, FitSettings(control=0.0, model="gaussian"))
    study = open_study(memory)
    web = study.prior_of("web")
    prior = NAMED_TYPE * np.array([1.0, 0.0]) + (1 - NAMED_TYPE) * web
    said = choose(memory, study, "u4")
    assert said["context"] == "web"
    assert list(said["belief"].values()) == pytest.approx(naive(study, [("b0", 1.0)], prior).belief.tolist())
    (tmp_path / "more.csv").write_text("user,policy,outcome,type\nv,b0,1,other\nv,none,1,\n")
    document = warm([tmp_path / "more.csv"], memory, study)
    assert (document["unknown_types"], document["unknown_policies"]) == (["other"], 1)
    assert np.array_equal(head_of(memory, study, "v").log_belief, naive(study, [("b0", 1.0)]).log_belief)


def test_the_control_group_is_chosen_for_without_its_past(memory, log):
    fit([log], memory, FitSettings(control=0.9999, types=3))
    study = open_study(memory)
    made = [choose(memory, study, f"h{user}") for user in range(40)]
    assert all(one["control"] and one["probability"] == pytest.approx(1 / 3) for one in made)
    # Chosen by its past, each household would get its own brand: 40 of 40. Five deviations of 40 draws of a third.
    assert sum(one["policy"] == f"b{user % 3}" for user, one in enumerate(made)) < 40 / 3 + 5 * (40 * 2 / 9) ** 0.5


def test_forgetting_takes_the_past_too(memory, study):
    stranger = head_of(memory, study, "stranger").log_belief
    assert forget(memory, study, "h7") == 0
    assert np.array_equal(head_of(memory, study, "h7").log_belief, stranger)
    assert not np.array_equal(head_of(memory, study, "h8").log_belief, stranger)
    with pytest.raises(NotFoundError, match="nothing is stored of user 'h7'"):
        forget(memory, study, "h7")
    update(memory, study, choose(memory, study, "h8")["decision"], 1.0)
    assert forget(memory, study, "h8") == 2
    assert len(memory.robots()) == 2
    assert memory.check() == []


def test_a_past_that_memory_got_meanwhile_is_seen_by_the_next_choice(memory, study, tmp_path):
    update(memory, study, choose(memory, study, "ann")["decision"], 1.0)
    (tmp_path / "later.csv").write_text(HEAD + "ann,b0,1\nann,b0,1\n")
    warm([tmp_path / "later.csv"], memory, study)
    decisions = open_history(memory, study, user_key("default", "ann")).decisions
    rows = [("b0", 1.0), ("b0", 1.0), (decisions[0].policy, 1.0)]
    assert np.array_equal(head_of(memory, study, "ann").log_belief, naive(study, rows).log_belief)


def test_many_users_lie_in_many_records_and_come_back(memory, tmp_path):
    (tmp_path / "log.csv").write_text(HEAD + households(0, 200, 2))
    fit([tmp_path / "log.csv"], memory, FitSettings(types=1))
    assert len(memory.keys("reuse_past")) == 1 + 8
    past = read_past(memory, "default")
    for user in (0, 77, 199):
        assert past.users[user_key("default", f"h{user}")].outcomes == rows_of(households(0, 200, 2), f"h{user}")
