"""Output files: tables, meshes, pictures and pages, chosen by suffix, written whole or not at all."""
