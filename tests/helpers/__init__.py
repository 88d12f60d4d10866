# SPDX-License-Identifier: MIT
"""What several tests share; no test imports from another one."""
