"""Choosing for users, one at a time: what is chosen, what is kept, and that nothing counts twice or is lost."""

import signal
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from lifelore.agent.reuse.history import histories, user_key
from lifelore.agent.reuse.user_belief import open_belief

from lifelore.agent.personalise.decisions import add, choose, forget, retire, update
from lifelore.agent.personalise.fit.fit import FitSettings, fit
from lifelore.agent.personalise.log.log import read_log
from lifelore.agent.personalise.study import Study, open_study
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.protocols import Record
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import RULES, rule_named
from lifelore.memory import open_memory

POLICIES = ("big", "dark", "plain")
MEANS = np.array([[8.0, 1.0, 4.0], [1.0, 8.0, 4.0]])


def study_of(name="s", **settings):
    library = PolicyLibrary.from_means(MEANS, 2.0, ("reader", "skimmer"), POLICIES, prior=[0.6, 0.4])
    settings = {"control": 0.0, "rule": "sampling"} | settings
    return Study(name, library, dict.fromkeys(POLICIES, "active"), **settings)


def learnt_study(model="categorical", **settings):
    """A study whose library has seen eight outcomes a pair."""
    samples = np.random.default_rng(0).integers(0, 2, (3, len(POLICIES), 8))
    library = PolicyLibrary.from_samples(samples, model=model, policies=POLICIES)
    return Study("s", library, dict.fromkeys(POLICIES, "active"), **settings)


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


def belief_of(memory, study, user):
    return open_belief(memory, study, user_key(study.name, user)).state.head.log_belief


@pytest.mark.parametrize("name", sorted(RULES))
def test_the_probability_said_is_the_rules_own(name, memory):
    study = study_of(rule=name)
    said = choose(memory, study, "ann")
    probs = rule_named(name).probabilities(study.library, np.array([0.6, 0.4]))
    assert said["probability"] == pytest.approx(probs[POLICIES.index(said["policy"])])
    assert said["belief"] == pytest.approx({"reader": 0.6, "skimmer": 0.4})
    assert said["expected"] == pytest.approx({"big": 5.2, "dark": 3.8, "plain": 4.0})


@pytest.mark.slow
def test_policies_are_chosen_as_often_as_said(memory):
    study = study_of(explore=0.3)
    chosen = Counter(choose(memory, study, f"user {i}")["policy"] for i in range(200))
    # Sampling: 0.6 and 0.4, of 70 %; the rest alike. Five deviations of a share of 200 draws: 0.177.
    for policy, probability in {"big": 0.52, "dark": 0.38, "plain": 0.10}.items():
        assert chosen[policy] / 200 == pytest.approx(probability, abs=0.177)


@pytest.mark.slow
def test_the_same_seed_chooses_the_same_and_another_need_not(memory, tmp_path):
    study = study_of()
    first = [choose(memory, study, f"user {i}", seed=1)["policy"] for i in range(30)]
    with open_memory(tmp_path / "other.db") as other:
        assert first == [choose(other, study, f"user {i}", seed=1)["policy"] for i in range(30)]
    with open_memory(tmp_path / "third.db") as third:
        assert first != [choose(third, study, f"user {i}", seed=2)["policy"] for i in range(30)]


def test_the_belief_is_that_of_policy_reuse_bit_for_bit_in_whatever_order_outcomes_come(memory):
    study, agent = study_of(), BayesianPolicyReuse(study_of().library)
    generator = np.random.default_rng(0)
    made = [choose(memory, study, "ann") for _ in range(12)]
    outcomes = generator.normal(4, 3, 12)
    for place in generator.permutation(12):
        update(memory, study, made[place]["decision"], float(outcomes[place]))
    for one, outcome in zip(made, outcomes, strict=True):
        agent.update(one["policy"], float(outcome))
    assert np.array_equal(belief_of(memory, study, "ann"), agent.log_belief)


def test_types_that_change_are_followed(memory):
    study = study_of(change=0.1)
    agent = BayesianPolicyReuse(study.library, dynamics=study.dynamics)
    for outcome in (8.0, 7.0, 1.0, 2.0):
        made = choose(memory, study, "ann")
        update(memory, study, made["decision"], outcome)
        agent.update(made["policy"], outcome)
    assert np.array_equal(belief_of(memory, study, "ann"), agent.log_belief)
    assert not np.array_equal(belief_of(memory, study_of(), "ann"), agent.log_belief)


def test_users_do_not_learn_from_one_another(memory):
    study = study_of()
    update(memory, study, choose(memory, study, "ann")["decision"], 8.0)
    assert np.exp(belief_of(memory, study, "bo")) == pytest.approx([0.6, 0.4])
    assert np.exp(belief_of(memory, study_of("another"), "ann")) == pytest.approx([0.6, 0.4])


def test_an_outcome_counts_once(memory):
    study = study_of()
    made = choose(memory, study, "ann")["decision"]
    first = update(memory, study, made, 8.0)
    again = update(memory, study, made, 8.0)
    assert (first["taken"], again["taken"]) == (True, False)
    assert first["belief"] == again["belief"]
    with pytest.raises(InputError, match="ended with 8 already, got 7; nothing changed"):
        update(memory, study, made, 7.0)
    assert update(memory, study, made, 8.0)["belief"] == first["belief"]
    assert memory.check() == []


@pytest.mark.parametrize(
    ("decision", "error", "said"),
    [
        ("0123456789abcdef-0", NotFoundError, "no decision 0123456789abcdef-0 in study 's': never made here"),
        ("{key}-1", NotFoundError, "no decision"),
        ("{key}-0.1", NotFoundError, "no decision"),
        ("ann", InputError, "decision must be what `reuse choose` printed"),
        ("", InputError, "decision must be"),
    ],
)
def test_unknown_decisions(decision, error, said, memory):
    study = study_of()
    choose(memory, study, "ann")
    with pytest.raises(error, match=said):
        update(memory, study, decision.format(key=user_key("s", "ann")), 1.0)


@pytest.mark.parametrize("outcome", [np.nan, np.inf])
def test_an_outcome_is_a_finite_number(outcome, memory):
    study = study_of()
    made = choose(memory, study, "ann")["decision"]
    with pytest.raises(InputError, match="outcome must be a finite number"):
        update(memory, study, made, outcome)
    assert update(memory, study, made, 1.0)["taken"]


def test_a_category_never_seen_is_refused_and_the_decision_stays_open(memory, tmp_path):
    (tmp_path / "log.csv").write_text("user,policy,outcome\n" + "a,p,1\na,q,0\nb,p,0\nb,q,1\n" * 3)
    fit([tmp_path / "log.csv"], memory, FitSettings("c", "categorical", control=0))
    study = open_study(memory, "c")
    made = choose(memory, study, "ann")["decision"]
    with pytest.raises(InputError, match=r"outcome must be one of 0, 1, got 0\.5"):
        update(memory, study, made, 0.5)
    assert update(memory, study, made, 1.0)["taken"]


@pytest.mark.slow
def test_the_held_out_are_the_share_asked_for_and_the_same_for_ever(memory):
    less, more = study_of(control=0.1), study_of(control=0.3)
    users = [f"user {i}" for i in range(2000)]
    held, wider = ({user for user in users if study.holds_out(user)} for study in (less, more))
    assert held < wider
    # Five deviations of a share of 2000 draws.
    assert len(held) / 2000 == pytest.approx(0.1, abs=0.034)
    assert len(wider) / 2000 == pytest.approx(0.3, abs=0.052)
    assert not study_of(control=0.0).holds_out("anyone")
    assert held != {user for user in users if study_of("other", control=0.1).holds_out(user)}


@pytest.mark.slow
def test_the_held_out_get_each_policy_alike_or_the_incumbent(memory):
    study = study_of(control=0.9999)
    made = [choose(memory, study, f"user {i}") for i in range(150)]
    assert all(one["control"] and one["probability"] == pytest.approx(1 / 3) for one in made)
    # Five deviations of a share of 150 draws: 0.193.
    shares = Counter(one["policy"] for one in made)
    assert all(shares[policy] / 150 == pytest.approx(1 / 3, abs=0.193) for policy in POLICIES)
    same = study_of("t", control=0.9999, incumbent="plain")
    assert {choose(memory, same, f"user {i}")["policy"] for i in range(20)} == {"plain"}


def test_a_context_gives_the_prior_and_is_kept(memory):
    study = study_of(contexts={"web": np.array([0.1, 0.9])}, change=0.0)
    assert choose(memory, study, "ann", context="web")["belief"] == pytest.approx({"reader": 0.1, "skimmer": 0.9})
    assert choose(memory, study, "ann")["belief"] == pytest.approx({"reader": 0.1, "skimmer": 0.9})
    assert choose(memory, study, "bo", context="never heard of")["belief"]["reader"] == pytest.approx(0.6)


@pytest.mark.slow
def test_a_retired_policy_is_chosen_no_more_and_stays_evidence(memory):
    study = study_of(control=0.3)
    study.keep(memory)
    while (made := choose(memory, study, "ann"))["policy"] != "big":
        pass
    update(memory, study, made["decision"], 8.0)
    before = belief_of(memory, study, "ann")
    study = retire(memory, study, "big")
    assert np.array_equal(belief_of(memory, study, "ann"), before)
    reopened = open_study(memory, "s")
    assert reopened.states == {"big": "retired", "dark": "active", "plain": "active"}
    assert "big" not in {choose(memory, reopened, f"user {i}")["policy"] for i in range(60)}
    retire(memory, reopened, "dark")
    with pytest.raises(InputError, match="'plain' is the last policy in use"):
        retire(memory, open_study(memory, "s"), "plain")
    with pytest.raises(NotFoundError, match="no policy 'none'; there are big, dark, plain"):
        retire(memory, reopened, "none")
    assert "big" in add(memory, open_study(memory, "s"), "big").active


def test_the_incumbent_cannot_be_retired(memory):
    with pytest.raises(InputError, match="'plain' is the incumbent"):
        retire(memory, study_of(control=0.1, incumbent="plain"), "plain")
    with pytest.raises(NotFoundError, match="incumbent must be a policy in use, got 'none'"):
        study_of(incumbent="none")


@pytest.mark.slow
def test_a_new_policy_goes_to_the_held_out_until_a_fit_knows_it(memory):
    study = add(memory, study_of(control=0.5), "new")
    made = [choose(memory, study, f"user {i}") for i in range(120)]
    assert {one["policy"] for one in made if one["control"]} == {*POLICIES, "new"}
    assert {one["policy"] for one in made if not one["control"]} <= set(POLICIES)
    piloted = next(one for one in made if one["policy"] == "new")
    after = update(memory, study, piloted["decision"], 5.0)
    assert after["belief"] == pytest.approx({"reader": 0.6, "skimmer": 0.4})
    with pytest.raises(InputError, match="'new' is there already"):
        add(memory, study, "new")
    for settings in ({"control": 0.0}, {"control": 0.2, "incumbent": "big"}):
        with pytest.raises(InputError, match="'new' has no outcome yet, and there is no control group"):
            add(memory, study_of(**settings), "new")


def test_a_forgotten_user_is_a_new_one_and_old_decisions_stay_gone(memory):
    study = study_of()
    old = choose(memory, study, "ann")["decision"]
    update(memory, study, old, 8.0)
    choose(memory, study, "bo")
    assert forget(memory, study, "ann") == 2
    assert [history.user for history in histories(memory, study)] == ["bo"]
    assert b"ann" not in b"".join(str(entry).encode() for entry in memory.show()["robots"])
    with pytest.raises(NotFoundError, match="nothing is stored of user 'ann'"):
        forget(memory, study, "ann")
    with pytest.raises(NotFoundError, match="never made here, or forgotten"):
        update(memory, study, old, 8.0)
    fresh = choose(memory, study, "ann")
    assert fresh["number"] == 0
    assert fresh["decision"] == f"{old}.1"
    assert fresh["belief"]["reader"] == pytest.approx(0.6)
    with pytest.raises(NotFoundError):
        update(memory, study, old, 8.0)
    assert update(memory, study, fresh["decision"], 1.0)["taken"]
    assert memory.check() == []


def test_many_at_once_for_one_user_get_a_decision_each(memory):
    study = study_of()
    with ThreadPoolExecutor(4) as pool:
        made = list(pool.map(lambda _: choose(memory, study, "ann"), range(16)))
    assert sorted(one["number"] for one in made) == list(range(16))
    with ThreadPoolExecutor(4) as pool:
        taken = list(pool.map(lambda _: update(memory, study, made[0]["decision"], 3.0)["taken"], range(8)))
    assert sum(taken) == 1


KILLED = """
import sys
from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.study import open_study
from lifelore.memory import open_memory
with open_memory(sys.argv[1], durable=True) as memory:
    study = open_study(memory, "s")
    while True:
        made = choose(memory, study, "ann")
        print("chosen", made["decision"], flush=True)
        update(memory, study, made["decision"], float(made["number"]))
        print("ended", made["decision"], flush=True)
"""


@pytest.mark.slow
def test_a_process_killed_in_between_loses_nothing_it_had_told(tmp_path):
    path = tmp_path / "m.db"
    with open_memory(path) as memory:
        study_of().keep(memory)
    process = subprocess.Popen([sys.executable, "-c", KILLED, str(path)], stdout=subprocess.PIPE, text=True)
    told = [process.stdout.readline().split() for _ in range(15)]
    process.send_signal(signal.SIGKILL)
    told += [line.split() for line in process.stdout.read().splitlines() if len(line.split()) == 2]
    process.wait()
    process.stdout.close()
    with open_memory(path) as memory:
        study = open_study(memory, "s")
        (history,) = histories(memory, study)
        there = {history.identifier(one): one.outcome for one in history.decisions}
        assert all(decision in there for _, decision in told)
        assert all(there[decision] is not None for what, decision in told if what == "ended")
        agent = BayesianPolicyReuse(study.library)
        for one in history.decisions:
            if one.outcome is None:
                agent.end_episode()
            else:
                agent.update(one.policy, one.outcome)
        assert np.array_equal(belief_of(memory, study, "ann"), agent.log_belief)
        assert memory.check() == []
        assert choose(memory, study, "ann")["number"] == len(history.decisions)


def test_a_study_comes_back_bit_for_bit_also_after_a_larger_one(memory):
    large = PolicyLibrary.from_means(np.random.default_rng(0).normal(size=(9, 30)), 1.0)
    Study("s", large, dict.fromkeys(large.policies, "active")).keep(memory)
    kept = study_of(control=0.25, explore=0.1, change=0.05, contexts={"web": np.array([0.1, 0.9])})
    kept.keep(memory)
    found = open_study(memory, "s")
    assert found.library.to_bytes() == kept.library.to_bytes()
    assert found.contexts["web"].tolist() == [0.1, 0.9]
    assert found.selection == kept.selection
    for name in ("states", "control", "incumbent", "rule", "explore", "change"):
        assert getattr(found, name) == getattr(kept, name)


def test_a_study_of_static_types_stays_so_although_the_default_is_another(memory):
    """Studies of earlier versions were fitted with a default of 0 and hold that number."""
    study_of(change=0.0).keep(memory)
    study = open_study(memory, "s")
    agent = BayesianPolicyReuse(study.library, dynamics=TypeDynamics.static())
    for outcome in (8.0, 1.0, 7.0):
        made = choose(memory, study, "ann")
        update(memory, study, made["decision"], outcome)
        agent.update(made["policy"], outcome)
    assert study.dynamics.kind == "static"
    assert np.array_equal(belief_of(memory, study, "ann"), agent.log_belief)
    assert study_of().change == FitSettings().change == "learnt"


def of_earlier_lifelore(study, *, table=False):
    """The record of a Lifelore without settings of rules, with or without a signal table behind the library."""
    record = study.to_record()
    about = {name: value for name, value in record.about.items() if name != "rule_settings"}
    values = record.values
    if table:
        about |= {"table": [8, 3, 8, 2], "cuts": [3, 7]}
        values = np.append(values, np.full(3 * 8 * 2 + 3 * 7, np.float64(0.125).view(np.int64)))
    return Record(record.kind, record.key, 1, "newest", np.arange(len(values)), values, about)


@pytest.mark.parametrize("model", ["gaussian", "categorical"])
def test_a_study_from_memory_decides_as_before_it_was_stored(memory, model):
    study = learnt_study(model, rule="information-directed")
    study.keep(memory)
    said = []
    for one in (study, open_study(memory, "s")):
        update(memory, one, choose(memory, one, "ann", seed=1)["decision"], 1.0)
        said.append({key: choose(memory, one, "ben", seed=1)[key] for key in ("belief", "expected")})
    # An episode without an outcome leaves the prior, up to rounding.
    for key in ("belief", "expected"):
        assert said[0][key] == pytest.approx(said[1][key], rel=1e-12)


@pytest.mark.parametrize("table", [False, True])
@pytest.mark.parametrize("rule", ["sampling", "belief-entropy", "information-directed", "knowledge-gradient"])
def test_a_study_of_an_earlier_lifelore_chooses_the_same(tmp_path, rule, table):
    said = []
    with open_memory(tmp_path / "new.db") as new, open_memory(tmp_path / "old.db") as old:
        study_of(rule=rule).keep(new)
        earlier = of_earlier_lifelore(study_of(rule=rule), table=table)
        old.contribute("reuse s", [earlier], process="study", seq=0, task={})
        for memory in (new, old):
            study = open_study(memory, "s")
            for number in range(6):
                one = choose(memory, study, "ann")
                said += [one, update(memory, study, one["decision"], 1.5 * number)]
    assert said[: len(said) // 2] == said[len(said) // 2 :]


def test_a_study_of_an_earlier_lifelore_improves_the_outcome(tmp_path):
    # The policy of the wide outcomes is the worst; only the improvement of the outcome selects it.
    library = PolicyLibrary.from_means([[10.0, 6.0, 9.0]], [[1.0, 30.0, 1.0]], policies=POLICIES)
    study = Study("s", library, dict.fromkeys(POLICIES, "active"), control=0.0, rule="expected-improvement")
    said = []
    with open_memory(tmp_path / "new.db") as new, open_memory(tmp_path / "old.db") as old:
        study.keep(new)
        old.contribute("reuse s", [of_earlier_lifelore(study)], process="study", seq=0, task={})
        for memory in (new, old):
            retire(memory, open_study(memory, "s"), "plain")
            said.append(choose(memory, open_study(memory, "s"), "ann")["policy"])
    assert said == ["big", "dark"]


def test_studies_that_are_not_there_newer_or_damaged(memory):
    study_of("one").keep(memory)
    with pytest.raises(NotFoundError, match=r"no study 'two' in .*; known: one\. Begin with .* --name"):
        open_study(memory, "two")
    memory.contribute("x", [Record("reuse_study", "two", 2, "newest", [0], [0], {})], process="p", seq=0, task={})
    with pytest.raises(StoreError, match="study 'two' was kept by a newer Lifelore"):
        open_study(memory, "two")
    record = study_of("one").to_record()
    broken = Record(record.kind, "one", 1, "newest", record.slots, record.values ^ 1, record.about)
    memory.contribute("x", [broken], process="p", seq=1, task={})
    with pytest.raises(StoreError, match="fit the study anew"):
        open_study(memory, "one")


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"control": 1.0}, "control must lie between 0 and 1, 1 left out, got 1"),
        ({"control": -0.1}, "control must lie"),
        ({"control": np.nan}, "control must lie"),
        ({"explore": 1.1}, "explore must lie between 0 and 1, got 1.1"),
        ({"change": -1}, "change must lie"),
        ({"change": "often"}, "change must be 'learnt' or a probability, got 'often'"),
        ({"rule": "magic"}, "rule must be one of"),
        ({"name": "a/b"}, "name must be at most 60 characters without '/'"),
        ({"name": ""}, "name must be 1 to 200 printable"),
    ],
)
def test_bad_settings(settings, said):
    with pytest.raises((InputError, NotFoundError), match=said):
        study_of(**settings)


@pytest.mark.parametrize("user", ["", "a\nb", "x" * 201])
def test_users_have_names(user, memory):
    with pytest.raises(InputError, match="user must be 1 to 200 printable characters"):
        choose(memory, study_of(), user)


def test_the_log_of_the_fit_can_be_read_by_it(memory, tmp_path):
    """What `report` writes is a log."""
    from lifelore.agent.personalise.report import report

    study = study_of()
    for user in ("ann", "bo"):
        for outcome in (8.0, 2.5):
            update(memory, study, choose(memory, study, user)["decision"], outcome)
        choose(memory, study, user)
    report(memory, study, log=tmp_path / "decisions.csv")
    log = read_log([tmp_path / "decisions.csv"])
    assert (log.users, log.outcomes.tolist(), log.pending) == (["ann"] * 2 + ["bo"] * 2, [8.0, 2.5] * 2, 2)


def test_models_of_few_runs_learn_from_the_user_in_the_order_of_decisions(memory):
    """A late outcome changes the belief to that of an agent that saw all outcomes in order, parameters too."""
    study = learnt_study()
    study.keep(memory)
    made = [choose(memory, study, "ann") for _ in range(6)]
    outcomes = [1.0, 0.0, 1.0, 1.0, 0.0, 1.0]
    for number in (0, 3, 1, 5, 2, 4):
        update(memory, study, made[number]["decision"], outcomes[number])
    agent = BayesianPolicyReuse(study.library, dynamics=study.dynamics)
    for one, outcome in zip(made, outcomes, strict=True):
        agent.update(one["policy"], outcome)
    head = open_belief(memory, study, user_key("s", "ann")).state.head
    assert np.array_equal(head.log_belief, agent.log_belief)
    assert {name: array.tolist() for name, array in head.task.items()} == {
        name: array.tolist() for name, array in agent.algorithm.state(0).items()
    }
    assert head.task
    answer = choose(memory, study, "ann")
    assert answer["expected"] == pytest.approx(dict(zip(POLICIES, agent.expected_utility(), strict=True)))


def test_a_study_with_plug_in_models_takes_them_for_the_truth(memory):
    study = learnt_study(models="plug-in")
    study.keep(memory)
    study = open_study(memory, "s")
    assert study.models == "plug-in"
    made = choose(memory, study, "ann")
    update(memory, study, made["decision"], 1.0)
    agent = BayesianPolicyReuse(study.library, dynamics=study.dynamics, models="plug-in")
    agent.update(made["policy"], 1.0)
    head = open_belief(memory, study, user_key("s", "ann")).state.head
    assert np.array_equal(head.log_belief, agent.log_belief)
    assert set(head.task) == {"changes.shares"}
    with pytest.raises(InputError, match="models must be one of"):
        learnt_study(models="exact")
