"""Attacks on the promises of the library, without end: `python -m campaign --help`, from the folder `tests`."""
