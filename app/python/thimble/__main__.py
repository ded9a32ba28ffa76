"""Runs the program ``thimble``: ``python3 -m thimble``, or the command that pip installs."""

import os
import sys

from ._study import program


def main() -> None:
    os.execv(program(), ["thimble", *sys.argv[1:]])


if __name__ == "__main__":
    main()
