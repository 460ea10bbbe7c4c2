"""Curvatures: passes, one idea per file, and the engine that runs them."""
