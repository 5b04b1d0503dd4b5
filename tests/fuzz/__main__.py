"""Fuzz by hand: all cases of a series, or one of them."""

import argparse
import sys
import time

from .cases import Case, failures

STEP = 100


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--case", type=int)
    arguments = parser.parse_args()
    if arguments.case is not None:
        Case(arguments.seed, arguments.case).check()
        return 0
    start, bad = time.perf_counter(), 0
    stop = arguments.first + arguments.count
    for first in range(arguments.first, stop, STEP):
        for message in failures(arguments.seed, range(first, min(first + STEP, stop))):
            bad += 1
            print(message, end="\n\n")
    print(f"{bad} of {arguments.count} failed, {time.perf_counter() - start:.1f} s")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
