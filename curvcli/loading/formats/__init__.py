"""Input formats: each module or folder here declares one and registers it."""
