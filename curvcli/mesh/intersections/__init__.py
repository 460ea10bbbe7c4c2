"""Self-intersections: pairs of faces that cross, overlap, fold over or touch, decided exactly."""
