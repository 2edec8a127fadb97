"""The signal models that files can hold, by name."""

from typing import Any

from lifelore.interaction.category_signal import CategorySignal
from lifelore.interaction.joint_signal import JointSignal
from lifelore.interaction.return_signal import ReturnSignal
from lifelore.interaction.reward_signal import RewardSignal
from lifelore.interaction.step_reward_signal import StepRewardSignal
from lifelore.interaction.transition_signal import TransitionSignal

KINDS: dict[str, Any] = {
    kind.kind: kind
    for kind in (ReturnSignal, CategorySignal, RewardSignal, TransitionSignal, StepRewardSignal, JointSignal)
}
