"""Cells that are lots of scenes: simulated scenes by number, real scenes by name; and their pictures."""

from collections.abc import Mapping, Sequence

from reproduction.chapter2.scenes.real_scenes import real_scenes, real_scenes_folder


def lots(n: int, size: int, **head) -> list[dict]:
    """A cell ``{**head, "first": k}`` for every `size` of `n` simulated scenes."""
    return [{**head, "first": first} for first in range(0, n, size)]


def numbers_of(cell: Mapping, size: int, n: int) -> range:
    """The numbers of a lot's scenes."""
    return range(cell["first"], min(cell["first"] + size, n))


def uses_real(settings: Mapping) -> bool:
    """Whether the settings ask for the real scenes and they are there."""
    return settings.get("real", False) and real_scenes_folder() is not None


def real_lots(settings: Mapping, size: int, key: str) -> list[dict]:
    """A cell ``{key: names}`` for every `size` of the real scenes, if the settings use them."""
    names = [scene.name for scene in real_scenes()] if uses_real(settings) else []
    return [{key: names[first : first + size]} for first in range(0, len(names), size)]


def example_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The function ``rows`` of a claim that stores pictures alone: those of all results."""
    return [example for result in results for example in result["examples"]]
