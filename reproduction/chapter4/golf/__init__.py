"""Golf: rounds played by rules that know four training holes, and the picture of their categories."""
