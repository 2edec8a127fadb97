"""Cells of a grid of open choices, by hand."""

from reproduction.engine.grid import Grid, run_grid

SETTINGS = {
    "default": {"schedule": [1.0, 0.9, 0.1], "ties": "uniform", "max_steps": 9, "else": 1},
    "schedules": [[1.0, 0.9, 0.1], [0.1, 1.0, 0.1]],
    "ties": ["uniform", "prior"],
    "max_steps": [9, 7],
}
GRID = Grid.crossed(
    SETTINGS,
    ("schedule", "ties", "max_steps"),
    {"schedule": "schedules", "ties": "ties"},
    {"max_steps": "max_steps"},
    reads={"deaf": ("ties",)},
)
OTHER = {"schedule": [0.1, 1.0, 0.1], "ties": "prior", "max_steps": 7}


def test_all_combinations_then_each_other_choice_alone():
    assert GRID.default == {"schedule": [1.0, 0.9, 0.1], "ties": "uniform", "max_steps": 9}
    slow, fast = SETTINGS["schedules"]
    assert [(c["schedule"], c["ties"], c["max_steps"]) for c in GRID.cells] == [
        (slow, "uniform", 9), (slow, "prior", 9), (fast, "uniform", 9), (fast, "prior", 9), (slow, "uniform", 7),
    ]  # fmt: skip
    assert GRID.key(OTHER) == ((0.1, 1.0, 0.1), "prior", 7)


def test_a_method_meets_a_cell_without_the_choices_that_it_does_not_read():
    assert GRID.without_prior(OTHER) == {"schedule": [0.1, 1.0, 0.1], "ties": None, "max_steps": 7}
    assert GRID.met_by("deaf", OTHER) == {"schedule": None, "ties": "prior", "max_steps": None}
    assert GRID.where("prior", OTHER) == {"method": "prior", **OTHER}
    assert [cell["ties"] for cell in GRID.cells_of("deaf")] == ["uniform", "prior"]


def test_every_method_runs_once_in_each_cell_that_it_meets():
    records = list(run_grid(GRID, "who", "none", ("deaf", "prior"), lambda who, cell: {"n": len(who)}))
    met = [record["who"] for record in records]
    # Without a prior: two schedules and one other cap.
    assert [met.count(who) for who in ("none", "deaf", "prior")] == [3, 2, 5]
    assert records[0] == {"who": "none", "schedule": [1.0, 0.9, 0.1], "ties": None, "max_steps": 9, "n": 4}
