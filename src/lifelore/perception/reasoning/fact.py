"""`Fact`: a statement about a scene's objects, such as ``between(3, 2, 4)``."""

from dataclasses import dataclass

from lifelore.perception.scene import object_name


@dataclass(frozen=True, order=True)
class Fact:
    """A name and the objects it is said of, in the order the name's definition gives them.

    Examples
    --------
    >>> str(Fact("on", (3, 1)))
    'on(3, table)'
    """

    name: str
    arguments: tuple[int, ...]

    def __str__(self) -> str:
        return f"{self.name}({', '.join(map(object_name, self.arguments))})"
