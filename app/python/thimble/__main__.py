"""The program ``thimble``, as ``python3 -m thimble`` or the command that pip installs."""

import os
import sys

from . import _program


def main() -> None:
    program = _program()
    os.execv(program, ["thimble", *sys.argv[1:]])


if __name__ == "__main__":
    main()
