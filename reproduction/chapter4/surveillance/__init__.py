"""The surveillance reserve: the peers of policy reuse, and runs of rules and peers on the same tasks."""
