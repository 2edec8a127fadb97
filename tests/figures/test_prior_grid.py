"""The figure of C3.2 shows every cell of the grid and the curves it is given."""

from lifelore.figures.prior_grid import draw_prior_grid, schedule_in_words

SCHEDULES = [[0.1, 1.0, 0.1], [1.0, 0.98, 0.01]]
HOWS = [(None, None, None), ("uniform", 0.1, "proportion"), ("prior", 0.1, "proportion")]


def number(value):
    return {"value": value, "median": value, "ci95": [value - 1, value + 1], "n": 3}


def result():
    rows = []
    for place, schedule in enumerate(SCHEDULES):
        for more, (ties, alpha0, form) in enumerate(HOWS):
            how = {"ties": ties, "alpha0": alpha0, "form": form}
            first = number(10.0 * place + more)
            rows.append(
                {"schedule": schedule, **how, "first": first, "to_80": number(50.0), "to_80_ratio": number(1.5)}
            )
            rows.append({"curve_of": how, "schedule": schedule, "mean": [0, 1], "low": [0, 0], "high": [1, 2]})
    rows.append({"curve_edges": [0, 1, 60]})
    default = {"ties": "uniform", "schedule": SCHEDULES[0], "alpha0": 0.1, "form": "proportion"}
    settings = {
        "schedules": SCHEDULES,
        "ties": ["uniform", "prior"],
        "default": default,
        "episodes": 60,
        "runs": 3,
    }
    return {"rows": rows, "settings": settings, "measured": {"optimal_return": number(54.0)}}


def test_every_number_has_its_place():
    figure = draw_prior_grid(result())
    *schedules, first, ratio = figure.axes
    assert len(schedules) == 4
    assert [text.get_text() for text in first.texts] == ["+1.0", "+2.0", "+11.0", "+12.0"]
    assert [text.get_text() for text in ratio.texts] == ["1.50"] * 4
    # ±1 around 1 and 2 does not leave 0 for certain; around 11 and 12 it does.
    assert [text.get_fontweight() for text in first.texts] == ["normal", "bold", "bold", "bold"]
    assert [tick.get_text() for tick in first.get_yticklabels()] == ["proportion, α⁰ 0.1"]


def test_curves_are_drawn_at_the_middle_of_their_blocks():
    curve = draw_prior_grid(result()).axes[0].lines[0]
    assert curve.get_xdata().tolist() == [1.0, (2 * 60) ** 0.5]  # episode 1, and 2 … 60


def test_schedules_in_words():
    assert schedule_in_words(SCHEDULES[0]) == "ε = 0.1"
    assert schedule_in_words(SCHEDULES[1]) == "ε = 1, × 0.98 an episode to 0.01"
