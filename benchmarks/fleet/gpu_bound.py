"""Upper bounds on what a GPU would do for Q-learners, priors and `step`: arithmetic, nothing measured on a GPU.

    rate of n learners = min(n / (reads in a row · latency), bandwidth / bytes a step)

A learner's steps wait for one another, so a thread of a GPU makes one step in the time of its dependent reads.
Many learners hide that time behind one another until the memory's bandwidth is used up. Sent there and back once
in T steps, n learners also pay for copying them and for two launches. What a real GPU does is less.
"""

from dataclasses import asdict, dataclass, fields

from lifelore.core.errors import InputError

SECTOR = 32
"""Bytes that a GPU reads or writes at least."""
STEP_SECTORS = 5
"""Sectors of its own that a step of a Q-learner moves: the row of Q that follows is read, one value of Q and one
visit are each read and written. Tables are shared and stay in the cache; the random state stays in registers."""
STEP_READS = 2
"""Reads of a step that wait for one another: the state that follows, then its row of Q."""
SAMPLE_BYTES = 5 * SECTOR + 16
"""A context's bucket, two codes and its row of counts, a uniform in, an action out; scattered codes."""
SAMPLE_COPIED = 24
"""Bytes copied a sample: a code and a uniform there, an action back."""
MOVE_COPIED = 29
"""Bytes that `core.cuda` copies a move: state, action and uniform there; state, reward and event back."""


@dataclass(frozen=True)
class Gpu:
    """Assumed properties of a GPU; the defaults are round numbers for one card of a data centre.

    Parameters
    ----------
    bandwidth, transfer : float
        Bytes a second of its memory, and between it and the computer's.
    latency, launch : float
        Seconds of a read that no cache answers, and of starting one kernel.
    """

    bandwidth: float = 2e12
    transfer: float = 25e9
    latency: float = 600e-9
    launch: float = 10e-6

    def __post_init__(self) -> None:
        for name in (own.name for own in fields(self)):
            if not getattr(self, name) > 0:
                raise InputError(f"{name} must be positive, got {getattr(self, name)}")

    def to_dict(self) -> dict[str, float]:
        """The assumptions by name."""
        return asdict(self)

    def most_steps(self, learners: float) -> float:
        """Steps a second of so many Q-learners that stay on the GPU, at most."""
        return min(learners / (STEP_READS * self.latency), self.bandwidth / (STEP_SECTORS * SECTOR))

    def most_steps_with_copies(self, learners: float, bytes_each: float, steps: float) -> float:
        """Steps a second at most where learners are copied there and back for every `steps` steps of each."""
        seconds = learners * steps / self.most_steps(learners) + 2 * self.launch
        return learners * steps / (seconds + 2 * learners * bytes_each / self.transfer)

    def learners_to_beat(self, rate: float) -> float | None:
        """Learners from which the bound exceeds `rate` steps a second; None where it never does."""
        return rate * STEP_READS * self.latency if rate < self.bandwidth / (STEP_SECTORS * SECTOR) else None

    def steps_to_beat(self, rate: float, learners: float, bytes_each: float) -> float | None:
        """Steps of each of `learners` from which copying them there and back is repaid; None where it never is."""
        saved = learners / rate - learners / self.most_steps(learners)
        return (2 * learners * bytes_each / self.transfer + 2 * self.launch) / saved if saved > 0 else None

    def most_samples(self) -> float:
        """Samples a second of a prior at most, contexts copied there and actions back."""
        return 1 / (SAMPLE_BYTES / self.bandwidth + SAMPLE_COPIED / self.transfer)

    def samples_to_beat(self, rate: float) -> float | None:
        """Samples of one call from which the bound, with a launch, exceeds `rate` samples a second."""
        saved = 1 / rate - 1 / self.most_samples()
        return self.launch / saved if saved > 0 else None

    def most_moves(self) -> float:
        """Moves a second of `core.cuda.CudaTask.step_many` at most: copying alone."""
        return self.transfer / MOVE_COPIED
