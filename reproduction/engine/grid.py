"""The grid of choices that the thesis leaves open, and its runner: every method in every cell.

A cell is a mapping of the same keys, such as schedule, ties and α⁰; one cell is the stated default. A method
meets a cell without the choices that it does not read (they are None), so that it runs each such cell once.
"""

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
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
    reads : mapping, optional
        Method → the keys that it reads; a method that is not named here reads all.

    Examples
    --------
    >>> grid = Grid.crossed(
    ...     {"default": {"ties": "uniform", "schedule": 1}, "ties": ["uniform", "prior"], "schedules": [1, 2]},
    ...     ("ties", "schedule"), {"ties": "ties", "schedule": "schedules"}, reads={"none": ("schedule",)},
    ... )
    >>> len(grid.cells), grid.where("none", grid.default)
    (4, {'method': 'none', 'ties': None, 'schedule': 1})
    >>> len(list(run_grid(grid, "method", "none", ["prior"], lambda method, cell: {})))
    6
    """

    default: Mapping[str, Any]
    cells: tuple[Cell, ...]
    reads: Mapping[str, Sequence[str]] = field(default_factory=dict)

    @classmethod
    def crossed(
        cls,
        settings: Mapping[str, Any],
        keys: Sequence[str],
        crossed: Mapping[str, str],
        singly: Mapping[str, str] | None = None,
        reads: Mapping[str, Sequence[str]] | None = None,
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
        reads : mapping, optional
            See the class.
        """
        default = {key: settings["default"][key] for key in keys}
        combinations = product(*(settings[setting] for setting in crossed.values()))
        cells = [{**default, **dict(zip(crossed, values, strict=True))} for values in combinations]
        for key, setting in (singly or {}).items():
            cells += [{**default, key: value} for value in settings[setting] if value != default[key]]
        return cls(default, tuple(cells), reads or {})

    def key(self, cell: Mapping[str, Any]) -> tuple[Hashable, ...]:
        """A cell as something that can be looked up."""
        return tuple(tuple(cell[key]) if isinstance(cell[key], list) else cell[key] for key in self.default)

    def met_by(self, method: str, cell: Mapping[str, Any]) -> Cell:
        """A cell as a method meets it: the choices that the method does not read are None."""
        read = self.reads.get(method, self.default)
        return {key: cell[key] if key in read else None for key in self.default}

    def where(self, method: str, cell: Mapping[str, Any], label: str = "method") -> Cell:
        """The keys of the method's records in a cell, for selections of a `ResultsTable`."""
        return {label: method, **self.met_by(method, cell)}

    def without_prior(self, cell: Mapping[str, Any]) -> Cell:
        """A cell as learners without a prior meet it: the choices that they do not read are None."""
        return {key: cell[key] if key in READ_WITHOUT_PRIOR else None for key in self.default}

    def cells_without_prior(self) -> list[Cell]:
        """The cells that learners without a prior meet, each once."""
        return self._once(map(self.without_prior, self.cells))

    def cells_of(self, method: str) -> list[Cell]:
        """The cells that a method meets, each once."""
        return self._once(self.met_by(method, cell) for cell in self.cells)

    def _once(self, cells) -> list[Cell]:
        return list({self.key(cell): cell for cell in cells}.values())


def run_grid(
    grid: Grid,
    label: str,
    without_prior: str,
    methods: Sequence[str],
    numbers: Callable[[str, Cell], Mapping[str, Any]],
) -> Iterator[dict[str, Any]]:
    """The records of a grid: the learner without a prior in its cells, then each method in each cell it meets.

    Parameters
    ----------
    grid : Grid
    label : str
        The key under which a record names its method.
    without_prior : str
        The name of the learner without a prior. It reads `READ_WITHOUT_PRIOR` unless `Grid.reads` names it.
    methods : sequence of str
    numbers : callable
        ``numbers(method, cell)``: what is measured, a plain mapping.
    """
    plain = grid.cells_of(without_prior) if without_prior in grid.reads else grid.cells_without_prior()
    for cell in plain:
        yield {label: without_prior, **cell, **numbers(without_prior, cell)}
    for method in methods:
        for cell in grid.cells_of(method):
            yield {label: method, **cell, **numbers(method, cell)}
