"""Tasks, learners and figures of the claims in the factory (C3.4 to C3.12)."""
