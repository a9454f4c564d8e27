"""The program ``navwalker``, as it comes with the package: ``python -m navwalker``."""

import sys

from navwalker import _native


def main() -> None:
    """Runs the program with the arguments of the process and ends it with its status."""
    sys.exit(_native.main(["navwalker", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
