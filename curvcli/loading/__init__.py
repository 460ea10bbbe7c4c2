"""Readers of mesh files: vertices and polygons in file order, with all labels and properties."""
