"""`LifeSettings` from names alone, as the command line has them, so that a test changes a setting in one word."""

from typing import Any

from lifelore.agent.live.life_settings import LifeSettings, life_settings


def flat_settings(**flat: Any) -> LifeSettings:
    """Settings of a life in the lattice unless `flat` names another domain."""
    return life_settings({"domain": "lattice"} | flat)
