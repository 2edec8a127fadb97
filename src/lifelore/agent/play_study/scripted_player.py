"""A scripted player, the thesis's simulated user, who plays rounds and sessions in place of a person.

Its rounds stand in for other people where none are on record, and everything that it plays is marked as scripted.
"""

from functools import cache

from lifelore.agent.play_study.ball_round import BallRound
from lifelore.agent.play_study.round_result import RoundResult
from lifelore.agent.play_study.study_models import Others, TrainingTotals
from lifelore.agent.play_study.study_plan import TRAINING, Round
from lifelore.agent.play_study.study_session import StudySession
from lifelore.agent.play_study.study_settings import SCRIPTED
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, ball_game, draw_sigma
from lifelore.domains.ball_game.simulated_player import choose_heading

ROUNDS = 8
"""Training rounds of each size at each speed that scripted players play where no people are on record; more give
surer means and take longer (about 1 ms a round)."""
EXPECTED_SPEED = 50
"""Speed, in units a move, that the script reckons with where it does not know the speed."""


@cache
def scripted_others(layout: str) -> Others:
    """Scripted players who played `ROUNDS` training rounds of every size at every speed."""
    game, results = ball_game(layout), []
    for size in SIZES:
        for speed in SPEEDS:
            random = stream(0, "play study", "scripted others", layout, size, speed)
            for _ in range(ROUNDS):
                played = BallRound(game, SIZES.index(size), float(draw_sigma(random)), random)
                while not played.over:
                    played.steer(heading_of_script(played, speed))
                    played.move(SPEEDS.index(speed))
                results.append(RoundResult.of(len(results), Round(TRAINING, size, speed), speed, played))
    return Others(TrainingTotals.of(results), SCRIPTED, ROUNDS)


def heading_of_script(played: BallRound, speed: int = EXPECTED_SPEED) -> int:
    """The direction that the simulated user chooses at the ball's place, for a speed in units a move."""
    return int(choose_heading(played.game.field, played.kind, played.x, played.y, speed))


def play_next_round(session: StudySession) -> RoundResult:
    """Play the next round of a session by the script; its result, which is not accepted yet."""
    session.begin()
    over = False
    while not over:
        session.steer(heading_of_script(session.playing))
        over = session.frame()["over"]
    result = session.result()
    assert result is not None
    return result
