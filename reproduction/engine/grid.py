"""The grid of choices that the thesis leaves open, and its runner: every method in every cell.

A cell is a mapping of the same keys, such as schedule, ties and α⁰; one cell is the stated default. A method
meets a cell without the choices that it does not read (they are None), so that it runs each such cell once.
"""

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

Cell = dict[str, Any]


def combinations(settings: Mapping[str, Sequence], keys: Sequence[str]) -> list[Cell]:
    """Every combination of the settings' choices, the last key fastest; the first of them is the default."""
    return [dict(zip(keys, values, strict=True)) for values in product(*(settings[key] for key in keys))]


@dataclass(frozen=True)
class Grid:
    """The cells of a grid.

    Parameters
    ----------
    default : mapping
        The stated default; its keys are the keys of every cell.
    cells : tuple of mapping
        All cells, the default among them.
    reads : mapping, optional
        Method → the keys that it reads; a method that is not named here reads all.

    Examples
    --------
    >>> settings = {"ties": ["uniform", "prior"], "schedule": [1, 2]}
    >>> grid = Grid.crossed(settings, ("ties", "schedule"), reads={"none": ("schedule",)})
    >>> len(grid.cells), grid.where("none", grid.default)
    (4, {'method': 'none', 'ties': None, 'schedule': 1})
    >>> len(list(run_grid(grid, ["none", "prior"], lambda method, cell: {})))
    6
    """

    default: Mapping[str, Any]
    cells: tuple[Cell, ...]
    reads: Mapping[str, Sequence[str]] = field(default_factory=dict)

    @classmethod
    def crossed(
        cls,
        settings: Mapping[str, Sequence],
        crossed: Sequence[str],
        singly: Sequence[str] = (),
        reads: Mapping[str, Sequence[str]] | None = None,
    ) -> "Grid":
        """All combinations of the choices `crossed`, the last key fastest, then every other one of `singly` alone.

        Each key is a setting with a list of choices, the first of them the default. `reads`: see the class.
        """
        default = {key: settings[key][0] for key in (*crossed, *singly)}
        cells = [{**default, **values} for values in combinations(settings, crossed)]
        cells += [{**default, key: value} for key in singly for value in settings[key][1:]]
        return cls(default, tuple(cells), reads or {})

    def key(self, cell: Mapping[str, Any]) -> tuple[Hashable, ...]:
        """A cell as something that can be looked up."""
        return tuple(tuple(cell[key]) if isinstance(cell[key], list) else cell[key] for key in self.default)

    def met_by(self, method: str, cell: Mapping[str, Any]) -> Cell:
        """A cell as a method meets it: the choices that the method does not read are None."""
        read = self.reads.get(method, self.default)
        return {key: cell[key] if key in read else None for key in self.default}

    def where(self, method: str, cell: Mapping[str, Any]) -> Cell:
        """The keys of the method's records in a cell, for selections of `records`."""
        return {"method": method, **self.met_by(method, cell)}

    def cells_of(self, method: str) -> list[Cell]:
        """The cells that a method meets, each once."""
        met = (self.met_by(method, cell) for cell in self.cells)
        return list({self.key(cell): cell for cell in met}.values())


def run_grid(
    grid: Grid, methods: Sequence[str], numbers: Callable[[str, Cell], Mapping[str, Any]]
) -> Iterator[dict[str, Any]]:
    """The records of each method in each cell it meets; ``numbers(method, cell)`` is what is measured there."""
    for method in methods:
        for cell in grid.cells_of(method):
            yield {"method": method, **cell, **numbers(method, cell)}
