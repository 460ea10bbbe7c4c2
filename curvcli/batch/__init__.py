"""Batches of meshes: plan, one mesh (run), workers (processes, dask), results (manifest, summary)."""
