"""From a log to a study: by hand on a log of a few lines, and types found where nobody named them."""

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.registration import add, retire
from lifelore.agent.personalise.study import open_study
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import open_memory


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


@pytest.fixture
def fitted(tmp_path, memory):
    """Fit lines of a log; the document and the study."""

    def fit_lines(lines, head="user,policy,outcome", **settings):
        path = tmp_path / "log.csv"
        path.write_text("\n".join([head, *lines]) + "\n")
        document = fit([path], memory, FitSettings(**settings))
        return document, open_study(memory, settings.get("name", "default"))

    return fit_lines


TYPED = "user,type,policy,outcome"


def test_types_that_the_log_names(fitted):
    document, study = fitted(
        ["a,young,x,1.5", "a,young,y,0.1", "b,young,x,2.5", "c,old,x,0.25", "c,old,y,3.75", "c,,y,4.25"],
        TYPED, model="gaussian",
    )  # fmt: skip
    assert study.library.types == ("old", "young")
    assert study.library.policies == ("x", "y")
    assert document["means"] == [[0.25, 4.0], [2.0, pytest.approx(0.1)]]
    assert document["outcomes"] == [[1, 2], [2, 1]]
    # Two young users of three, one more in each.
    assert study.library.prior == pytest.approx([2 / 5, 3 / 5])
    assert [one["best"] for one in document["types"]] == ["y", "x"]
    assert [one["users"] for one in document["types"]] == [1, 2]
    assert (document["types_found"], document["left_out"], document["borrowed"]) == (False, 0, 0)


def test_a_user_of_no_known_type_is_left_out_and_said(fitted):
    document, study = fitted(["a,k,x,1", "b,,x,0", "c,l,x,0"], TYPED)
    assert (document["rows"], document["left_out"]) == (2, 1)
    assert study.library.types == ("k", "l")


def test_a_pair_without_outcomes_expects_what_everybody_gets(fitted):
    document, _ = fitted(["a,k,x,1.5", "a,k,x,2.5", "a,k,y,7.25", "b,l,x,0.5"], TYPED, model="gaussian")
    assert document["means"] == [[2.0, 7.25], [0.5, 7.25]]
    assert (document["borrowed"], document["outcomes"]) == (1, [[2, 1], [1, 0]])


def many(means, seed=0, users=60, each=12):
    generator = np.random.default_rng(seed)
    for user in range(users):
        row = means[user % len(means)]
        for policy in generator.integers(len(row), size=each):
            yield f"u{user},p{policy},{generator.normal(row[policy], 0.3):.4f}"


MEANS = np.array([[2.0, 0.0, 1.0], [0.0, 2.0, 1.0]])


def test_types_are_found_where_the_log_names_none(fitted):
    document, _ = fitted(list(many(MEANS)))
    assert document["types_found"]
    assert [one["best"] for one in document["types"]] in (["p0", "p1"], ["p1", "p0"])
    assert [one["users"] for one in document["types"]] == [30, 30]
    assert (document["model"], document["personalised_by"]) == ("gaussian", ["types"])
    assert document["held_out"]["users"] > 50
    # Half of the choices are for strangers, who get the best single policy.
    assert document["held_out"]["over_single"][1] > 0.25
    few, _ = fitted(list(many(MEANS, users=14)), name="few")
    assert [one["best"] for one in few["types"]] in (["p0", "p1"], ["p1", "p0"])
    asked, _ = fitted(list(many(MEANS)), types=1, name="one")
    assert len(asked["types"]) == 1


@pytest.mark.parametrize(
    ("model", "kind"),
    [("auto", "categorical"), ("categorical", "categorical"), ("student-t", "student-t"), ("joint-normal",) * 2],
)
def test_three_users_hold_nobody_out(model, kind, fitted):
    document, study = fitted([f"u{i % 3},p{i % 2},{i // 2 % 2}" for i in range(18)], model=model)
    assert document["model"] == study.library.performance.kind == kind
    assert document["held_out"] is None
    assert any("models were not compared" in note for note in document["notes"])


def test_who_gets_the_same_as_everybody_is_told_so(fitted):
    document, _ = fitted(["a,web,x,1", "a,web,y,0", "b,app,x,2"], "user,context,policy,outcome", types=1)
    assert document["personalised_by"] == []
    assert document["notes"][0].startswith("nothing is personalised: one type was found")
    assert "every user starts with x" in document["notes"][0]
    assert document["notes"][1] == "context changes nothing: outcomes do not differ by it"
    items, _ = fitted(["a,x,1", "a,y,0", "b,x,2"], model="joint-normal")
    assert items["personalised_by"] == ["items"]
    assert not any("nothing is personalised" in note for note in items["notes"])


def test_a_joint_normal_study_serves_a_user(fitted, memory):
    """Who likes one of two policies that go together is given the other when the first is gone."""
    random = np.random.default_rng(0)
    lines = []
    for user in range(120):
        sweet, salty = random.normal(0, 2, 2)
        for policy, liked in (("cake", sweet), ("pie", sweet), ("crisps", salty), ("nuts", salty)):
            lines.append(f"u{user},{policy},{liked + random.normal(0, 0.5):.3f}")
    document, study = fitted(lines, model="joint-normal", control=0.0, rule="greedy")
    assert document["types_found"]
    for liked, other in (("cake", "pie"), ("nuts", "crisps")):
        rest = [policy for policy in ("cake", "pie", "crisps", "nuts") if policy != liked]
        made = choose(memory, study, f"likes {liked}", available=[liked])
        update(memory, study, made["decision"], 4.0)
        assert choose(memory, study, f"likes {liked}", available=rest)["policy"] == other


@pytest.mark.parametrize(("telling", "said"), [(True, "2 types in each context"), (False, "context tells little")])
def test_contexts_say_whether_they_tell_of_types(fitted, telling, said):
    """Two types of user, as many as were asked for; the context names the type, or is drawn."""
    random = np.random.default_rng(0)
    lines = []
    for user in range(80):
        likes, drawn = user % 2, random.integers(2)
        for visit in range(8):
            outcome = 4 * (visit % 2 == likes) + random.normal()
            lines.append(f"u{user},c{likes if telling else drawn},p{visit % 2},{outcome:.2f}")
    document, _ = fitted(lines, "user,context,policy,outcome", types=2)
    assert document["notes"][0].startswith(said)


def test_contexts_have_priors_of_their_own(fitted):
    lines = [f"u{i},{'k' if i < 6 else 'l'},{'web' if i < 5 else 'app'},x,{i % 2}" for i in range(10)]
    document, study = fitted(lines, "user,type,context,policy,outcome")
    assert document["contexts"] == ["app", "web"]
    prior = np.array([7 / 12, 5 / 12])
    assert study.library.prior == pytest.approx(prior)
    # Five users of `web`, all of them k, and five of everybody's; of `app` one k and four l.
    assert study.prior_of("web") == pytest.approx((5 * prior + [5, 0]) / 10)
    assert study.prior_of("app") == pytest.approx((5 * prior + [1, 4]) / 10)
    assert study.prior_of(None) is study.library.prior


@pytest.mark.slow
def test_fitting_again_keeps_users_and_what_was_retired(fitted, memory):
    two = {"model": "gaussian", "types": 2}
    _, study = fitted(list(many(MEANS)), **two)
    made = choose(memory, study, "ann")
    retire(memory, study, "p2")
    add(memory, open_study(memory), "new")
    document, again = fitted([line for line in many(MEANS, seed=1) if ",p1," not in line], **two)
    states = {row["name"]: row["state"] for row in document["policies"]}
    # p1 is in the log no more; the new one still waits for its first outcome.
    assert states == {"p0": "active", "p1": "retired", "p2": "retired", "new": "pilot"}
    assert document["policies"][0]["mean"] is None
    assert update(memory, again, made["decision"], 1.0)["policy"] == made["policy"]
    document, _ = fitted([*many(MEANS), "u1,new,3.5"], **two)
    assert {row["name"]: row["state"] for row in document["policies"]}["new"] == "active"


def test_nothing_in_use_is_refused_and_memory_stays(fitted, memory):
    _, study = fitted(["a,x,1", "a,y,0", "b,x,0"])
    retire(memory, study, "x")
    with pytest.raises(InputError, match="the logs must hold a policy that is not retired"):
        fitted(["a,x,1", "b,x,0"])
    assert open_study(memory).active == ["y"]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (
            {"model": "magic"},
            "model must be one of auto, gaussian, student-t, categorical, joint-normal, got 'magic'",
        ),
        ({"types": 0}, "types must be at least 1, got 0"),
        ({"types": 3}, "types must be at most 2, the users of the log, got 3"),
        ({"name": "a/b"}, "name must be at most 60 characters"),
        ({"incumbent": "none"}, "incumbent must be a policy in use, got 'none'; there are x"),
        ({"rule": "none"}, "rule must be one of"),
        ({"control": 2.0}, "control must lie between 0 and 1"),
    ],
)
def test_bad_settings_keep_nothing(settings, said, fitted, memory):
    with pytest.raises((InputError, NotFoundError), match=said):
        fitted(["a,x,1", "b,x,0"], **settings)
    assert memory.keys("reuse_study") == []


def test_types_are_not_looked_for_where_they_are_named(fitted):
    with pytest.raises(InputError, match="types must be left out where the log has a column 'type'"):
        fitted(["a,k,x,1"], TYPED, types=2)


def test_one_user_one_policy_one_outcome(fitted, memory):
    document, study = fitted(["a,x,3.5"])
    assert (len(document["types"]), document["means"]) == (1, [[3.5]])
    assert choose(memory, study, "b")["policy"] == "x"


def test_a_log_of_equal_outcomes_is_told_so_and_other_outcomes_are_learnt(tmp_path):
    log = {"user": [f"u{n // 4}" for n in range(80)], "policy": ["x", "y"] * 40, "outcome": [1] * 80}
    with open_memory(tmp_path / "m.db") as memory:
        document = fit(log, memory)
        assert (
            "every outcome is 1, so the log compares no policies: does it leave failures out?" in document["notes"]
        )
        study = open_study(memory)
        made = choose(memory, study, "new")
        assert update(memory, study, made["decision"], 0.0)["taken"]
        after = choose(memory, study, "new")["expected"]
        assert after[made["policy"]] < min(outcome for name, outcome in after.items() if name != made["policy"])
