"""The long-lived agent and every verb that joins strangers."""
