"""C5.4: the prior over types learnt from past tasks, in a context, while it drifts."""
