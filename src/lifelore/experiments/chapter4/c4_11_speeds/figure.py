"""Figure of claim C4.11."""

from collections.abc import Mapping

from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS


def draw(result: Mapping):
    from lifelore.experiments.chapter4.speed_losses import draw_speed_losses

    return draw_speed_losses(result, SIZES, SPEEDS)
