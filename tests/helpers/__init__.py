# SPDX-License-Identifier: MIT
"""Code shared by tests; no test imports from another one."""
