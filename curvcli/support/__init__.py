"""Helpers that know nothing of meshes."""
