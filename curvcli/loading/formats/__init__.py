"""Formats that meshes are read in: each module or folder here declares one and registers it."""
