"""Curvatures: passes, one idea a file, and the engine that runs them."""
