"""Tables, meshes and colours on their way out: one file per format, chosen by suffix, whole or not at all."""
