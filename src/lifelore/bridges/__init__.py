"""Other people's systems: any Gymnasium world, and what comes after it."""
