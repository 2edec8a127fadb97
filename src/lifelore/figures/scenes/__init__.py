"""Pictures and documents of perceived scenes: `scene_picture` and `scene_document`; the others draw parts."""
