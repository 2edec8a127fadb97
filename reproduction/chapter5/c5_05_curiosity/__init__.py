"""C5.5: artificial curiosity spends spare episodes; a late type is noticed, learnt and added."""
