# SPDX-License-Identifier: MIT
"""Plan a move, see it, run it on the simulated core, and compare."""

import numpy as np
from passo import Machine

MACHINE = "examples/gcode/machine.toml"

with Machine.from_file(MACHINE) as machine:
    motion = machine.move(X=40, Y=20, speed=50)
    times = np.linspace(0, motion.seconds, 9)
    print(np.column_stack([times, motion.positions_at(times)]).round(3))
    done = motion.run()
    print(done.end, f"{len(done.seconds['X'])} steps of X in {done.duration:.6f} s")
    off = np.abs(done.positions_at(times) - motion.positions_at(times)).max()
    print(f"off the plan by at most {off:.4f} mm")
