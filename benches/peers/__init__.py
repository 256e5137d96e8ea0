"""The libraries that the benchmarks measure, and what is needed to measure them fairly."""
