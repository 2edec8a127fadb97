"""The session of one player: which round is next, the round that is played, and BEAT in its blocks.

A session is rebuilt from its settings and the results so far, so that a player can come back. In a test block,
nothing that `view` and `frame` return tells the method or the speed. Thesis: §4.8.5.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from lifelore.agent.play_study.ball_round import BallRound
from lifelore.agent.play_study.round_result import RoundResult
from lifelore.agent.play_study.study_models import Others, TrainingTotals, beat_for, best_static_speed
from lifelore.agent.play_study.study_plan import BEAT, FREE, STATIC, TEST, Round, plan_rounds
from lifelore.agent.play_study.study_settings import StudySettings
from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, draw_sigma
from lifelore.interaction.adaptation.beat import Beat

FINISHED = "finished"


class StudySession:
    """A session.

    Parameters
    ----------
    name : str
        Anonymous identifier of the player.
    settings : StudySettings
    others : Others
        The other players; their totals cover the session.
    first : int
        Number of the method that begins, see `plan_rounds`.
    seed : int
        Draws the plan, and slips and pushes of the rounds.
    done : sequence of RoundResult
        Results of the rounds that were played before, in order.

    Attributes
    ----------
    static_speed : int
        Units a move, in the blocks without BEAT.
    """

    def __init__(
        self,
        name: str,
        settings: StudySettings,
        others: Others,
        *,
        first: int = 0,
        seed: int = 0,
        done: Sequence[RoundResult] = (),
    ) -> None:
        self.name, self.settings, self.others, self.seed = name, settings, others, seed
        self.plan = plan_rounds(settings, self._stream("plan"), first)
        self.done = list(done)
        self.static_speed = best_static_speed(others.totals, settings)
        self._playing: BallRound | None = None
        self._round: Round | None = None
        self._beat: Beat | None = None
        self._frame = 0

    @property
    def next_round(self) -> Round | None:
        """The round that is to be played next; None at the end of the session."""
        return self.plan[len(self.done)] if len(self.done) < len(self.plan) else None

    @property
    def phase(self) -> str:
        """``practice``, ``training``, ``test`` or ``finished``."""
        return FINISHED if self.next_round is None else self.next_round.phase

    @property
    def playing(self) -> BallRound:
        """The round that is being played; InputError where there is none."""
        if self._playing is None:
            raise InputError("no round is being played; begin one first")
        return self._playing

    def view(self) -> dict[str, Any]:
        """The state of the session as plain data, without what a blinded player must not know."""
        following = self.next_round
        shown = None
        if following is not None:
            shown = {"phase": following.phase, "size": following.size}
            shown |= {} if following.phase == TEST else {"speed": following.speed}
        return {
            "session": self.name,
            "phase": self.phase,
            "number": len(self.done),
            "rounds": len(self.plan),
            "next": shown,
            "settings": self.settings.document,
            "others": {"player": self.others.player, "players": self.others.players},
        }

    def begin(self) -> dict[str, Any]:
        """Start the next round; what the page draws of it.

        Raises
        ------
        InputError
            The session is finished.
        """
        following = self.next_round
        if following is None:
            raise InputError("the session is finished; start another session to play on")
        method = following.method
        self._start(following, self._beat_of_block(following) if method == BEAT else None, len(self.done))
        return self._scene()

    def begin_free(self, size: int, number: int = 0) -> dict[str, Any]:
        """Start a round outside the study, whose speed BEAT adapts; it is never recorded.

        Raises
        ------
        InputError
            The size is none of the session's, or the test has begun, whose blocks are blinded.
        """
        if isinstance(size, bool) or size not in self.settings.sizes:
            known = ", ".join(map(str, self.settings.sizes))
            raise InputError(f"size must be one of {known}, got {size!r}")
        if self.phase == TEST:
            raise InputError("a free round is not possible during the test; finish the session first")
        self._start(Round(FREE, size, None, BEAT), self._new_beat(), -1 - number)
        return self._scene()

    def steer(self, heading: int) -> None:
        """Set the direction: 0 north, 1 south, 2 east, 3 west."""
        self.playing.steer(heading)

    def frame(self) -> dict[str, Any]:
        """Play 1/30 s; the ball as it is drawn then.

        Returns
        -------
        dict
            ``x``, ``y``, ``moves``, ``hits``, ``hit`` (whether the last move met an obstacle), ``over`` and, in a
            free round, ``speed``.
        """
        played = self.playing
        span = self.settings.frames_per_move
        if played.heading >= 0 and self._frame % span == 0 and not played.over:
            self._move(played)
        if played.moves:
            self._frame += 1
        share = ((self._frame - 1) % span + 1) / span if played.moves else 1.0
        x, y = played.place_at(share)
        document = {
            "x": round(x, 1), "y": round(y, 1), "moves": len(played.moves), "hits": played.hits,
            "hit": played.touched, "over": played.over and self._frame % span == 0,
        }  # fmt: skip
        if self.is_free and played.moves:
            document["speed"] = SPEEDS[played.moves[-1][3]]
        return document

    @property
    def is_free(self) -> bool:
        """Whether a free round is being played."""
        return self._round is not None and self._round.phase == FREE

    def belief(self) -> dict[str, float]:
        """Probability of each size in a free round, by its name.

        Raises
        ------
        InputError
            The round is none of the free ones.
        """
        if not self.is_free or self._beat is None:
            raise InputError("the belief is shown in free rounds only; rounds of the study are blinded")
        belief = self._beat.belief
        return {str(size): float(p) for size, p in zip(self.settings.sizes, belief, strict=True)}

    def result(self) -> RoundResult | None:
        """The result of the round that is over, which the caller stores and then hands to `accept`.

        None after a free round.
        """
        played = self.playing
        assert self._round is not None
        if not played.over:
            raise InputError("the round is not over yet; play on")
        if self._round.phase == FREE:
            return None
        return RoundResult.of(len(self.done), self._round, self._constant_speed(self._round), played)

    def accept(self, result: RoundResult) -> None:
        """Count a result that is stored; the next round follows."""
        if result.number != len(self.done):
            raise InputError(f"result must be of round {len(self.done)}, got {result.number}")
        self.done.append(result)
        self.leave()

    def leave(self) -> None:
        """Drop the round that is being played; it begins again at the next `begin`."""
        self._playing = self._round = self._beat = None

    def _start(self, following: Round, beat: Beat | None, number: int) -> None:
        random = self._stream("round", number)
        sigma = float(draw_sigma(random))
        self._round, self._beat, self._frame = following, beat, 0
        self._playing = BallRound(self.settings.game, SIZES.index(following.size), sigma, random)

    def _scene(self) -> dict[str, Any]:
        assert self._round is not None
        played = self.playing
        scene = {
            "phase": self._round.phase, "size": self._round.size, "x": played.x, "y": played.y,
            "radius": float(played.game.field.radius[played.kind]), "number": len(self.done),
            "rounds": len(self.plan),
        }  # fmt: skip
        return scene | ({"speed": self._round.speed} if self._round.phase not in (TEST, FREE) else {})

    def _move(self, played: BallRound) -> None:
        if self._beat is None:
            assert self._round is not None
            constant = self._constant_speed(self._round)
            assert constant is not None
            played.move(SPEEDS.index(constant))
            return
        chosen = self._beat.select()
        signal = played.move(SPEEDS.index(self.settings.speeds[chosen]))
        self._beat.update(chosen, signal)
        played.name_size(SIZES.index(self.settings.sizes[int(self._beat.belief.argmax())]))

    def _constant_speed(self, planned: Round) -> int | None:
        return self.static_speed if planned.method == STATIC else planned.speed

    def _new_beat(self) -> Beat:
        return beat_for(TrainingTotals.of(self.done), self.others.totals, self.settings, self.seed)

    def _beat_of_block(self, planned: Round) -> Beat:
        """BEAT as the earlier rounds of the block leave it."""
        beat = self._new_beat()
        for result in self.done:
            if result.planned.block == planned.block:
                for speed, signal in zip(result.column("speed"), result.column("signal"), strict=True):
                    beat.update(self.settings.speeds.index(SPEEDS[speed]), signal)
        return beat

    def _stream(self, *names: str | int) -> np.random.Generator:
        return stream(self.seed, "play study", self.name, *names)
