"""Families of tasks as the long-lived agent meets them: one module a family, beside the worlds they need."""
