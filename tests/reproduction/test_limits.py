"""Limits of settings: each rule by itself, and that every claim refuses what its own limits exclude."""

import copy

import pytest

from lifelore.core.errors import InputError
from reproduction.engine.claim import check_limits
from reproduction.engine.registry import claim_ids, claim_of


@pytest.mark.parametrize(
    ("value", "limit", "rule"),
    [
        (0, None, "x must be at least 1, got 0"),
        (-0.1, None, r"x must be at least 0, got -0\.1"),
        ([], None, r"x must hold at least one value, got \[\]"),
        (0, {"least": 1}, "x must be at least 1, got 0"),
        ([[1, 2], [9]], {"most": 5}, "x must be at most 5, got 9"),
        (0.0, {"above": 0}, "x must be above 0"),
        (1.0, {"below": 1}, "x must be below 1"),
        (["a", "c"], {"among": ["a", "b"]}, "x must be among a, b, got c"),
        (1, {"min": 1}, "limits of 'x' must name a setting and rules among"),
    ],
)
def test_each_rule_refuses(value, limit, rule):
    with pytest.raises(InputError, match=rule):
        check_limits({"x": value}, {"x": limit} if limit else {})


def test_a_limit_of_no_setting_is_refused():
    with pytest.raises(InputError, match="limits of 'y' must name a setting"):
        check_limits({"x": 1}, {"y": {"least": 1}})


@pytest.mark.parametrize(
    ("value", "limit"),
    [(1, None), (0.0, None), ([1, "printed"], None), (True, None), ({"a": -1}, None), (0, {"least": 0}),
     ([[0.1, 1.0], "a"], {"least": 0, "most": 1})],
)  # fmt: skip
def test_each_rule_accepts(value, limit):
    check_limits({"x": value}, {"x": limit} if limit else {})


CASES = [(claim_id, key) for claim_id in claim_ids() for key in claim_of(claim_id).settings("quick")]


@pytest.mark.parametrize(("claim_id", "key"), CASES)
def test_every_claim_refuses_settings_outside_its_limits(claim_id, key):
    claim = claim_of(claim_id)
    settings = copy.deepcopy(claim.settings("quick"))
    limit = claim.limits.get(key, {"least": 0})
    if isinstance(settings[key], (bool, dict)) or (isinstance(settings[key], str) and "among" not in limit):
        return  # any value of its type is right
    if "among" in limit:
        bad = "no such choice"
    elif "least" in limit or "above" in limit:
        bad = limit.get("least", limit.get("above")) - 1
    else:
        bad = limit.get("most", limit.get("below")) + 1
    settings[key] = [bad] if isinstance(settings[key], list) else bad
    with pytest.raises(InputError, match=key):
        check_limits(settings, claim.limits)
