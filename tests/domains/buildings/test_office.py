"""Invented offices: connected, of the promised size, and really different from seed to seed."""

import numpy as np
import pytest
from scipy import ndimage

from lifelore.core.errors import InputError
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.inflation import inflate
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED
from lifelore.domains.buildings.office import RESOLUTION, office_map
from lifelore.domains.buildings.office_plan import plan_office

SEEDS = range(24)


@pytest.fixture(scope="module", params=SEEDS)
def office(request):
    return office_map(request.param)


@pytest.mark.parametrize("radius", [0.2, 0.3])
def test_free_space_is_one_region(office, radius):
    free = (office.state == FREE) & ~inflate(office.state == OCCUPIED, radius / RESOLUTION)
    sizes = np.bincount(ndimage.label(free)[0].ravel())[1:]
    # What is cut off are nooks behind furniture, less than the smallest room (2.4 m × 4.4 m of some 500 m²).
    assert sizes.max() / sizes.sum() > 0.99


@pytest.mark.slow
def test_seeds_are_different_buildings():
    free = [office_map(seed).state == FREE for seed in range(8)]
    overlaps = [(a & b).sum() / (a | b).sum() for i, a in enumerate(free) for b in free[:i]]
    assert max(overlaps) < 0.93
    prints = {building_from_map(office_map(seed)).fingerprint for seed in range(8)}
    assert len(prints) == 8


def contains(outer, inner) -> bool:
    slack = 1e-6
    low = outer.x0 <= inner.x0 + slack and outer.y0 <= inner.y0 + slack
    return low and outer.x1 >= inner.x1 - slack and outer.y1 >= inner.y1 - slack


@pytest.mark.parametrize("seed", range(40))
def test_every_room_has_a_door_of_90_cm_onto_a_corridor(seed):
    plan = plan_office(np.random.default_rng(seed), 32.0, 22.0)
    kinds = set()
    for room in plan.rooms:
        kinds.add(room.kind)
        if room.kind == "shaft":
            continue
        length, _ = room.rect.seen_from(room.side)
        assert room.doors
        for u0, u1 in room.doors:
            assert u1 - u0 >= 0.9 - 1e-9
            assert 0 < u0 < u1 < length
            outside = room.rect.part(room.side, u0, -0.2, u1, -0.1)
            assert any(contains(corridor, outside) for corridor in plan.corridors)
    assert len(kinds) >= 3


@pytest.mark.parametrize(("width", "height"), [(12.0, 12.0), (12.0, 60.0), (80.0, 50.0), (23.4, 18.7)])
def test_other_sizes(width, height):
    for seed in range(4):
        office = office_map(seed, width, height)
        free = (office.state == FREE) & ~inflate(office.state == OCCUPIED, 0.2 / RESOLUTION)
        sizes = np.bincount(ndimage.label(free)[0].ravel())[1:]
        assert sizes.max() / sizes.sum() > 0.98


@pytest.mark.parametrize("length", [float("nan"), 11.9, -3.0, 1e9])
def test_absurd_sizes_are_refused(length):
    with pytest.raises(InputError, match="width_m must lie in"):
        office_map(0, width_m=length)
    with pytest.raises(InputError, match="height_m must lie in"):
        office_map(0, height_m=length)
