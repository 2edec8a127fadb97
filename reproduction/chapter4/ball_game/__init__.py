"""The ball game: `games`, `move_signal`, players and their `play`, `learners`, and the `methods` compared."""
