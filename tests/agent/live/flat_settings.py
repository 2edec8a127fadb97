"""`LifeSettings` from names alone, as the command line has them, so that a test changes a setting in one word."""

from typing import Any

from lifelore.agent.live.life_settings import (
    LearningSettings,
    LifeSettings,
    MemorySettings,
    PriorSettings,
    SensorSettings,
)
from lifelore.domains.worlds import WorldSettings

LEARNING = ("learner", "episodes", "max_steps", "learning_rate", "epsilon", "epsilon_decay", "epsilon_floor")
LIFE = ("agent", "tasks", "destinations", "start", "jobs", "goal", "goals", "watch")


def flat_settings(**flat: Any) -> LifeSettings:
    """Settings of a life in the lattice unless `flat` names another domain."""

    def taken(*names: str) -> dict[str, Any]:
        return {name: flat.pop(name) for name in names if name in flat}

    learning, life = LearningSettings(**taken(*LEARNING)), taken(*LIFE)
    condition = {"condition": flat.pop("prior")} if "prior" in flat else {}
    prior = PriorSettings(**condition, **taken("alpha0", "weight", "form", "ties"))
    location = {"location": flat.pop("memory")} if "memory" in flat else {}
    memory = MemorySettings(**location, **taken("robot", "refresh"))
    kind = {"kind": flat.pop("sensor")} if "sensor" in flat else {}
    life["sensor"] = SensorSettings(**kind, **taken("range"))
    return LifeSettings(WorldSettings(**{"domain": "lattice"} | flat), learning, prior, memory, **life)
