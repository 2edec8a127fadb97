"""Types, performance and observation models, beliefs, selection rules: policy reuse (ch. 4)."""
