"""The inverse kinematics libraries that `compare.py` measures, and what it needs to measure them fairly."""
