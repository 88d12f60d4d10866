# SPDX-License-Identifier: MIT
"""`python -m passo`: the command."""

import sys

from passo.cli import main

if __name__ == "__main__":
    sys.exit(main())
