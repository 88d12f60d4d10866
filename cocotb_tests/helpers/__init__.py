# SPDX-License-Identifier: MIT
"""What the cocotb tests share: benches, checkers, the judge, and how a test is run."""
