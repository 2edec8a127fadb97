"""Cells of a grid of open choices, by hand."""

from reproduction.engine.grid import Grid, run_grid

SLOW, FAST = [1.0, 0.9, 0.1], [0.1, 1.0, 0.1]
SETTINGS = {"schedule": [SLOW, FAST], "ties": ["uniform", "prior"], "max_steps": [9, 7], "else": 1}
READS = {"none": ("schedule", "max_steps"), "deaf": ("ties",)}
GRID = Grid.crossed(SETTINGS, ("schedule", "ties"), ("max_steps",), READS)
OTHER = {"schedule": FAST, "ties": "prior", "max_steps": 7}


def test_all_combinations_then_each_other_choice_alone():
    assert GRID.default == {"schedule": SLOW, "ties": "uniform", "max_steps": 9}
    assert [(c["schedule"], c["ties"], c["max_steps"]) for c in GRID.cells] == [
        (SLOW, "uniform", 9), (SLOW, "prior", 9), (FAST, "uniform", 9), (FAST, "prior", 9), (SLOW, "uniform", 7),
    ]  # fmt: skip
    assert GRID.key(OTHER) == ((0.1, 1.0, 0.1), "prior", 7)


def test_a_method_meets_a_cell_without_the_choices_that_it_does_not_read():
    assert GRID.met_by("none", OTHER) == {"schedule": FAST, "ties": None, "max_steps": 7}
    assert GRID.where("deaf", OTHER) == {"method": "deaf", "schedule": None, "ties": "prior", "max_steps": None}
    assert GRID.where("prior", OTHER) == {"method": "prior", **OTHER}
    assert [cell["ties"] for cell in GRID.cells_of("deaf")] == ["uniform", "prior"]


def test_every_method_runs_once_in_each_cell_that_it_meets():
    records = list(run_grid(GRID, ("none", "deaf", "prior"), lambda method, cell: {"n": len(method)}))
    met = [record["method"] for record in records]
    # Without a prior: two schedules and one other cap.
    assert [met.count(method) for method in ("none", "deaf", "prior")] == [3, 2, 5]
    assert records[0] == {"method": "none", "schedule": SLOW, "ties": None, "max_steps": 9, "n": 4}
