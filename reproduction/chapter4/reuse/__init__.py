"""Policy reuse on many tasks side by side: rules, runs and statistics, and the looks of their curves."""
