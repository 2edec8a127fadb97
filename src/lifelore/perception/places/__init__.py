"""Where objects are: their boxes in space (`object_box`), what they rest on (`support_height`), their pixels
(`object_mask`)."""
