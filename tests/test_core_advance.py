# SPDX-License-Identifier: MIT
"""passo_core_advance() leads to the very state that passo_core_clock() would have led to, struct byte for byte.

PASSO_SEED is the seed of the random motions.
"""

import os

SEED = int(os.environ.get("PASSO_SEED", "1"))
