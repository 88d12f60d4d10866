# SPDX-License-Identifier: MIT
"""Nested interrupts: selection of exceptions, and the registers of NVIC and system control block."""

from passo_stm32.bus import MachineError, Peripheral, Register

RESET, NMI, HARD_FAULT, SUPERVISOR_CALL, PEND_SV, SYS_TICK, INTERRUPT_0 = 1, 2, 3, 11, 14, 15, 16
INTERRUPTS = 43  # of a medium-density STM32F103
PRIORITY_BITS = 4
FIXED = {NMI: -2, HARD_FAULT: -1}
LOWEST = 256
VECTOR_KEY = 0x05FA

SET_ENABLE, CLEAR_ENABLE, SET_PENDING, CLEAR_PENDING, ACTIVE, PRIORITY = (
    0x000,
    0x080,
    0x100,
    0x180,
    0x200,
    0x300,
)


class Exceptions:
    """State of all exceptions. Numbers are exception numbers: interrupt n is 16 + n."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Reset: nothing is pending or active; interrupts are disabled."""
        self.enabled = 1 << NMI | 1 << HARD_FAULT | 1 << SUPERVISOR_CALL | 1 << PEND_SV | 1 << SYS_TICK
        self.pending = 0
        self.lines = 0  # levels of the peripherals' interrupt requests
        self.active: list[int] = []  # innermost last
        self.priority = [0] * (INTERRUPT_0 + INTERRUPTS)
        self.group = 0  # PRIGROUP

    def set_line(self, interrupt: int, level: object) -> None:
        """Set a request line: a rising edge, or a high level at the end of the handler, makes it pending."""
        bit = 1 << (INTERRUPT_0 + interrupt)
        if level and not self.lines & bit:
            self.pending |= bit
        self.lines = self.lines | bit if level else self.lines & ~bit

    def preemption(self, exception: int) -> int:
        """Preemption priority; lower values are more urgent."""
        fixed = FIXED.get(exception)
        return self.priority[exception] >> (self.group + 1) if fixed is None else fixed

    def running(self, masks: int) -> int:
        """Present preemption priority, including the processor's masks (passo_cpu_masks())."""
        levels = [self.preemption(exception) for exception in self.active]
        if masks & 1:
            levels.append(0)
        if masks & 2:
            levels.append(-1)
        if base := masks >> 16 & 0xFF:
            levels.append(base >> (self.group + 1))
        return min(levels, default=LOWEST)

    def next(self, masks: int) -> int | None:
        """The exception to be taken now, or None."""
        waiting = self.pending & self.enabled
        if not waiting:
            return None
        best = min(
            (n for n in range(waiting.bit_length()) if waiting >> n & 1),
            key=lambda n: (self.preemption(n), FIXED.get(n, self.priority[n]), n),
        )
        return best if self.preemption(best) < self.running(masks) else None

    def wakes(self, masks: int) -> bool:
        """Whether WFI ends: an exception would be taken if PRIMASK were 0."""
        return self.next(masks & ~1) is not None

    def enter(self, exception: int) -> None:
        """Take an exception."""
        self.pending &= ~(1 << exception)
        self.active.append(exception)

    def leave(self) -> None:
        """Return from the innermost handler; a request line that is still high is pending again."""
        if not self.active:
            raise MachineError("exception return without an exception")
        self.pending |= self.lines & (1 << self.active.pop())


class Nvic(Peripheral):
    """Enable, pending, active and priority registers."""

    name = "NVIC"
    base = 0xE000E100
    size = 0x400

    def reset(self) -> None:
        """Nothing to do: the machine resets the exceptions."""

    def read(self, offset: int) -> int:
        """Words of bits or of four priorities."""
        e = self.machine.exceptions
        if offset >= PRIORITY:
            first = INTERRUPT_0 + offset - PRIORITY
            return int.from_bytes(bytes(e.priority[first : first + 4]).ljust(4, b"\0"), "little")
        bank, word = offset & ~0x7F, 32 * (offset % 0x80 // 4)
        if bank in (SET_ENABLE, CLEAR_ENABLE):
            bits = e.enabled
        elif bank in (SET_PENDING, CLEAR_PENDING):
            bits = e.pending
        else:
            bits = sum(1 << exception for exception in e.active)
        return bits >> (INTERRUPT_0 + word) & 0xFFFFFFFF

    def write(self, offset: int, value: int) -> None:
        """Ones set or clear; priorities have 4 bits."""
        e = self.machine.exceptions
        if offset >= PRIORITY:
            for i, byte in enumerate(value.to_bytes(4, "little")):
                number = INTERRUPT_0 + offset - PRIORITY + i
                if number < len(e.priority):
                    e.priority[number] = byte & 0xF0
            return
        bank, bits = offset & ~0x7F, value << (INTERRUPT_0 + 32 * (offset % 0x80 // 4))
        if bits >> (INTERRUPT_0 + INTERRUPTS):
            raise MachineError(f"{self.name} + 0x{offset:03X}: there are {INTERRUPTS} interrupts")
        if bank == SET_ENABLE:
            e.enabled |= bits
        elif bank == CLEAR_ENABLE:
            e.enabled &= ~bits
        elif bank == SET_PENDING:
            e.pending |= bits
        elif bank == CLEAR_PENDING:
            e.pending &= ~bits
            e.pending |= e.lines & bits  # request lines that are still high
        else:
            raise MachineError(f"write to an unmodeled register: {self.name} + 0x{offset:03X}")


class SystemControl(Peripheral):
    """System control block."""

    name = "SCB"
    base = 0xE000ED00
    size = 0x100
    registers = (
        Register("CPUID", 0x00, 0, 0x411FC231),
        Register("ICSR", 0x04, 0x9E000000),
        Register("VTOR", 0x08, 0x3FFFFF80),
        Register("AIRCR", 0x0C, 0xFFFF0707, 0xFA050000),
        Register("SCR", 0x10, 0),
        Register("CCR", 0x14, 0x200, 0x200),
        Register("SHPR1", 0x18, 0xF0F0F0),
        Register("SHPR2", 0x1C, 0xF0000000),
        Register("SHPR3", 0x20, 0xF0F00000),
        Register("SHCSR", 0x24, 0),
        Register("CFSR", 0x28, 0xFFFFFFFF),
        Register("HFSR", 0x2C, 0xFFFFFFFF),
        Register("MMFAR", 0x34),
        Register("BFAR", 0x38),
    )

    def read_icsr(self) -> int:
        """Pending system exceptions, the active exception and the most urgent pending one."""
        e = self.machine.exceptions
        waiting = e.pending & e.enabled
        order = [n for n in range(waiting.bit_length()) if waiting >> n & 1]
        first = min(order, key=lambda n: (e.preemption(n), n), default=0)
        return (
            (e.active[-1] if e.active else 0)
            | (len(e.active) <= 1) << 11
            | first << 12
            | (waiting >> INTERRUPT_0 != 0) << 22
            | (e.pending >> SYS_TICK & 1) << 26
            | (e.pending >> PEND_SV & 1) << 28
        )

    def write_icsr(self, value: int) -> None:
        """Set and clear PendSV and SysTick, set NMI."""
        e = self.machine.exceptions
        for bit, exception, level in (
            (28, PEND_SV, 1),
            (27, PEND_SV, 0),
            (26, SYS_TICK, 1),
            (25, SYS_TICK, 0),
        ):
            if value >> bit & 1:
                e.pending = e.pending | 1 << exception if level else e.pending & ~(1 << exception)
        if value >> 31:
            e.pending |= 1 << NMI

    def write_aircr(self, value: int) -> None:
        """Priority grouping and system reset, protected by a key."""
        if value >> 16 != VECTOR_KEY:
            raise MachineError("SCB.AIRCR is written without its key")
        self.machine.exceptions.group = value >> 8 & 7
        self.value["AIRCR"] = 0xFA050000 | value & 0x700
        if value & 4:
            self.machine.request_reset("software")

    def write_shpr2(self, value: int) -> None:
        """Priority of SVC."""
        self.value["SHPR2"] = value
        self.machine.exceptions.priority[SUPERVISOR_CALL] = value >> 24

    def write_shpr3(self, value: int) -> None:
        """Priorities of PendSV and SysTick."""
        self.value["SHPR3"] = value
        self.machine.exceptions.priority[PEND_SV] = value >> 16 & 0xFF
        self.machine.exceptions.priority[SYS_TICK] = value >> 24

    def write_cfsr(self, value: int) -> None:
        """Ones clear."""
        self.value["CFSR"] &= ~value

    def write_hfsr(self, value: int) -> None:
        """Ones clear."""
        self.value["HFSR"] &= ~value
