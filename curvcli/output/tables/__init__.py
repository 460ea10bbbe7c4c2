"""Tables of vertices, edges, faces, loops, regions and components."""
