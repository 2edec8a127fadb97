"""What acts on a perceived tray are meant to lead to: the states that the agent's plans on a tray go through.

A state is what is still on the tray, what the hand holds, and what has failed. Perception says what objects carry
and where fingers find room when some of them are gone, so a plan needs no counts of what follows what. What an act
results in is what the agent learns.
"""

from dataclasses import dataclass, field, replace

from lifelore.agent.long_lived.families.tray_features import LOADS, PerceivedTray
from lifelore.domains.tabletop_job.events import Events
from lifelore.domains.tabletop_job.job import HAND_OVER_BRISKLY, HAND_OVER_GENTLY, PICK, PUSH_APART, PUT_ASIDE

ACTS = (
    "pick the target",
    "pick what is on top of it",
    "pick its neighbour",
    "pick its next neighbour",
    "push the target apart",
    "push its neighbour apart",
    "put aside",
    "hand over gently",
    "hand over briskly",
    "give up",
)
PICK_TARGET, PICK_TOP, PICK_NEIGHBOUR, PICK_NEXT, PUSH_TARGET, PUSH_NEIGHBOUR = range(6)
ASIDE, GENTLY, BRISKLY, GIVE_UP = range(6, 10)
VERB = (PICK,) * 4 + (PUSH_APART,) * 2 + (PUT_ASIDE, HAND_OVER_GENTLY, HAND_OVER_BRISKLY)
RESULTS = (
    "done",
    "missed",
    "slipped",
    "knocked another",
    "spilled",
    "knocked another in vain",
    "spilled in vain",
)
DONE, MISSED, SLIPPED, KNOCKED, SPILLED, KNOCKED_IN_VAIN, SPILLED_IN_VAIN = range(7)
SPILLS = (SPILLED, SPILLED_IN_VAIN)
IN_VAIN = (MISSED, SLIPPED, KNOCKED_IN_VAIN, SPILLED_IN_VAIN)

LOAD_NAMES = ("nothing", "hardly anything", "perhaps something", "something")
ROOM_NAMES = ("room for any finger", "room for thin fingers", "no room for fingers")
STANDING = ("low", "tall", "low, on another object", "tall, on another object")
BURDENS = ("", ", after a spill", ", something still on it")
CLEAR, AFTER_SPILL, BURDENED = range(3)
"""What the pick of the held object tells: nothing lies on it, what lay there fell, or it may lie there still."""
N_PICKS = len(LOAD_NAMES) * len(ROOM_NAMES)
N_PUSHES = 2 * len(STANDING)
N_SITUATED = N_PICKS + N_PUSHES + 3 * len(BURDENS)
"""Causes of results: picks and pushes by the features of their object; putting aside and two ways to hand over, by
what the pick tells of what is still on the held object."""
PAYMENTS = (
    "nothing happened to other objects",
    "another object was knocked",
    "something was spilled",
    "an object was put aside",
    "the target was handed over gently",
    "the target was handed over briskly",
    "another object was handed over gently",
    "another object was handed over briskly",
    "the target was handed over gently with a spill",
    "the target was handed over briskly with a spill",
    "another object was handed over gently with a spill",
    "another object was handed over briskly with a spill",
)
"""What the user pays for, or takes points for: causes of rewards, whichever act has led to them."""
QUIET, KNOCK, SPILL, PUT, HANDED = range(5)
WITH_SPILL = 4
"""From a way to hand over to the same with a spill, in `PAYMENTS`."""
NOTHING = -1
"""Stands for an object that was pushed and made no room."""
MOST_FAILED, MOST_PUSHED = 2, 1
"""Failures and pushes that a plan foresees; more cost time and are hardly ever worth their points."""


@dataclass(frozen=True)
class TrayState:
    """A state of a job, as perceived and planned.

    Parameters
    ----------
    tray : PerceivedTray or None
        As last seen; None where the target is hidden.
    here : frozenset of int
        Objects that are on the tray, as far as the agent knows.
    held : int or None
    failed : frozenset of int
        Objects that could not be picked, and nothing near them has changed since.
    pushed : frozenset of int
        Objects that were pushed away from their neighbours since the tray was seen.
    burden : int
        Of the held object: `CLEAR`, `AFTER_SPILL` or `BURDENED`.
    """

    tray: PerceivedTray | None
    here: frozenset[int]
    held: int | None = None
    failed: frozenset[int] = field(default_factory=frozenset)
    pushed: frozenset[int] = field(default_factory=frozenset)
    burden: int = CLEAR

    @classmethod
    def seen(cls, tray: PerceivedTray | None, failed: frozenset[int] = frozenset()) -> "TrayState":
        """The state with an empty hand in which a tray is seen."""
        return cls(tray, frozenset() if tray is None else tray.objects, None, failed)

    def load(self, number: int) -> int:
        """See `PerceivedTray.load`."""
        return 0 if self.tray is None else self.tray.load(number, self.here)

    def room(self, number: int) -> int:
        """See `PerceivedTray.room`; what was pushed stands apart."""
        if self.tray is None or number in self.pushed:
            return 0
        return self.tray.room(number, self.here - self.pushed)

    def named(self) -> dict[int, int]:
        """The object that each act is about, by available act; giving up is about none."""
        if self.held is not None:
            return dict.fromkeys((ASIDE, GENTLY, BRISKLY), self.held)
        tray = self.tray
        if tray is None or tray.target not in self.here:
            return {}
        found, top, beside = {PICK_TARGET: tray.target}, tray.top(self.here), tray.neighbours(self.here)
        if top is not None:
            found[PICK_TOP] = top
        found |= dict(zip((PICK_NEIGHBOUR, PICK_NEXT), beside, strict=False))
        found = {act: number for act, number in found.items() if number not in self.failed}
        if len(self.pushed) < MOST_PUSHED:
            found[PUSH_TARGET] = tray.target
            if beside:
                found[PUSH_NEIGHBOUR] = beside[0]
        return found

    def cause(self, act: int, number: int) -> int:
        """What the result of an act depends on."""
        if act >= ASIDE:
            return N_PICKS + N_PUSHES + len(BURDENS) * (act - ASIDE) + self.burden
        load = self.load(number)
        if act < PUSH_TARGET:
            return load * len(ROOM_NAMES) + self.room(number)
        assert self.tray is not None, "an object is named on a tray that is seen"
        standing = self.tray.tall(number) + 2 * bool(self.tray.rests_on(number, self.here))
        return N_PICKS + 2 * standing + (load >= len(LOADS) - 1)

    def payments(self, act: int) -> list[int]:
        """What the user pays for when an act has a result, by result: numbers of `PAYMENTS`."""
        done = QUIET
        if act >= ASIDE:
            other = self.tray is None or self.held != self.tray.target
            done = PUT if act == ASIDE else HANDED + act - GENTLY + 2 * other
        knock, spill = (done, done + WITH_SPILL) if done >= HANDED else (KNOCK, SPILL)
        return [done, QUIET, QUIET, knock, spill, KNOCK, SPILL]

    def after(self, act: int, number: int) -> "list[TrayState | None]":
        """The state that an act leads to, by result; None is the end of the episode."""
        if act >= ASIDE:
            freed = replace(self, held=None, burden=CLEAR)
            brought = act > ASIDE and self.tray is not None and number == self.tray.target
            return [None if brought else freed] * len(RESULTS)
        pile = frozenset() if self.tray is None else self.tray.pile(number, self.here)
        found: list[TrayState | None] = []
        for result in range(len(RESULTS)):
            here = self.here - pile if result in SPILLS else self.here
            if act >= PUSH_TARGET:
                if result == MISSED:
                    found.append(replace(self, pushed=self.pushed | {NOTHING}))
                else:
                    found.append(replace(self, here=here, pushed=self.pushed | {number}, failed=frozenset()))
            elif result in IN_VAIN:
                found.append(replace(self, here=here, failed=self.failed | {number}))
            else:
                left, failed = here - {number}, self._still_failed(number)
                burden = self._burden(number, result)
                found.append(replace(self, here=left, held=number, failed=failed, burden=burden))
        return found

    def _burden(self, picked: int, result: int) -> int:
        """What a pick that succeeded tells of what is still on the object."""
        if result == SPILLED:
            return AFTER_SPILL
        loaded = self.load(picked) == len(LOADS)
        return BURDENED if loaded or result == KNOCKED else CLEAR

    def _still_failed(self, gone: int) -> frozenset[int]:
        """Objects that cannot be picked although another is gone."""
        if self.tray is None:
            return self.failed
        return frozenset(k for k in self.failed - {gone} if not self.tray.hinders(gone, k, self.here))


def result_of(events: Events, act: int, room: bool = True) -> int:
    """The result of an act, from what it did, and from whether fingers have room at the target after a push."""
    pushes = PUSH_TARGET <= act < ASIDE
    vain = not pushes and (events.slipped or not events.reached)
    if events.spilled or events.lost:
        return SPILLED_IN_VAIN if vain else SPILLED
    if events.knocked:
        return KNOCKED_IN_VAIN if vain else KNOCKED
    if events.slipped:
        return SLIPPED
    return DONE if events.reached and (room or not pushes) else MISSED


def cause_name(cause: int) -> str:
    """A cause of results in words."""
    if cause < N_PICKS:
        load, room = divmod(cause, len(ROOM_NAMES))
        return f"pick ({LOAD_NAMES[load]} on it, {ROOM_NAMES[room]})"
    if cause < N_PICKS + N_PUSHES:
        standing, loaded = divmod(cause - N_PICKS, 2)
        return f"push apart ({STANDING[standing]}{', something on it' if loaded else ''})"
    act, burden = divmod(cause - N_PICKS - N_PUSHES, len(BURDENS))
    return ACTS[ASIDE + act] + BURDENS[burden]
