"""The life of an agent, whatever it lives in: the loop over tasks that all lives share."""
