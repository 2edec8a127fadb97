"""What figures of several claims of the chapter share."""
