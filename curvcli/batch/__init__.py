"""Many meshes: what to do (plan), one mesh (run), who does it (processes, dask), what was done (manifest, summary)."""
