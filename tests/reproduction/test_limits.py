"""Limits of settings: each rule by itself, and that every claim refuses what its own limits exclude."""

import copy

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.engine.limits import check_limits
from reproduction.engine.registry import built_ids, claim_of


@pytest.mark.parametrize(
    ("settings", "limit", "rule"),
    [
        ({"x": 0}, {"least": 1}, "x must be at least 1, got 0"),
        ({"x": [3, 9]}, {"most": "y"}, r"x must be at most y \(5\), got \[3, 9\]"),
        ({"x": 0.0}, {"above": 0}, "x must be above 0"),
        ({"x": 1.0}, {"below": 1}, "x must be below 1"),
        ({"x": []}, {"least": 1}, "x must hold at least one number"),
        ({"x": ["a", "c"]}, {"among": ["a", "b"]}, "x must be among a, b, got c"),
        ({"x": []}, {"among": ["a", "b"]}, "x must be among a, b, got none"),
        ({"x": [[1, 2], [3]]}, {"shape": [2], "each": True}, r"x must be 2 numbers each, got \[3\]"),
        (
            {"x": {"tie": "no"}, "ties": ["a"]},
            {"default": {"tie": "ties"}},
            "x must be a cell of the grid; its tie",
        ),
        ({}, {"least": 1}, "limits of 'x' must name a setting"),
        ({"x": 1}, {"min": 1}, "limits of 'x' must name a setting and rules among"),
    ],
)
def test_each_rule_refuses(settings, limit, rule):
    with pytest.raises(InputError, match=rule):
        check_limits({"y": 5, **settings}, {"x": limit})


@pytest.mark.parametrize(
    ("settings", "limit"),
    [
        ({"x": [1, 5]}, {"least": 1, "most": "y"}),
        ({"x": [[0.1, 1.0, 0.1]]}, {"shape": [3], "each": True, "least": 0, "most": 1}),
        ({"x": "a"}, {"among": ["a"]}),
        ({"x": {"tie": "a"}, "ties": ["a"]}, {"default": {"tie": "ties"}}),
        ({"x": []}, {"least": 1, "empty": True}),
    ],
)
def test_each_rule_accepts(settings, limit):
    check_limits({"y": 5, **settings}, {"x": limit})


def outside(settings, key, rule, value):
    """A value of setting `key` that breaks one rule, of the type that the setting has."""
    old = settings[key]
    if rule in ("least", "most", "above", "below"):
        bound = settings[value] if isinstance(value, str) else value
        step = {"least": -1, "most": 1, "above": 0, "below": 0}[rule]
        bad = bound + step
        bad = type(np.ravel(old)[0].item())(bad)
        return nested_like(old, bad)
    if rule == "among":
        return "no such choice" if isinstance(old, str) else [*old, "no such choice"]
    if rule == "shape":
        return [*old, [0.5] * (value[0] + 1)] if settings.get(key) and isinstance(old[0], list) else [*old, 0.5]
    return {**old, next(iter(value)): "no such choice"}


def nested_like(old, bad):
    if not isinstance(old, list):
        return bad
    return [nested_like(old[0], bad), *old[1:]]


CASES = [
    (claim_id, key, rule)
    for claim_id in built_ids()
    for key, limit in claim_of(claim_id).limits.items()
    for rule in limit
    if rule not in ("each", "empty")
]


@pytest.mark.parametrize(("claim_id", "key", "rule"), CASES)
def test_every_claim_refuses_settings_outside_its_limits(claim_id, key, rule):
    claim = claim_of(claim_id)
    settings = copy.deepcopy(claim.settings("quick"))
    settings[key] = outside(settings, key, rule, claim.limits[key][rule])
    with pytest.raises(InputError, match=key):
        check_limits(settings, {key: claim.limits[key]})
