"""The signal models that files can hold, by name."""

from typing import Any

from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.joint_signal import JointSignal
from lifelore.interaction.signals.return_signal import ReturnSignal
from lifelore.interaction.signals.reward_signal import RewardSignal
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal

KINDS: dict[str, Any] = {
    kind.kind: kind
    for kind in (ReturnSignal, CategorySignal, RewardSignal, TransitionSignal, StepRewardSignal, JointSignal)
}
