"""A scripted player, the thesis's simulated user, who plays rounds and sessions in place of a person.

Its rounds stand in for other people where none are on record, and everything that it plays is marked as scripted.
"""

from functools import cache

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, ball_game, draw_sigma
from lifelore.domains.ball_game.simulated_player import choose_heading
from reproduction.chapter4.c4_14_people.ball_round import BallRound
from reproduction.chapter4.c4_14_people.study_plan import TRAINING, Round
from reproduction.chapter4.c4_14_people.study_session import StudySession
from reproduction.chapter4.c4_14_people.training_models import TrainingTotals

ROUNDS = 8
"""Training rounds of each size at each speed that scripted players play where no people are on record; more give
surer means and take longer (about 1 ms a round)."""
EXPECTED_SPEED = 50
"""Speed, in units a move, that the script reckons with where it does not know the speed."""


@cache
def scripted_others(layout: str) -> TrainingTotals:
    """Totals of scripted players who played `ROUNDS` training rounds of every size at every speed."""
    game, rows = ball_game(layout), []
    for size in SIZES:
        for speed in SPEEDS:
            random = stream(0, "play study", "scripted others", layout, size, speed)
            for _ in range(ROUNDS):
                played = BallRound(game, Round(TRAINING, size, speed), float(draw_sigma(random)), random)
                while not played.over:
                    played.move(heading_of_script(played, speed), SPEEDS.index(speed))
                rows.append(played.row(len(rows)))
    return TrainingTotals.of(rows)


def heading_of_script(played: BallRound, speed: int = EXPECTED_SPEED) -> int:
    """The direction that the simulated user chooses at the ball's place, for a speed in units a move."""
    return int(choose_heading(played.game.field, played.kind, played.x, played.y, speed))


def play_session(session: StudySession) -> StudySession:
    """Play all rounds that are left of a session by the script; the session."""
    while session.next_round is not None:
        session.begin()
        while not session.playing.over:
            session.move(heading_of_script(session.playing))
        session.finish()
    return session
