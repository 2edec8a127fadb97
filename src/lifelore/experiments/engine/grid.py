"""The grid of choices that the thesis leaves open, and its runner: every method in every cell.

A cell is a mapping of the same keys, such as schedule, ties and α⁰; one cell is the stated default. Learners
without a prior read only some keys, so that each of their cells is run once.
"""

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

Cell = dict[str, Any]
READ_WITHOUT_PRIOR = ("schedule", "max_steps")
"""Keys that learners without a prior read."""


@dataclass(frozen=True)
class Grid:
    """The cells of a grid.

    Parameters
    ----------
    default : mapping
        The stated default; its keys are the keys of every cell.
    cells : tuple of mapping
        All cells, the default among them.
    """

    default: Mapping[str, Any]
    cells: tuple[Cell, ...]

    @classmethod
    def crossed(
        cls,
        settings: Mapping[str, Any],
        keys: Sequence[str],
        crossed: Mapping[str, str],
        singly: Mapping[str, str] | None = None,
    ) -> "Grid":
        """A grid from a claim's settings.

        Parameters
        ----------
        settings : mapping
            Has ``default``, and for each key a list of choices.
        keys : sequence of str
            The keys of a cell, in order.
        crossed : mapping
            Key → name of the setting with its choices; all combinations, the last key fastest.
        singly : mapping, optional
            The same for keys that leave the default one at a time.
        """
        default = {key: settings["default"][key] for key in keys}
        combinations = product(*(settings[setting] for setting in crossed.values()))
        cells = [{**default, **dict(zip(crossed, values, strict=True))} for values in combinations]
        for key, setting in (singly or {}).items():
            cells += [{**default, key: value} for value in settings[setting] if value != default[key]]
        return cls(default, tuple(cells))

    def key(self, cell: Mapping[str, Any]) -> tuple[Hashable, ...]:
        """A cell as something that can be looked up."""
        return tuple(tuple(cell[key]) if isinstance(cell[key], list) else cell[key] for key in self.default)

    def without_prior(self, cell: Mapping[str, Any]) -> Cell:
        """A cell as learners without a prior meet it: the choices that they do not read are None."""
        return {key: cell[key] if key in READ_WITHOUT_PRIOR else None for key in self.default}

    def cells_without_prior(self) -> list[Cell]:
        """The cells that learners without a prior meet, each once."""
        return list({self.key(c): c for c in map(self.without_prior, self.cells)}.values())

    def with_schedule(self, schedule: Sequence[float]) -> Cell:
        """The default under another schedule."""
        return {**self.default, "schedule": schedule}

    def is_default_but_for_schedule(self, cell: Mapping[str, Any]) -> bool:
        """Whether a cell is the default under any schedule, or what learners without a prior meet there."""
        default = self.with_schedule(cell["schedule"])
        return self.key(cell) in (self.key(default), self.key(self.without_prior(default)))


def run_grid(
    grid: Grid,
    label: str,
    without_prior: str,
    methods: Sequence[str],
    numbers: Callable[[str, Cell], Mapping[str, Any]],
) -> Iterator[dict[str, Any]]:
    """The records of a grid: the learner without a prior in its cells, then each method in each cell.

    Parameters
    ----------
    grid : Grid
    label : str
        The key under which a record names its method.
    without_prior : str
        The name of the learner without a prior.
    methods : sequence of str
    numbers : callable
        ``numbers(method, cell)``: what is measured, a plain mapping.
    """
    for cell in grid.cells_without_prior():
        yield {label: without_prior, **cell, **numbers(without_prior, cell)}
    for cell in grid.cells:
        for method in methods:
            yield {label: method, **cell, **numbers(method, cell)}
