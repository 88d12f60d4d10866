# SPDX-License-Identifier: MIT
"""Colours of the pictures."""

GREY, PALE = "#57606a", "#f6f8fa"
