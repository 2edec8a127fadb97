"""A ROS 2 node beside Lifelore: masks, ways and recognition out, point clouds in, relations out."""
