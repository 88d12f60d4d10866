# SPDX-License-Identifier: MIT
"""Colors of the pictures."""

GREY, PALE = "#57606a", "#f6f8fa"
