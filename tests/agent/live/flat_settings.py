"""`LifeSettings` from names alone, as the command line has them, so that a test changes a setting in one word."""

from typing import Any

from lifelore.agent.live.life_settings import LifeSettings
from lifelore.app.live_command import OPTIONS, setting_keys


def flat_settings(**flat: Any) -> LifeSettings:
    """Settings of a life in the lattice unless `flat` names another domain."""
    keys = setting_keys("lattice")
    assert flat.keys() <= {*OPTIONS, *keys.settings}
    return LifeSettings(**keys.arguments({"domain": "lattice"} | flat))
