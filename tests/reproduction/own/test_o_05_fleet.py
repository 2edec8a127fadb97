"""O5: rounds to competence and measures by hand."""

from reproduction.own.o_05_fleet.run import cells, numbers, readings, rounds_to_competence


def test_rounds_to_competence_by_hand():
    def needed(*refused):
        return rounds_to_competence(refused, [100] * len(refused), 0.1, 3)

    assert needed(100, 50, 10, 10, 10) == 2
    assert needed(100, 20, 4, 6, 90) == 1  # 30 refused moves in three rounds
    assert needed(0, 0, 0) == 0
    assert needed(100, 50, 40, 5, 0) == 5


def test_measures_by_hand():
    settings = {"rounds": {"1": 6, "2": 5, "8": 4}, "buildings": 2, "window": 1, "competent": [0.1, 0.6]}
    curves = {1: [100, 90, 80, 50, 5, 0], 2: [100, 80, 5, 0, 0], 8: [100, 5, 0, 0]}
    results = [cell | {"fleet": curves[cell["robots"]], "nothing": [100.0]} for cell in cells(settings)]
    assert len(results) == 6
    found = numbers(settings, results, 0.1)
    assert found["rounds_of_1"].value == 4
    assert found["tasks_of_8"].value == 8
    assert found["ratio_8_to_1"].value == 0.25
    assert found["ratio_2_to_1"].value == 0.5
    read = {cell["competent at"]: found for cell, found in readings(settings, results)}
    assert read[0.6]["rounds_of_1"].value == 3
