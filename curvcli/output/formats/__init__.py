"""Formats that are written: each module here declares one and registers it."""
