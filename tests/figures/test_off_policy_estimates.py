"""The picture of `reuse evaluate`: targets in order, the log's mean, and documents without an estimate."""

from lifelore.figures.off_policy_estimates import draw_off_policy_estimates


def document(values):
    """A document with a target for each value; None for a target that could not be evaluated."""

    def estimates(value):
        if value is None:
            return dict.fromkeys(("ips", "self-normalised", "doubly-robust"))
        one = {"value": value, "ci95": [value - 0.1, value + 0.1]}
        return {"ips": one | {"ci95": None}, "self-normalised": None, "doubly-robust": one}

    targets = [{"name": f"policy {number}", "estimates": estimates(value)} for number, value in enumerate(values)]
    return {"decisions": 10, "users": 5, "logged": {"value": 0.5, "ci95": [0.4, 0.6]}, "targets": targets}


def test_the_best_target_is_on_top_and_none_without_an_estimate_is_drawn():
    (axes,) = draw_off_policy_estimates(document([0.2, None, 0.9])).axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["policy 2", "policy 0"]
    low, high = axes.get_ylim()
    assert low > high
    assert axes.get_legend_handles_labels()[1] == ["the log", "ips", "doubly-robust"]


def test_without_any_estimate_the_mean_of_the_log_is_drawn():
    (axes,) = draw_off_policy_estimates(document([None])).axes
    assert len(axes.get_yticks()) == 0
