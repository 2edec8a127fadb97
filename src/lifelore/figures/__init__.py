"""Plain data in, matplotlib out: primitives such as `curves`, and the pictures of `lives` and `scenes`."""
