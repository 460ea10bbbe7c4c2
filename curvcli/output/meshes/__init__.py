"""Coloured meshes, one format a file."""
