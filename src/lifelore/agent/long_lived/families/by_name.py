"""The families of tasks by the names of `lifelore live --domain`, with the streams that they are lived in."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

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


def _tabletop(seed: int, labelled: bool) -> TaskFamily:
    from lifelore.agent.long_lived.families.tabletop import TabletopFamily

    return TabletopFamily(TaskStream(TABLETOP_TYPES, seed=seed), seed, labelled)


FAMILIES: Mapping[str, Callable[[int, bool], TaskFamily]] = MappingProxyType({"tabletop": _tabletop})
"""Name to a function of seed and `labelled`."""


def family_named(name: str, seed: int, *, labelled: bool = False) -> TaskFamily:
    """The family of a name, with its default stream.

    Raises
    ------
    NotFoundError
        No family has this name.
    """
    if name not in FAMILIES:
        raise NotFoundError(f"domain must be one of {', '.join(FAMILIES)}, got {name!r}")
    return FAMILIES[name](seed, labelled)
