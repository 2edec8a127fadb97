"""Programs that are measured beside ours: other libraries, a loop in C, and plain Python as a textbook has it."""
