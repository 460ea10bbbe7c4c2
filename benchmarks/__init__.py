"""Speed and memory of curvcli, measured beside its peers in one run; `python -m benchmarks --help`."""
