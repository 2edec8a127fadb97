"""The tabletop job: bring the target from a tray of settled objects; the user and the gripper's state are hidden.

Actions are whole numbers ``verb × n_objects + object`` in the order of `VERBS`. The last action gives up: the job
ends without further points. Picking and pushing need an empty hand; an object must be in the hand to be put aside
or handed over. Every action is carried out in the simulator first; spills, knocks and reach are read from it, and
the user's points follow from them:

    reward = BRING [the target is handed over] − waiting × seconds − spill × spilled − knock × knocked
             + brisk [handed over briskly] + put_aside [an object put aside] + other_handed [another handed over]

The world knows no spatial relation; `perception` and the relations' truth are strangers to it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import UNLABELLED, LabelledCloud
from lifelore.core.streams import stream
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.photograph import photograph
from lifelore.domains.tabletop.physics import Contacts
from lifelore.domains.tabletop_job.events import Events, Witness
from lifelore.domains.tabletop_job.gripper_tray import GripperTray, TrayState
from lifelore.domains.tabletop_job.job_types import BRING, JobType, User
from lifelore.domains.tabletop_job.skills import hand_over, least_seconds, pick, push_apart, put_aside, slips_in
from lifelore.domains.tabletop_job.tray import Tray

VERBS = ("pick", "put aside", "push apart", "hand over gently", "hand over briskly")
PICK, PUT_ASIDE, PUSH_APART, HAND_OVER_GENTLY, HAND_OVER_BRISKLY = range(5)
LONGEST = 16
"""Actions after which a job is cut."""


@dataclass(frozen=True)
class JobObservation:
    """What the agent notices without looking: the hand, and what the last action did.

    Parameters
    ----------
    target : int
    held : int or None
    gone : frozenset of int
        Objects that are no longer on the table.
    n_actions_taken : int
    last : Events or None
        None before the first action.
    """

    target: int
    held: int | None
    gone: frozenset[int]
    n_actions_taken: int
    last: Events | None


@dataclass(frozen=True, eq=False)
class JobState:
    """A copy of a job in progress, from `TabletopJob.copy_state`; it can be pickled."""

    tray: TrayState
    observation: JobObservation
    ended: bool


class TabletopJob:
    """One job: a tray with its target, and a hidden type.

    Parameters
    ----------
    tray : Tray
    job_type : JobType
    seed : int
        Of the camera's noise when the agent looks again.
    camera : str
        ``"kinect"`` or ``"stereo"``.

    Raises
    ------
    MissingExtraError
        MuJoCo is not installed.

    Examples
    --------
    Pick the target and hand it over briskly, with two objects on the tray:

    >>> from lifelore.domains.tabletop.layout import stand
    >>> from lifelore.domains.tabletop.shapes import box
    >>> from lifelore.domains.tabletop_job.job_types import job_type_named
    >>> from lifelore.domains.tabletop_job.tray import tray_of
    >>> placed = [stand(box(0.1, 0.1, 0.06)), stand(box(0.06, 0.06, 0.05), height=0.06)]
    >>> job = TabletopJob(tray_of(placed, target=1), job_type_named("patient/firm"))
    >>> rewards = [job.step(verb * job.n_objects + 1)[1] for verb in (PICK, HAND_OVER_BRISKLY)]
    >>> print(f"{sum(rewards):.0f} points; ended: {job.ended}")
    9 points; ended: True
    """

    def __init__(self, tray: Tray, job_type: JobType, seed: int = 0, camera: str = "kinect") -> None:
        self.tray, self.job_type, self.seed, self._camera = tray, job_type, seed, CAMERAS[camera]
        self.n_objects = len(tray.shapes)
        self.n_actions = len(VERBS) * self.n_objects + 1
        self._physics = GripperTray(tray.shapes, tray.poses, job_type.gripper)
        self._physics.rest()
        self._start = JobState(
            self._physics.state(), JobObservation(tray.target, None, frozenset(), 0, None), False
        )
        self._observation, self._ended = self._start.observation, False

    @property
    def ended(self) -> bool:
        """Whether the target was handed over or lost, the agent gave up, or the job was cut."""
        return self._ended

    @property
    def observation(self) -> JobObservation:
        """The present observation."""
        return self._observation

    @property
    def poses(self):
        """Where the objects are now, for scoring and pictures."""
        return self._physics.poses

    def reset(self) -> JobObservation:
        """Back to the settled tray."""
        self.restore(self._start)
        return self._observation

    def copy_state(self) -> JobState:
        """All that `restore` needs."""
        return JobState(self._physics.state(), self._observation, self._ended)

    def restore(self, state: JobState) -> None:
        """Go on from a state of a job with the same tray and gripper; the user may be another."""
        self._physics.restore(state.tray)
        self._observation, self._ended = state.observation, state.ended

    def available(self) -> NDArray[np.bool_]:
        """(n_actions,) whether each action can be taken now."""
        allowed = np.zeros((len(VERBS), self.n_objects), np.bool_)
        held = self._observation.held
        if not self._ended:
            if held is None:
                here = self._physics.here
                allowed[PICK, here] = allowed[PUSH_APART, here] = True
            else:
                allowed[[PUT_ASIDE, HAND_OVER_GENTLY, HAND_OVER_BRISKLY], held] = True
        return np.append(allowed.ravel(), not self._ended)

    def step(self, action: int) -> tuple[JobObservation, float, bool]:
        """Take an action: observation, reward in points, and whether the job ended.

        Raises
        ------
        InputError
            The action is not available.
        """
        allowed = self.available()
        if not 0 <= action < self.n_actions or not allowed[action]:
            raise InputError(
                f"action must be one of {np.flatnonzero(allowed).tolist()} now, got {action}; see available()"
            )
        verb, number = divmod(int(action), self.n_objects)
        give_up = verb == len(VERBS)
        events = Events(0.0) if give_up else self._act(verb, number)
        held = None if self._physics.grip is None else self._physics.grip.object
        taken = self._observation.n_actions_taken + 1
        self._observation = JobObservation(self.tray.target, held, self._physics.gone, taken, events)
        self._ended = give_up or self.tray.target in self._physics.gone or taken >= LONGEST
        reward = reward_of(self.job_type.user, events, verb == HAND_OVER_BRISKLY, self.tray.target)
        return self._observation, reward, self._ended

    def _act(self, verb: int, number: int) -> Events:
        tray = self._physics
        witness = Witness(tray, number)
        if verb == PICK:
            return witness.events(pick(tray, number))
        if verb == PUT_ASIDE:
            return witness.events(put_aside(tray), put_aside=True)
        if verb == PUSH_APART:
            return witness.events(push_apart(tray, number), pushed=True)
        return witness.events(hand_over(tray, "brisk" if verb == HAND_OVER_BRISKLY else "gentle"))

    def look(self) -> LabelledCloud:
        """What the camera sees now, in the table's frame, without labels and colours.

        The hand is out of the picture, what it holds is not. At the start it is the tray's own picture. An object
        that is hidden has no points.
        """
        taken = self._observation.n_actions_taken
        points = self.tray.cloud.points if taken == 0 else self._photographed(taken)
        return LabelledCloud(points, np.full(len(points), UNLABELLED), None, self.tray.view.position)

    def _photographed(self, taken: int) -> NDArray[np.float64]:
        """(n, 3) points of a new picture."""
        rng = stream(self.seed, "tabletop job", "camera", taken)
        outlines = [self._physics.outline(k) for k in self._physics.here]
        if not outlines:
            return np.empty((0, 3))
        photo = photograph(self._physics, outlines, self.tray.view, self._camera, rng, fewest=0, coloured=False)
        assert photo is not None
        return photo.cloud.points

    def object_at(self, point: NDArray[np.float64]) -> int:
        """The object on the table nearest to a point in the table's frame: what the agent points at.

        Raises
        ------
        InputError
            No object is on the table.
        """
        here = [k for k in self._physics.here if k != self._observation.held]
        if not here:
            raise InputError("object_at needs an object on the table, got none; hand over what is held")
        return min(here, key=lambda k: self._physics.distance_to(k, point))

    def contacts(self) -> tuple[Contacts, NDArray[np.float64]]:
        """All contacts now, and the weights of the objects (n_objects,), newtons; for scoring."""
        return self._physics.contacts(), self._physics.weights

    def least_seconds(self) -> tuple[float, float]:
        """Least seconds in which the target can be picked and handed over gently, and briskly; for scoring."""
        gentle, brisk = (
            np.inf
            if slips_in(self._physics, manner)
            else sum(least_seconds(self._physics, self.tray.target, manner))
            for manner in ("gentle", "brisk")
        )
        return gentle, brisk


def reward_of(user: User, events: Events, brisk: bool, target: int) -> float:
    """The user's points for an action."""
    points = -user.waiting * events.seconds - user.spill * len(events.spilled) - user.knock * len(events.knocked)
    if events.handed is not None:
        points += (BRING if events.handed == target else user.other_handed) + (user.brisk if brisk else 0.0)
    return points + (user.put_aside if events.put_aside is not None else 0.0)
