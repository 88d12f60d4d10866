# SPDX-License-Identifier: MIT
"""A circle as timed points, while another task asks where the machine is; the core may be one at a device:

python timed_points.py unix:/tmp/passo
"""

import asyncio
import sys

import numpy as np
from passo import Machine

MACHINE = "examples/gcode/machine.toml"
SECONDS, RADIUS = 2.0, 20.0


async def watch(machine: Machine) -> None:
    """Print the position now and then."""
    while True:
        print({name: round(place, 2) for name, place in machine.position.items()})
        await asyncio.sleep(0.2)


async def main(on: str) -> None:
    """Go once around, slower at both ends."""
    times = np.linspace(0, SECONDS, 1001)
    angle = 2 * np.pi * (times / SECONDS - np.sin(2 * np.pi * times / SECONDS) / (2 * np.pi))
    circle = np.column_stack([RADIUS * (1 - np.cos(angle)), RADIUS * np.sin(angle), 0 * angle])
    with Machine.from_file(MACHINE, on) as machine:
        watching = asyncio.create_task(watch(machine))
        done = await machine.follow(times, circle)
        watching.cancel()
        print(done.end)


asyncio.run(main(sys.argv[1] if len(sys.argv) > 1 else "model"))
