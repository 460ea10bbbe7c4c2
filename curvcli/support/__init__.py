"""General helpers without any geometry: arrays, blocks, caches, memory, streams, words."""
