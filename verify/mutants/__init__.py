# SPDX-License-Identifier: MIT
"""How many small faults in the sources do the judges see that do not know the model?"""
