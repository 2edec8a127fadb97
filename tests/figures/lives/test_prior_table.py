"""The table of a prior shows the contexts with most counts first, each action with its probability."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.figures.lives.prior_table import plot_prior
from lifelore.figures.style import save_figure


def prior():
    counted = ActionPrior(2, alpha0=0.5)
    counted.update([7, 7, 9, 9, 9], np.array([[True, False]] * 2 + [[False, True]] * 3))
    counted.update([4], [[True, True]], 0.5)
    return counted


def test_rows_cells_and_names(tmp_path):
    figure = plot_prior(prior(), labels={9: "wall ahead" * 9}, actions=("left", "right"), most=2)
    (axes,) = figure.axes
    first, second = (tick.get_text() for tick in axes.get_yticklabels())
    assert first == "wall ahead" * 3 + "wall ahea…   n = 3"
    assert second == "7   n = 2"
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["left", "right"]
    # (0 + ½) / (3 + 1), (3 + ½) / (3 + 1); (2 + ½) / (2 + 1), ½ / 3.
    assert [text.get_text() for text in axes.texts] == ["0.12", "0.88", "0.83", "0.17"]
    assert axes.get_title("left") == "Action prior: 2 of 3 contexts, most counts first"
    assert save_figure(figure, tmp_path / "prior.png").stat().st_size > 5_000


@pytest.mark.parametrize(
    ("settings", "message"),
    [({"actions": ("left",)}, "name 2 actions, got 1"), ({"most": 0}, "most must be at least 1")],
)
def test_wrong_settings(settings, message):
    with pytest.raises(InputError, match=message):
        plot_prior(prior(), **settings)


def test_an_empty_prior_is_not_drawn():
    with pytest.raises(InputError, match="prior must have counts"):
        plot_prior(ActionPrior(2))
