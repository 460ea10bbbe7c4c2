"""From files to meshes: the file's own vertices and polygons in file order, with everything else it says."""
