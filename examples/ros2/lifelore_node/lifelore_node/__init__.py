"""A ROS 2 node beside `lifelore serve`: exports out, point clouds in, relations out."""
