"""Triangle meshes: points, faces and their combinatorics."""
