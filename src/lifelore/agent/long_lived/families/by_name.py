"""The families of tasks by the names of `lifelore live --domain`, with the streams that they are lived in."""

from lifelore.agent.long_lived.task_family import TaskFamily
from lifelore.core.errors import NotFoundError
from lifelore.domains.task_stream import TaskStream

TABLETOP_TYPES = (
    "patient/firm",
    "hurried/wide",
    "cautious/slippery",
    "clearing/firm",
    "patient/slippery",
    "cautious/wide",
)
"""Hidden types of the default stream: each user and each way of gripping comes up, but not each pair."""


FAMILIES = ("tabletop", "factory-customers", "building-days")


def family_named(name: str, seed: int) -> TaskFamily:
    """The family of a name, with its default stream.

    Raises
    ------
    NotFoundError
        No family has this name.
    """
    if name not in FAMILIES:
        raise NotFoundError(f"domain must be one of {', '.join(FAMILIES)}, got {name!r}")
    # A family is imported where it is used: the tabletop's simulator is an extra.
    if name == "tabletop":
        from lifelore.agent.long_lived.families.tabletop import TabletopFamily

        return TabletopFamily(TaskStream(TABLETOP_TYPES, seed=seed), seed)
    if name == "factory-customers":
        from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
        from lifelore.domains.factory.customer_orders import CUSTOMERS

        return FactoryFamily(TaskStream(tuple(CUSTOMERS), seed=seed), seed)
    from lifelore.agent.long_lived.families.building_days import BuildingFamily
    from lifelore.domains.buildings.building_days import DAYS, BuildingDays
    from lifelore.domains.worlds import WorldSettings, world_from_settings

    world = world_from_settings(WorldSettings("building", seed=seed))
    return BuildingFamily(BuildingDays(world, TaskStream(tuple(DAYS), seed=seed), seed))
