# SPDX-License-Identifier: MIT
"""The pictures that tools/draw_pictures.py draws."""
