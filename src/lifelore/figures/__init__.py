"""Plain data in, matplotlib out."""
