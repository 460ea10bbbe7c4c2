"""Comparison of meshes, reports and tables."""
