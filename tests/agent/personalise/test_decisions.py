"""Decisions and outcomes: what is drawn and stored, and that nothing counts twice or is lost."""

from collections import Counter

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import Request, choose, decide, forget, observe, update
from lifelore.agent.personalise.explanation import explain
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.identifiers import identifier, new_ids, parse_identifier
from lifelore.agent.personalise.registration import add
from lifelore.agent.personalise.study import open_study
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.unknown_users import MASS
from lifelore.interaction.selection import RULES, rule_named
from lifelore.memory import open_memory

from .studies import MEANS, POLICIES, belief_of, learnt_study, one_more, study_of

ODD = ("google-oauth2/117", "50% off", "o/ä%59 ✓", "=cmd", "a'b\"c", "a:b?c")


# ---- the belief, by hand --------------------------------------------------------------------------------------


def test_a_belief_follows_from_bayes_rule(memory):
    study = study_of(change=0.0).keep(memory)
    made = choose(memory, study, "ann")
    assert made["belief"] == pytest.approx({"reader": 0.6, "skimmer": 0.4})
    assert made["expected"] == pytest.approx({"big": 5.2, "dark": 3.8, "plain": 4.0})
    said = update(memory, study, made["decision"], 3.0)
    # Normal densities of 3 with deviation 2 around each type's mean of the policy; their ratio alone counts.
    column = POLICIES.index(made["policy"])
    weight = [p * np.exp(-((3.0 - mean) ** 2) / 8) for p, mean in zip((0.6, 0.4), MEANS[:, column], strict=True)]
    assert said["belief"]["reader"] == pytest.approx(weight[0] / sum(weight))
    assert belief_of(memory, study, "ann") == pytest.approx(list(said["belief"].values()))
    assert belief_of(memory, study, "bo") == pytest.approx([0.6, 0.4]), "users do not learn from one another"


def test_types_that_change_draw_the_belief_to_the_prior(file_memory):
    study = study_of(change=0.25).keep(file_memory)
    made = choose(file_memory, study, "ann")
    said = update(file_memory, study, made["decision"], 8.0)
    column = POLICIES.index(made["policy"])
    weight = [p * np.exp(-((8.0 - mean) ** 2) / 8) for p, mean in zip((0.6, 0.4), MEANS[:, column], strict=True)]
    assert said["belief"]["reader"] == pytest.approx(0.75 * weight[0] / sum(weight) + 0.25 * 0.6)


def test_a_context_gives_the_prior_and_is_stored(memory):
    study = study_of(contexts={"web": np.array([0.1, 0.9])}, change=0.0).keep(memory)
    made = choose(memory, study, "ann", context="web")
    assert made["belief"] == pytest.approx({"reader": 0.1, "skimmer": 0.9})
    assert (made["context"], choose(memory, study, "ann")["context"]) == ("web", "web")
    other = choose(memory, study, "bo", context="never heard of")
    assert (other["context"], other["belief"]["reader"]) == (None, pytest.approx(0.6))


# ---- probabilities ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sorted(RULES))
def test_probabilities_are_the_rules_own(name, file_memory):
    study = study_of(rule=name, explore=0.2).keep(file_memory)
    free, some = decide(file_memory, study, [Request("ann"), Request("ann", available=["plain", "dark"])])
    probs = rule_named(name).probabilities(study.library, np.array([0.6, 0.4]))
    assert list(free["probabilities"].values()) == pytest.approx((0.8 * probs + 0.2 / 3).tolist())
    assert free["probability"] == pytest.approx(free["probabilities"][free["policy"]])
    # Of a set, those of a library without the others.
    probs = rule_named(name).probabilities(study.library.take(policies=[1, 2]), np.array([0.6, 0.4]))
    assert some["probability"] == pytest.approx(0.8 * probs[("dark", "plain").index(some["policy"])] + 0.1)
    assert (free["available"], some["available"]) == (None, ["dark", "plain"])


def test_policies_are_drawn_as_often_as_logged(file_memory):
    study = study_of(explore=0.3).keep(file_memory)
    n = 20_000
    made = decide(file_memory, study, [Request(f"user {i}") for i in range(n)], brief=True)
    chosen = Counter(one["policy"] for one in made)
    # Sampling takes the best response to a type: 0.6 and 0.4, of 70 %; the rest alike. Five deviations of a share
    # of n draws with probability p: 5 √(p (1 − p) / n) ≤ 5 · 0.5 / √20,000 = 0.0177.
    for policy, probability in {"big": 0.52, "dark": 0.38, "plain": 0.10}.items():
        assert chosen[policy] / n == pytest.approx(probability, abs=0.0177)
    assert {round(one["probability"], 12) for one in made} == {0.52, 0.38, 0.10}


def test_the_draws_of_one_user_are_as_often_as_logged(file_memory):
    study = study_of(change=0.0).keep(file_memory)
    made = decide(file_memory, study, [Request("ann")] * 2000, brief=True)
    # Five deviations of a share of 2000 draws: 5 · √(0.24 / 2000) = 0.055.
    assert np.mean([one["policy"] == "big" for one in made]) == pytest.approx(0.6, abs=0.055)


def test_a_batch_draws_as_one_user_after_the_other(memory, new_place):
    users = ["ann", "bo", "ann", *(f"user {i}" for i in range(20)), "bo", "ann"]
    study = study_of().keep(memory)
    batch = decide(memory, study, [Request(user) for user in users], seed=3)
    with open_memory(new_place("sqlite")) as other:
        study_of().keep(other)
        singles = [choose(other, study, user, seed=3) for user in users]
        assert [one["policy"] for one in singles] != [
            choose(other, study_of("t").keep(other), user, seed=3)["policy"] for user in users
        ]
    for key in ("policy", "control", "user"):
        assert [one[key] for one in batch] == [one[key] for one in singles]
    for key in ("probability", "belief", "expected"):
        assert [one[key] for one in batch] == [pytest.approx(one[key], rel=1e-12) for one in singles]


def test_a_request_that_was_answered_before_takes_no_draw_from_others(file_memory, new_place):
    study = study_of().keep(file_memory)
    choose(file_memory, study, "ann", request="r")
    batch = decide(file_memory, study, [Request("ann", request="r"), *[Request("ann")] * 30])
    assert batch[0]["repeated"]
    with open_memory(new_place("sqlite")) as other:
        study_of().keep(other)
        singles = [choose(other, study, "ann") for _ in range(31)]
    assert [one["policy"] for one in batch[1:]] == [one["policy"] for one in singles[1:]]


# ---- the control group ---------------------------------------------------------------------------------------


def test_the_control_group_is_the_share_asked_for_and_the_same_for_ever():
    less, more = study_of(control=0.1), study_of(control=0.3)
    users = [f"user {i}" for i in range(2000)]
    held, wider = ({user for user in users if study.holds_out(user)} for study in (less, more))
    assert held < wider
    # Five deviations of a share of 2000 draws.
    assert len(held) / 2000 == pytest.approx(0.1, abs=0.034)
    assert len(wider) / 2000 == pytest.approx(0.3, abs=0.052)
    assert not study_of(control=0.0).holds_out("anyone")
    assert held != {user for user in users if study_of("other", control=0.1).holds_out(user)}


def test_the_control_group_gets_each_policy_alike_or_the_incumbent(file_memory):
    study = study_of(control=0.9999).keep(file_memory)
    made = decide(file_memory, study, [Request(f"user {i}") for i in range(3000)], brief=True)
    assert all(one["control"] and one["probability"] == pytest.approx(1 / 3) for one in made)
    shares = Counter(one["policy"] for one in made)
    # Five deviations of a share of 3000 draws: 5 · √(2 / 9 / 3000) = 0.043.
    assert all(shares[policy] / 3000 == pytest.approx(1 / 3, abs=0.043) for policy in POLICIES)
    some = decide(file_memory, study, [Request(f"user {i}", available=["big", "plain"]) for i in range(40)])
    assert {(one["policy"], one["probability"]) for one in some} == {("big", 0.5), ("plain", 0.5)}
    same = study_of("t", control=0.9999, incumbent="dark").keep(file_memory)
    made = decide(file_memory, same, [Request(f"user {i}") for i in range(20)])
    assert {(one["policy"], one["probability"]) for one in made} == {("dark", 1.0)}
    gone = choose(file_memory, same, "user 0", available=["big", "plain"])
    assert (gone["control"], gone["probability"]) == (True, 0.5)


def test_a_pilot_goes_to_the_control_group_alone(file_memory):
    study = add(file_memory, study_of(control=0.5).keep(file_memory), "new")
    made = decide(file_memory, study, [Request(f"user {i}") for i in range(120)])
    assert {one["policy"] for one in made if one["control"]} == {*POLICIES, "new"}
    assert {one["policy"] for one in made if not one["control"]} <= set(POLICIES)
    piloted = next(one for one in made if one["policy"] == "new")
    after = update(file_memory, study, piloted["decision"], 5.0)
    assert after["belief"] == pytest.approx({"reader": 0.6, "skimmer": 0.4}), "no evidence before a fit knows it"


# ---- a decision and its outcome count once --------------------------------------------------------------------


def test_an_outcome_counts_once(memory):
    study = study_of().keep(memory)
    made = choose(memory, study, "ann")["decision"]
    first, again = update(memory, study, made, 8.0), update(memory, study, made, 8.0)
    assert (first["taken"], again["taken"]) == (True, False)
    assert first["belief"] == again["belief"]
    with pytest.raises(InputError, match="ended with 8 already, got 7; nothing changed"):
        update(memory, study, made, 7.0)
    assert update(memory, study, made, 8.0)["belief"] == first["belief"]
    other = choose(memory, study, "ann")["decision"]
    answers = observe(memory, study, [(other, 1.0), (other, 1.0), (other, 2.0)])
    assert [one["taken"] for one in answers[:2]] == [True, False]
    assert isinstance(answers[2], InputError)
    with memory.studies.totals(study.number) as totals:
        assert totals.by_user().personal_sum.tolist() == [9.0]


def test_the_same_request_gets_the_same_decision(memory):
    study = study_of(explore=1.0).keep(memory)
    first = choose(memory, study, "ann", request="r", available=["big", "dark"])
    again = choose(memory, study, "ann", request="r", available=["dark", "big"], seed=9)
    assert (first["repeated"], again["repeated"]) == (False, True)
    assert (again["decision"], again["policy"]) == (first["decision"], first["policy"])
    for available in (None, ["big"]):
        with pytest.raises(InputError, match="was made with other available policies; give this one another"):
            choose(memory, study, "ann", request="r", available=available)
    other = choose(memory, study, "bo", request="r")
    assert other["decision"] != first["decision"], "requests are named by user"
    batch = decide(memory, study, [Request("ann", request="q"), Request("ann", request="q")])
    assert [one["repeated"] for one in batch] == [False, True]
    assert batch[0]["decision"] == batch[1]["decision"]
    assert explain(memory, study, "ann")["decisions"] == 2


def test_errors_of_single_items_leave_the_others(memory):
    study = study_of().keep(memory)
    requests = [
        Request("ann"), Request(""), Request("bo", available=["none"]), Request("cy", available=[]),
        Request("di", features={"age": 3.0}), Request("ann"), Request("x\ny"),
    ]  # fmt: skip
    answers = decide(memory, study, [*requests, Request("x" * 201)])
    kinds = [type(one) for one in answers]
    assert kinds == [dict, InputError, NotFoundError, InputError, InputError, dict, InputError, InputError]
    assert str(answers[1]).startswith("user must be 1 to 200 printable characters, got ''")
    first, second = answers[0]["decision"], answers[5]["decision"]
    unknown = identifier(new_ids(10**12, 1)[0])
    pairs = [(first, 1.0), ("no identifier", 1.0), (unknown, 1.0), (second, float("nan")), (second, True)]
    found = observe(memory, study, [*pairs, (second, 2.0)])
    assert [type(one) for one in found] == [dict, InputError, NotFoundError, InputError, InputError, dict]
    with memory.studies.totals(study.number) as totals:
        assert (totals.n_users(), totals.n_decisions()) == (1, (2, 0))


@pytest.mark.parametrize("model", ["gaussian", "categorical", "joint-normal"])
def test_a_batch_may_be_empty_or_all_wrong(model, file_memory):
    study = learnt_study(model).keep(file_memory)
    assert decide(file_memory, study, []) == observe(file_memory, study, []) == []
    (wrong,) = decide(file_memory, study, [Request("")])
    unknown, bad = observe(file_memory, study, [(identifier(new_ids(1, 1)[0]), 1.0), ("x", 1.0)])
    assert [type(one) for one in (wrong, unknown, bad)] == [InputError, NotFoundError, InputError]
    for _ in range(2):
        (made,) = decide(file_memory, study, [Request("ann", request="r")])
    assert made["repeated"]


@pytest.mark.parametrize(
    ("decision", "error", "said"),
    [
        ("0123456789abcdef-0", NotFoundError, "in study 's': never made here, or forgotten"),
        ("ann", InputError, "decision must be the identifier that a choice gave, got 'ann'"),
        ("", InputError, "decision must be"),
        (3, InputError, "decision must be"),
    ],
)
def test_unknown_decisions(decision, error, said, file_memory):
    study = study_of().keep(file_memory)
    choose(file_memory, study, "ann")
    with pytest.raises(error, match=said):
        update(file_memory, study, decision, 1.0)


@pytest.mark.parametrize("outcome", [np.nan, np.inf, 1e308, True, "7", None])
def test_an_outcome_is_a_finite_number(outcome, file_memory):
    study = study_of().keep(file_memory)
    made = choose(file_memory, study, "ann")["decision"]
    with pytest.raises(InputError, match="outcome must be a finite number of at most"):
        update(file_memory, study, made, outcome)
    assert update(file_memory, study, made, 1e99)["taken"]


def test_a_value_that_no_type_can_have_is_refused_and_the_decision_stays_open(file_memory):
    log = {"user": [*"aabb"] * 3, "policy": [*"pqpq"] * 3, "outcome": [1.0, 0.0, 0.0, 1.0] * 3}
    fit(log, file_memory, FitSettings("c", "categorical", control=0))
    study = open_study(file_memory, "c")
    made = choose(file_memory, study, "ann")["decision"]
    with pytest.raises(InputError, match=r"outcome must be one of 0, 1, got 0\.5"):
        update(file_memory, study, made, 0.5)
    assert update(file_memory, study, made, 1.0)["taken"]


def test_identifiers_are_in_the_order_of_their_times_and_come_back():
    ids = [*new_ids(5, 200), *new_ids(6, 200)]
    assert ids == sorted(set(ids))
    assert [parse_identifier(identifier(one)) for one in ids] == ids
    assert {identifier(one)[14] for one in ids} == {"7"}
    assert {identifier(one)[19] for one in ids} <= set("89ab")


# ---- a study with and without its users ------------------------------------------------------------------------


def test_names_of_any_printable_text_are_decided_for_and_forgotten(memory):
    study = study_of(policies=ODD[:3]).keep(memory)
    made = decide(memory, study, [Request(user, request=user, available=ODD[:2]) for user in ODD])
    assert [one["user"] for one in made] == list(ODD)
    assert {one["policy"] for one in made} <= set(ODD[:2])
    for user, one in zip(ODD, made, strict=True):
        update(memory, study, one["decision"], 3.0)
        assert explain(memory, study, user)["decisions"] == 1
        assert forget(memory, study, user) == 1
    with memory.studies.totals(study.number) as totals:
        assert (totals.n_users(), totals.n_decisions()) == (0, (0, 0))


def test_a_forgotten_user_is_a_new_user_and_old_decisions_stay_gone(memory):
    study = study_of().keep(memory)
    old, still = (choose(memory, study, "ann")["decision"] for _ in range(2))
    update(memory, study, old, 8.0)
    choose(memory, study, "bo")
    assert forget(memory, study, "ann") == 2
    with pytest.raises(NotFoundError, match="nothing is stored of user 'ann'"):
        forget(memory, study, "ann")
    for decision in (old, still):
        with pytest.raises(NotFoundError, match="never made here, or forgotten"):
            update(memory, study, decision, 8.0)
    assert choose(memory, study, "ann")["belief"]["reader"] == pytest.approx(0.6)
    assert (explain(memory, study, "ann")["decisions"], explain(memory, study, "bo")["decisions"]) == (1, 1)


def test_an_open_decision_leaves_the_belief_as_it_is(file_memory):
    """Types change from outcome to outcome, so a decision that nobody answers costs no belief."""
    study = study_of(change=0.2).keep(file_memory)
    one_more(file_memory, study, "ann", 7.0)
    first = belief_of(file_memory, study, "ann")
    assert belief_of(file_memory, study, "ann") == first


def test_novelty_is_that_of_a_detector_that_saw_the_same(file_memory):
    study = study_of(change=0.0).keep(file_memory)
    shown = [(one_more(file_memory, study, "ann", outcome), outcome) for outcome in (40.0, -30.0)]
    agent = BayesianPolicyReuse(study.library, dynamics=study.dynamics, novelty=MASS)
    for policy, outcome in shown:
        agent.update(policy, outcome)
    assert choose(file_memory, study, "ann", novelty=True)["novelty"] == pytest.approx(agent.novelty.probability)
    assert explain(file_memory, study, "ann")["novelty"] == pytest.approx(agent.novelty.probability)
    assert choose(file_memory, study, "ann")["novelty"] is None
