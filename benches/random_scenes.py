"""Plans in random scenes: is any plan reported as clear that is not?

    python benches/random_scenes.py --count 100000

An arm with capsules plans past boxes, spheres, cylinders, capsules and half-spaces. Coal judges every plan that is
called solved, on samples so dense that no capsule moves more than 1 mm from one to the next; ends, position limits and
rates are judged too. Scene N is the same in every run: `--first N --count 1` repeats it.
"""

from __future__ import annotations

import argparse

from peers import random_scenes

import beetle_ik as bik

AT_ONCE = 1000


def main() -> None:
    """Plans, judges, and prints the faults."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100_000, help="scenes (default: 100,000)")
    parser.add_argument("--first", type=int, default=0, help="number of the first scene (default: 0)")
    parser.add_argument(
        "--budget",
        type=int,
        help="improve plans until so many configurations are examined (default: the first plan counts)",
    )
    arguments = parser.parse_args()
    stop = bik.Stop(max_evaluations=arguments.budget) if arguments.budget else None
    scenes = solved = wrong = 0
    end = arguments.first + arguments.count
    for first in range(arguments.first, end, AT_ONCE):
        outcome = random_scenes.run(range(first, min(first + AT_ONCE, end)), stop)
        scenes, solved, wrong = scenes + outcome.scenes, solved + outcome.solved, wrong + len(outcome.wrong)
        print(*outcome.wrong, f"{scenes} scenes, {solved} solved, {wrong} of them not as said", sep="\n", flush=True)
    if wrong:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
