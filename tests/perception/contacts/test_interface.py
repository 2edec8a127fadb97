"""Interfaces of blocks whose contacts are known; networks that stay when points are thrown away."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.contacts import interface as module
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import interfaces


def shell(low, high, step=0.004) -> np.ndarray:
    """The surface of a box as a grid of points."""
    axes = [np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    on_face = ((points == np.array(low)) | (points == np.array(high))).any(axis=1)
    return points[on_face]


def scene(*boxes, table: bool = True) -> LabelledCloud:
    parts = [shell(low, high) for low, high in boxes]
    labels = [np.full(len(part), number + 2) for number, part in enumerate(parts)]
    if table:
        parts.append(shell((-0.2, -0.2, -0.001), (0.4, 0.3, -0.001), 0.006))
        labels.append(np.full(len(parts[-1]), TABLE))
    return LabelledCloud(np.vstack(parts), np.concatenate(labels).astype(np.int64))


STACK = (((0, 0, 0), (0.08, 0.08, 0.05)), ((0.02, 0.02, 0.052), (0.06, 0.06, 0.1)))


def test_a_stack_has_a_level_contact_between_its_blocks():
    found = interfaces(scene(*STACK))
    assert [(one.a, one.b) for one in found] == [(2, 3), (2, TABLE), (3, TABLE)]
    between = found[0]
    assert 0.001 < between.gap < 0.004
    upper, lower = between.contacts_b[0], between.contacts_a[0]
    assert upper.other == 2
    assert lower.other == 3
    np.testing.assert_allclose(upper.position, [0.04, 0.04, 0.052], atol=0.004)
    np.testing.assert_allclose(lower.position, [0.04, 0.04, 0.05], atol=0.004)
    assert upper.normal[2] > 0.95
    np.testing.assert_allclose(upper.normal, -lower.normal, atol=0.1)
    assert between.contact_edges.tolist() == [[0, 0]]
    for dipole in between.dipoles:
        assert (dipole.first - dipole.second)[2] < 0
        assert dipole.normal[2] < -0.95


def test_a_bridge_stands_on_two_contacts_of_its_own():
    legs = ((0, 0, 0), (0.04, 0.06, 0.06)), ((0.16, 0, 0), (0.2, 0.06, 0.06))
    plank = (0, 0, 0.062), (0.2, 0.06, 0.07)
    by_pair = {(one.a, one.b): one for one in interfaces(scene(*legs, plank, table=False))}
    assert set(by_pair) == {(2, 4), (3, 4)}
    assert by_pair[2, 4].contacts_b[0].position[0] < 0.06
    assert by_pair[3, 4].contacts_b[0].position[0] > 0.14


def test_an_arch_has_two_contacts_with_what_it_stands_on():
    feet = np.vstack([shell((0, 0, 0.012), (0.03, 0.06, 0.06)), shell((0.17, 0, 0.012), (0.2, 0.06, 0.06))])
    arch = np.vstack([feet, shell((0, 0, 0.06), (0.2, 0.06, 0.08))])
    slab = shell((-0.02, -0.02, 0), (0.22, 0.08, 0.01))
    cloud = LabelledCloud(np.vstack([slab, arch]), np.repeat([2, 3], [len(slab), len(arch)]))
    (one,) = interfaces(cloud)
    assert len(one.contacts_b) == 2
    assert len(one.contact_edges) >= 2
    assert set(one.contact_edges[:, 1].tolist()) == {0, 1}
    assert sorted(round(float(c.position[0]), 1) for c in one.contacts_b) == [0.0, 0.2]


def test_the_same_points_give_the_same_bits_and_most_may_go():
    cloud = scene(*STACK)
    first, again = interfaces(cloud), interfaces(cloud)
    for one, other in zip(first, again, strict=True):
        assert one.gap == other.gap
        for ours, theirs in zip(one.contacts_a, other.contacts_a, strict=True):
            np.testing.assert_array_equal(ours.position, theirs.position)
    kept = np.random.default_rng(1).random(len(cloud.points)) < 0.5
    (fewer,) = interfaces(LabelledCloud(cloud.points[kept], cloud.labels[kept]))[:1]
    assert len(fewer.contacts_b) == len(first[0].contacts_b)
    np.testing.assert_allclose(fewer.contacts_b[0].position, first[0].contacts_b[0].position, atol=0.005)


def test_nothing_to_find_is_found_without_complaint():
    assert interfaces(LabelledCloud(np.empty((0, 3)), np.empty(0, np.int64))) == ()
    assert interfaces(scene(STACK[0], table=False)) == ()
    same = LabelledCloud(np.zeros((6, 3)), np.array([2, 2, 2, 3, 3, 3]))
    (one,) = interfaces(same)
    assert one.gap == 0.0
    assert len(one.contacts_a) == 1


@pytest.mark.parametrize(
    "wrong", [{"voxel": -1.0}, {"near": 0.0}, {"length": float("nan")}, {"min_support": -1.0}]
)
def test_settings_out_of_range_are_named(wrong):
    (name,) = wrong
    with pytest.raises(InputError, match=name):
        ContactSettings(**wrong)


def test_mixed_up_labels_are_reported_and_blocks_side_by_side_are_not(monkeypatch):

    assert all(one.max_violation <= 1e-3 for one in interfaces(scene(*STACK)))
    rng = np.random.default_rng(0)
    cloud = LabelledCloud(rng.uniform(0, 0.2, (2400, 3)), rng.integers(2, 5, 2400))
    monkeypatch.setattr(module, "MOST_WORK", 1.0)
    found = interfaces(cloud)
    assert [one.max_violation > 1e-3 for one in found] == [True] * 3
    for one, again in zip(found, interfaces(cloud), strict=True):
        assert len(one.contacts_a) >= 1
        assert one.max_violation == again.max_violation
        np.testing.assert_array_equal(one.contacts_a[0].position, again.contacts_a[0].position)


@pytest.mark.parametrize(("voxel", "factor"), [(0.006, 4.0), (0.0015, 0.25), (0.0, 1.0)])
def test_costs_are_stated_at_three_millimetres(monkeypatch, voxel, factor):
    costs, plain = [], module.separate

    def noted(*clouds, cost, **rest):
        costs.append(cost)
        return plain(*clouds, cost=cost, **rest)

    monkeypatch.setattr(module, "separate", noted)
    interfaces(scene(*STACK, table=False), ContactSettings(voxel=voxel, cost=8.0, wide_cost=2.0))
    assert costs == [8.0 * factor, 2.0 * factor]
