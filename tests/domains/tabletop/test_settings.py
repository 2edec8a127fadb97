"""Settings of the tabletop, and the relation that each pair of a row is to show."""

import pytest

from lifelore.core.errors import InputError
from lifelore.core.relations import CORE_RELATIONS
from lifelore.domains.tabletop.settings import TabletopSettings, wanted_relation

THESIS = {"on": 70, "adjacent": 32, "both": 30}


@pytest.mark.parametrize("n", [1, 7, 40, 100])
def test_every_beginning_is_near_the_mix(n):
    wanted = [wanted_relation(i, THESIS) for i in range(n)]
    assert all(
        abs(wanted.count(relation) - THESIS.get(relation, 0) / 132 * n) < 1.5 for relation in CORE_RELATIONS
    )


@pytest.mark.parametrize(
    ("settings", "match"),
    [
        ({"n_objects": (3, 2)}, "n_objects must be"),
        ({"camera": "eye"}, "camera must be"),
        ({"arrangement": "pair", "mix": {"under": 1}}, "mix names"),
        ({"arrangement": "pair", "mix": {"on": 0}}, "at least one relation"),
        ({"mix": {"on": 1}}, "mix applies to arrangement pair, got 'mixed'; leave it out"),
    ],
)
def test_mistaken_settings_are_refused(settings, match):
    with pytest.raises(InputError, match=match):
        TabletopSettings(**settings)
