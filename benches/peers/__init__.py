"""Libraries that the benchmarks measure, and tools for measuring them fairly."""
