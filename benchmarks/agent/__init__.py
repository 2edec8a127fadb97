"""The long-lived agent beside its ablations and beside other methods, on the same streams of tasks."""
