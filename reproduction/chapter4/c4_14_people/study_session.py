"""The session of one player: which round is next, the round that is played, and BEAT in its blocks.

In a test block, nothing that `view`, `begin` and `move` return tells the method or the speed. Thesis: §4.8.5.
"""

from typing import Any

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, draw_sigma
from lifelore.interaction.adaptation.beat import Beat
from reproduction.chapter4.c4_14_people.ball_round import BallRound, column
from reproduction.chapter4.c4_14_people.study_plan import BEAT, STATIC, TEST, Round, StudySettings, plan_rounds
from reproduction.chapter4.c4_14_people.training_models import TrainingTotals, beat_for, best_static_speed


class StudySession:
    """A session.

    Parameters
    ----------
    name : str
        Anonymous identifier of the player.
    settings : StudySettings
    others : TrainingTotals
        Of the other players; they cover the session.
    first : int
        Number of the method that begins, see `plan_rounds`.
    seed : int
        Draws the plan, and slips and pushes of the rounds.

    Attributes
    ----------
    static_speed : int
        Units a move, in the blocks without BEAT.
    done : list of dict
        The rounds that were played, see `BallRound.row`.
    """

    def __init__(
        self, name: str, settings: StudySettings, others: TrainingTotals, *, first: int = 0, seed: int = 0
    ) -> None:
        self.name, self.settings, self.others, self.seed = name, settings, others, seed
        self.plan = plan_rounds(settings, self._stream("plan"), first)
        self.done: list[dict[str, Any]] = []
        self.static_speed = best_static_speed(others, settings)
        self._playing: BallRound | None = None
        self._beat: Beat | None = None

    @property
    def next_round(self) -> Round | None:
        """The round that is to be played next; None at the end of the session."""
        return self.plan[len(self.done)] if len(self.done) < len(self.plan) else None

    @property
    def playing(self) -> BallRound:
        """The round that is being played; InputError where there is none."""
        if self._playing is None:
            raise InputError("no round is being played; begin one first")
        return self._playing

    def view(self) -> dict[str, Any]:
        """The state of the session as plain data, without what a blinded player must not know."""
        following = self.next_round
        shown = None if following is None else {"phase": following.phase, "size": following.size}
        if following is not None and shown is not None and following.phase != TEST:
            shown["speed"] = following.speed
        return {
            "session": self.name, "number": len(self.done), "rounds": len(self.plan), "next": shown,
            "frames_per_move": self.settings.frames_per_move,
        }  # fmt: skip

    def begin(self) -> dict[str, Any]:
        """Start the next round, again where it was begun and not finished: the ball that a page draws.

        Raises
        ------
        InputError
            The session is finished.
        """
        following = self.next_round
        if following is None:
            raise InputError("the session is finished; start another session to play on")
        random = self._stream("round", len(self.done))
        played = BallRound(self.settings.game, following, float(draw_sigma(random)), random)
        self._playing, self._beat = played, self._beat_of_block(following) if following.method == BEAT else None
        return self._ball() | {"radius": float(played.game.field.radius[played.kind])}

    def move(self, heading: int) -> dict[str, Any]:
        """Make a move: 0 north, 1 south, 2 east, 3 west; the ball after it.

        Returns
        -------
        dict
            ``x``, ``y``, ``moves``, ``hits``, ``hit`` (whether the move met an obstacle) and ``over``.
        """
        played, beat = self.playing, self._beat
        if beat is None:
            planned = played.planned
            speed = self.static_speed if planned.method == STATIC else planned.speed
            assert speed is not None
            played.move(heading, SPEEDS.index(speed))
        else:
            chosen = beat.select()
            beat.update(chosen, played.move(heading, SPEEDS.index(self.settings.speeds[chosen])))
            played.name_size(SIZES.index(self.settings.sizes[int(beat.belief.argmax())]))
        return self._ball()

    def finish(self) -> dict[str, Any]:
        """The row of the round that is over; the next round follows."""
        if not self.playing.over:
            raise InputError("the round is not over yet; play on")
        row = self.playing.row(len(self.done))
        self.done.append(row)
        self._playing = self._beat = None
        return row

    def _ball(self) -> dict[str, Any]:
        played = self.playing
        return {
            "x": played.x, "y": played.y, "moves": len(played.moves), "hits": played.hits,
            "hit": bool(played.moves and played.moves[-1][4]), "over": played.over,
        }  # fmt: skip

    def _beat_of_block(self, planned: Round) -> Beat:
        """BEAT as the earlier rounds of the block leave it."""
        beat = beat_for(TrainingTotals.of(self.done), self.others, self.settings, self.seed)
        for row in self.done:
            if row["block"] == planned.block:
                for speed, signal in zip(column(row, "speed"), column(row, "signal"), strict=True):
                    beat.update(self.settings.speeds.index(SPEEDS[speed]), signal)
        return beat

    def _stream(self, *names: str | int) -> np.random.Generator:
        return stream(self.seed, "play study", self.name, *names)
