# SPDX-License-Identifier: MIT
"""What the project promises, and what shows that it is kept: proofs, equality, histories, mutants."""
