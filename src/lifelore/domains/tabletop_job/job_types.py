"""The hidden types of a tabletop job: the user who waits for the object, and how the gripper works today."""

from dataclasses import dataclass
from itertools import product

from lifelore.core.errors import NotFoundError


@dataclass(frozen=True)
class User:
    """How a user values the way in which the job is done, in points; bringing the target pays `BRING`.

    Parameters
    ----------
    name : str
    waiting : float
        Points lost per second that the arm moves, at least 0.
    spill, knock : float
        Points lost per spilled and per knocked object, at least 0.
    brisk : float
        Points for each brisk hand-over; negative where the user wants gentle hand-overs.
    put_aside : float
        Points for each object put aside, at most 0.
    other_handed : float
        Points for each other object handed over before the target, at most 0.
    """

    name: str
    waiting: float
    spill: float
    knock: float
    brisk: float = 0.0
    put_aside: float = 0.0
    other_handed: float = -3.0


@dataclass(frozen=True)
class Gripper:
    """How the gripper works today.

    Parameters
    ----------
    name : str
    thickness : float
        Of a finger, metres: a neighbour nearer than it and `gripper_tray.CLEARANCE` is knocked or in the way.
    strength : float
        Largest force on the held or pushed object, newtons.
    grip : float
        Largest force on the held object in multiples of its own weight, at least 1: the fingers press as hard as
        the object's weight needs, and let go beyond. Below 1.4 a brisk hand-over slips.
    """

    name: str
    thickness: float
    strength: float
    grip: float


@dataclass(frozen=True)
class JobType:
    """A user and a gripper; the agent sees neither."""

    user: User
    gripper: Gripper

    @property
    def name(self) -> str:
        """``"user/gripper"``."""
        return f"{self.user.name}/{self.gripper.name}"


BRING = 10.0
"""Points for handing over the target."""
USERS = (
    User("patient", waiting=0.2, spill=5.0, knock=1.0),
    User("hurried", waiting=0.6, spill=3.0, knock=0.5, brisk=1.0),
    User("cautious", waiting=0.2, spill=8.0, knock=2.0, brisk=-4.0),
    User("clearing", waiting=0.3, spill=5.0, knock=1.0, put_aside=-3.0, other_handed=0.0),
)
"""Who may wait: tolerant; in a hurry; afraid of haste and spills; wants whatever is picked."""
GRIPPERS = (
    Gripper("firm", thickness=0.008, strength=40.0, grip=4.0),
    Gripper("weak", thickness=0.008, strength=8.0, grip=4.0),
    Gripper("slippery", thickness=0.008, strength=40.0, grip=1.25),
    Gripper("wide", thickness=0.03, strength=40.0, grip=4.0),
)
"""How the gripper may work: well; too weak for objects above 0.8 kg; slips when moved briskly; thick fingers."""
JOB_TYPES = tuple(JobType(user, gripper) for user, gripper in product(USERS, GRIPPERS))
"""All sixteen types, users slowest."""


def job_type_named(name: str) -> JobType:
    """The type of a name such as ``"hurried/wide"``.

    Raises
    ------
    NotFoundError
        No type has this name.

    Examples
    --------
    >>> job_type_named("hurried/wide").gripper.thickness
    0.03
    """
    for job_type in JOB_TYPES:
        if job_type.name == name:
            return job_type
    names = ", ".join(job_type.name for job_type in JOB_TYPES)
    raise NotFoundError(f"type must be one of {names}, got {name!r}")
