"""The families of tasks by the names of `lifelore live --domain`, with the streams that they are lived in."""

from lifelore.agent.long_lived.task_family import TaskFamily
from lifelore.core.errors import InputError, NotFoundError
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
CHANGING = ("factory-customers",)
"""Families whose hidden type may change between the episodes of a task."""


def family_named(name: str, seed: int, *, labelled: bool = False, change: float = 0.0) -> TaskFamily:
    """The family of a name, with its default stream.

    Parameters
    ----------
    labelled : bool
        See `TabletopFamily`.
    change : float
        Probability that the hidden type changes between two episodes of a task, in [0, 1); above 0 only for the
        families of `CHANGING`.

    Raises
    ------
    NotFoundError
        No family has this name.
    InputError
        The family's types stay within a task, but `change` is above 0.
    """
    if name not in FAMILIES:
        raise NotFoundError(f"domain must be one of {', '.join(FAMILIES)}, got {name!r}")
    if change and name not in CHANGING:
        raise InputError(
            f"change must be 0 in domain {name}, whose types stay within a task, got {change}; leave it out, or "
            f"take domain {' or '.join(CHANGING)}"
        )
    # A family is imported where it is used: the tabletop's simulator is an extra.
    if name == "tabletop":
        from lifelore.agent.long_lived.families.tabletop import TabletopFamily

        return TabletopFamily(TaskStream(TABLETOP_TYPES, seed=seed), seed, labelled)
    if name == "factory-customers":
        from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
        from lifelore.domains.factory.customer_orders import CUSTOMERS

        return FactoryFamily(TaskStream(tuple(CUSTOMERS), seed=seed, change=change), seed, changing=change > 0)
    from lifelore.agent.long_lived.families.building_days import BuildingFamily
    from lifelore.domains.buildings.building_days import DAYS, BuildingDays
    from lifelore.domains.worlds import WorldSettings, world_from_settings

    world = world_from_settings(WorldSettings("building", seed=seed))
    return BuildingFamily(BuildingDays(world, TaskStream(tuple(DAYS), seed=seed), seed))
