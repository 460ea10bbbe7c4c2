"""Closed surfaces in space: sides of points, nesting and crossings."""
