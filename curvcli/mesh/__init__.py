"""Triangle meshes: points, faces and everything combinatorial that follows from them."""
