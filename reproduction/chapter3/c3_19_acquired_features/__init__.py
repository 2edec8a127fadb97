"""C3.19: features that an agent acquires while the entropy of its prior stays high."""
