"""Traffic of a study counted by hand, in both back ends, and each alarm where it should be and where not."""

from collections import defaultdict
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from lifelore.agent.personalise import decisions, traffic
from lifelore.agent.personalise.explanation import explain, novelty_of
from lifelore.agent.personalise.study import Study
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.unknown_users import MASS
from lifelore.memory import Memory

DAY, HOUR = traffic.DAY, traffic.HOUR
NOW = 20_000 * DAY + 5 * HOUR
MEANS = [[8.0, 2.0], [3.0, 9.0]]


def registered(memory: Memory, control: float = 0.3, name: str = "s") -> Study:
    library = PolicyLibrary.from_means(MEANS, 1.0, policies=["x", "y"])
    return Study(name, library, {"x": "active", "y": "active"}, control=control, rule="sampling").keep(memory)


def live(memory, study, monkeypatch, days=14, users=40, lost=0.0, change=0.0, outcome=None):
    """Each user comes every third day; (time, user, policy, control, outcome) of all decisions."""
    generator, lines = np.random.default_rng(0), []
    for day in range(days):
        at = NOW - (days - day) * DAY + 10 * HOUR
        monkeypatch.setattr(decisions, "time", SimpleNamespace(time_ns=lambda at=at: at * 10**6))
        names = [f"u{user}" for user in range(users) if user % 3 == day % 3]
        answers = decisions.decide(memory, study, [decisions.Request(name) for name in names])
        ended = []
        for name, one in zip(names, answers, strict=True):
            value = None
            if generator.random() >= lost:
                mean = MEANS[int(name[1:]) % 2]["xy".index(one["policy"])] + (change if day >= days / 2 else 0.0)
                value = float(generator.normal(mean, 1.0)) if outcome is None else outcome
                ended.append((one["decision"], value))
            lines.append((at, name, one["policy"], one["control"], value))
        decisions.observe(memory, study, ended)
    return lines


def test_counts_are_those_of_a_plain_loop(memory, monkeypatch):
    study, other = registered(memory), registered(memory, name="other")
    lines = live(memory, study, monkeypatch, days=20, lost=0.05)
    live(memory, other, monkeypatch, days=3)
    found = traffic.traffic(memory, study, 14, NOW)
    assert (found["until"], found["until"] - found["since"], found["step"]) == (
        20_001 * 86_400,
        14 * 86_400,
        86_400,
    )
    seen, policies, late = defaultdict(list), defaultdict(int), [0, 0]
    for at, _, policy, control, value in lines:
        if at >= 1000 * found["since"]:
            seen[at // DAY * 86_400, "control" if control else "personal"].append(value)
            policies[policy] += 1
            if (at // DAY + 1) * DAY <= NOW - DAY:
                late[0] += 1
                late[1] += value is None
    for point in found["points"]:
        for group in ("personal", "control"):
            values = seen[point["time"], group]
            ended = [value for value in values if value is not None]
            assert point[group]["decisions"] == len(values)
            assert point[group]["outcomes"] == len(ended)
            assert point[group]["sum"] == pytest.approx(sum(ended))
    n = sum(policies.values())
    assert n < len(lines)
    assert [(one["name"], one["share"]) for one in found["policies"]] == [(p, policies[p] / n) for p in ("x", "y")]
    assert [one["expected"] for one in found["policies"]] == [5.5, 5.5]
    assert (found["missing"]["decisions"], found["missing"]["missing"]) == tuple(late)
    middle = 1000 * (found["since"] + found["until"]) // 2
    for control, group in enumerate(("personal", "control")):
        halves = ({}, {})
        for at, name, _, held, value in lines:
            if at >= 1000 * found["since"] and held == control and value is not None:
                halves[at >= middle].setdefault(name, []).append(value)
        before, after = ([np.mean(own) for own in half.values()] for half in halves)
        welch = stats.ttest_ind(after, before, equal_var=False).confidence_interval()
        assert found["drift"][group]["value"] == pytest.approx(np.mean(after) - np.mean(before))
        assert found["drift"][group]["ci95"] == pytest.approx([welch.low, welch.high])


def test_two_days_come_by_hour(file_memory, monkeypatch):
    study = registered(file_memory)
    lines = live(file_memory, study, monkeypatch, days=1)
    found = traffic.traffic(file_memory, study, 2, NOW)
    shown = [point for point in found["points"] if point["personal"]["decisions"]]
    assert len(found["points"]) == 48
    assert [point["time"] for point in shown] == [lines[0][0] // HOUR * 3600]


def test_beliefs_are_those_of_each_user_alone(file_memory, monkeypatch):
    study = registered(file_memory)
    live(file_memory, study, monkeypatch, users=12, outcome=40.0)  # no type brings 40
    found = traffic.traffic(file_memory, study, 14, NOW)
    names = [f"u{user}" for user in range(12)]
    shares = [list(explain(file_memory, study, name)["belief"].values()) for name in names]
    entropy = [-sum(share * np.log(share) for share in own if share > 0) for own in shares]
    assert found["beliefs"]["users"] == 12
    assert found["beliefs"]["entropy"] == pytest.approx(np.mean(entropy))
    assert (
        found["beliefs"]["unknown"]
        == np.mean([novelty_of(file_memory, study, name) > 0.5 for name in names])
        == 1.0
    )
    assert [alarm["kind"] for alarm in found["alarms"]] == ["beliefs"]
    assert 0 < MASS < 0.5


def test_each_alarm_is_raised_alone(file_memory, monkeypatch):
    study = registered(file_memory)
    live(file_memory, study, monkeypatch, users=60)
    assert traffic.traffic(file_memory, study, 14, NOW)["alarms"] == []
    lossy = registered(file_memory, name="lossy")
    live(file_memory, lossy, monkeypatch, users=60, lost=0.3)
    assert [one["kind"] for one in traffic.traffic(file_memory, lossy, 14, NOW)["alarms"]] == ["missing"]
    worse = registered(file_memory, name="worse")
    live(file_memory, worse, monkeypatch, users=60, change=-3.0)
    alarms = [one for one in traffic.traffic(file_memory, worse, 14, NOW)["alarms"] if one["kind"] == "drift"]
    assert [("personal" in one["message"], "control" in one["message"]) for one in alarms] == [
        (True, False),
        (False, True),
    ]


def test_a_control_group_of_the_wrong_size_is_noticed(file_memory, monkeypatch):
    """The group is drawn with 0.3 and the study says 0.6 without another version: as if half of it were lost."""
    from dataclasses import replace

    study = registered(file_memory)
    lines = live(file_memory, study, monkeypatch, users=60)
    held = len({name for _, name, _, control, _ in lines if control})
    found = traffic.traffic(file_memory, replace(study, control=0.6), 14, NOW)
    assert (found["ratio"]["users"], found["ratio"]["control"]) == (60, held)
    assert found["alarms"][0]["kind"] == "ratio"
    assert traffic.traffic(file_memory, replace(study, version=study.version + 1), 14, NOW)["ratio"] is None


@pytest.mark.parametrize(
    ("control", "users", "share"), [(50, 500, 0.1), (70, 500, 0.1), (20, 500, 0.1), (5, 10, 0.5)]
)
def test_the_p_value_is_pearsons(control, users, share):
    expected = [users * share, users * (1 - share)]
    assert traffic.ratio_p(control, users, share) == pytest.approx(
        stats.chisquare([control, users - control], expected).pvalue
    )


def test_few_users_and_no_control_group_have_no_p_value():
    assert traffic.ratio_p(3, 40, 0.1) is None
    assert traffic.ratio_p(0, 1000, 0.0) is None


def test_a_study_without_decisions_has_nothing_to_test(memory):
    found = traffic.traffic(memory, registered(memory), 14, NOW)
    assert found["ratio"] is found["missing"] is found["beliefs"] is found["drift"]["control"] is None
    assert found["alarms"] == []
    assert [one["share"] for one in found["policies"]] == [None, None]


def test_a_part_of_the_users_stands_for_all(file_memory, monkeypatch):
    study = registered(file_memory)
    live(file_memory, study, monkeypatch)
    whole = traffic.traffic(file_memory, study, 14, NOW)
    monkeypatch.setattr(traffic, "MOST", 60)  # 187 decisions: every third user
    part = traffic.traffic(file_memory, study, 14, NOW)
    assert part["points"] == whole["points"]
    assert part["beliefs"]["users"] in (13, 14)
