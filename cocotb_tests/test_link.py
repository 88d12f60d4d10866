# SPDX-License-Identifier: MIT
"""passo_spi and passo_link: frames at the pins, verdicts, replies and bus accesses."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from random import Random

import cocotb
from cocotb.handle import HierarchyObject
from cocotb.triggers import FallingEdge, RisingEdge, Timer
from passo.cocotb.clocks import Clocks, Recorder, read
from passo.cocotb.spi import SpiMaster

from cocotb_tests.helpers.bench import begin, patience, rng
from cocotb_tests.helpers.crc import crc_of_words
from cocotb_tests.helpers.runner import run

READ, WRITE, PUSH = 1, 2, 3
PAYLOAD_MAX = 60
STATUS = 0xA5C3_1E87

MHZ_72 = 13_888  # clock periods in ps
MHZ_48 = 20_834
SCLK_18 = 27_778  # half periods of SCLK
SCLK_9 = 55_556


class Verdict(IntEnum):
    """Result of a frame."""

    OK = 0
    DUPLICATE = 1
    BAD_CRC = 2
    BAD_LENGTH = 3
    BAD_OPERATION = 4
    UNKNOWN_ADDRESS = 5
    READ_ONLY = 6
    QUEUE_FULL = 7
    BUSY = 8
    BAD_VALUE = 9


def test_link(simulator: str) -> None:
    run(
        __name__,
        "passo_link_top",
        simulator=simulator,
        internals=["passo_link.in_ack", "passo_spi.half_valid"],
    )


def header(operation: int, sequence: int, length: int, address: int) -> int:
    """First word of a frame."""
    return operation << 28 | sequence << 20 | length << 12 | address


def acknowledge(sequence: int, verdict: int) -> int:
    """Last word of the reply to a write or push."""
    upper = sequence << 8 | verdict
    return upper << 16 | upper ^ 0xFFFF


def frame(
    operation: int, sequence: int, address: int, payload: Sequence[int], length: int | None = None
) -> list[int]:
    """A frame with the words that clock out its reply; for a read only the length of `payload` matters."""
    length = len(payload) if length is None else length
    request = [header(operation, sequence, length, address), *([] if operation == READ else payload)]
    trailing = [0] * (2 + (len(payload) if operation == READ else 0))
    return [*request, crc_of_words(request), *trailing]


@dataclass(frozen=True)
class Write:
    """An executed word."""

    address: int
    data: int
    push: bool


class Target:
    """All registers behind the bus: writable where `refusals` has no entry and `known` has the address.

    Answers as the RTL's targets do: one clock after the strobe, for one clock, 0 otherwise. Checks that
    address and data are stable a clock before their strobe, and data to check or write a clock after
    it; and what the link says of the size of data to check.
    """

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks
        self.known = set(range(0x100))
        self.values: dict[int, int] = {}
        self.refusals: dict[int, Verdict] = {}
        self.checks: list[Write] = []
        self.writes: list[Write] = []
        self.reads: list[int] = []
        self._last_write = -4
        self._buses = [Recorder(clocks, signal) for signal in (dut.bus_data, dut.bus_push)]
        self._address = Recorder(clocks, dut.bus_address)
        for strobe in ("check", "write", "read"):
            cocotb.start_soon(self._serve(strobe))

    async def _serve(self, strobe: str) -> None:
        rises = RisingEdge(getattr(self.dut, f"bus_{strobe}"))
        fall = FallingEdge(self.dut.clk)
        while True:
            await rises
            await fall
            address = read(self.dut.bus_address)
            access = Write(address, read(self.dut.bus_data), bool(read(self.dut.bus_push)))
            now = self.clocks.now
            for bus in (*self._buses, self._address):
                assert not bus.changes or bus.changes[-1][0] < now, (
                    f"{strobe} with a bus that has just changed"
                )
            if strobe == "write":
                assert now - self._last_write >= 4
                self._last_write = now
                self.writes.append(access)
            await fall
            if strobe != "read":
                for bus in self._buses:
                    assert not bus.changes or bus.changes[-1][0] < now
            if strobe == "write":
                continue
            self.dut.bus_claim.value = address in self.known
            self.dut.bus_refusal.value = self.refusals.get(address, 0)
            if strobe == "read":
                self.reads.append(address)
                self.dut.bus_read_data.value = self.values.get(address, 0)
            else:
                self.checks.append(access)
                assert read(self.dut.bus_msb) == max(access.data.bit_length() - 1, 0)
                assert read(self.dut.bus_one_hot) == (access.data.bit_count() <= 1)
            await fall
            self.dut.bus_claim.value = 0
            self.dut.bus_refusal.value = 0
            self.dut.bus_read_data.value = 0


class Bench:
    """The modules under test between an SPI master and a target."""

    def __init__(self, dut: HierarchyObject, clocks: Clocks, spi: SpiMaster) -> None:
        self.dut, self.clocks, self.spi = dut, clocks, spi
        self.target = Target(dut, clocks)
        self.refused = Recorder(clocks, dut.refused)
        self.words = Recorder(clocks, dut.word_valid)
        self.sequence = 0

    @classmethod
    async def begin(
        cls, dut: HierarchyObject, half_period: int = SCLK_18, period: int = MHZ_72, **spi: int
    ) -> "Bench":
        """Reset."""
        master = SpiMaster(dut, half_period, **spi)
        inputs = ("bus_claim", "bus_refusal", "bus_read_data", "bus_counters", "bus_incomplete", "bus_busy")
        dut.status.value = STATUS
        return cls(dut, await begin(dut, *inputs, period=period), master)

    @property
    def refusals(self) -> int:
        """Number of times `refused` was raised."""
        return len(self.refused.clocks_where(bool, self.clocks.now))

    def next_sequence(self) -> int:
        """A sequence number that was not the last one."""
        self.sequence = (self.sequence + 1) % 256
        return self.sequence

    async def shift(self, random: Random) -> None:
        """Wait for a random part of a clock, so that frames meet all phases."""
        await Timer(random.randrange(1, 2 * self.clocks.period), "step")

    async def request(
        self, operation: int, address: int, payload: Sequence[int], sequence: int | None = None
    ) -> Verdict:
        """Send a write or push; check the reply and what was checked and executed; return the verdict."""
        sequence = self.next_sequence() if sequence is None else sequence
        return await self.send(frame(operation, sequence, address, payload))

    async def send(self, words: Sequence[int]) -> Verdict:
        """Send a frame of which the header is to be believed; like `request`."""
        target = self.target
        writes, checks, refusals = len(target.writes), len(target.checks), self.refusals
        operation, sequence = words[0] >> 28, words[0] >> 20 & 0xFF
        length, address = words[0] >> 12 & 0xFF, words[0] & 0xFFF
        reply = await self.spi.transfer(words)
        assert reply[:-1] == [STATUS] * (len(words) - 1), [hex(word) for word in reply]
        verdict = Verdict(reply[-1] >> 16 & 0xFF)
        assert reply[-1] == acknowledge(sequence, verdict)
        payload = words[1 : 1 + length]
        push = operation == PUSH
        accesses = [Write(address if push else address + n, word, push) for n, word in enumerate(payload)]
        assert target.checks[checks:] == accesses
        assert target.writes[writes:] == (accesses if verdict == Verdict.OK else [])
        counted = verdict not in (Verdict.OK, Verdict.DUPLICATE)
        assert self.refusals - refusals == counted
        if counted:
            assert read(self.dut.verdict) == verdict
        return verdict

    async def read_registers(self, address: int, length: int) -> list[int] | Verdict:
        """Send a read; return the data, or the verdict when it was refused; checks the reply's CRC."""
        sequence = self.next_sequence()
        words = frame(READ, sequence, address, [0] * length)
        writes, reads, refusals = len(self.target.writes), len(self.target.reads), self.refusals
        reply = await self.spi.transfer(words)
        assert len(self.target.writes) == writes
        assert reply[:3] == [STATUS] * 3
        data, crc = reply[3:-1], reply[-1]
        if crc == crc_of_words([words[0], *data]):
            assert self.target.reads[reads:] == list(range(address, address + length))
            assert self.refusals == refusals
            return data
        verdict = Verdict(crc >> 16 & 0xFF)
        assert set(reply[3:]) == {acknowledge(sequence, verdict)}, [hex(word) for word in reply]
        assert self.refusals == refusals + 1
        return verdict


@cocotb.test()
@cocotb.parametrize(
    rate=[
        (MHZ_72, SCLK_18),
        (MHZ_72, 2 * MHZ_72),  # edges of both clocks together
        (MHZ_72, 111_111),
        (10_000, SCLK_18),
        (MHZ_72, 30_000),
        (MHZ_48, SCLK_9),
        (MHZ_72, 500_000),
        (MHZ_72, 1_300_000),
    ][: patience(8, 4)]
)
async def frames_pass_at_every_rate(dut: HierarchyObject, rate: tuple[int, int]) -> None:
    """Writes, pushes and reads of any data from four clocks per SCLK up to very slow ones, at all phases."""
    random = rng(f"link, {rate}")
    period, half_period = rate
    bench = await Bench.begin(dut, half_period, period)
    for _ in range(max(min(patience(25, 5), 1_500_000 // half_period), patience(3, 1))):
        for operation in (WRITE, PUSH, READ):
            await bench.shift(random)
            length = random.choice((1, 1, 2, 3, 5))
            address = random.randrange(0x100 - length)
            payload = [
                random.choice((0, 0xFFFFFFFF, 1, 1 << 31, random.randrange(1 << 32))) for _ in range(length)
            ]
            if operation == READ:
                bench.target.values = {address + n: word for n, word in enumerate(payload)}
                assert await bench.read_registers(address, length) == payload
            else:
                assert await bench.request(operation, address, payload) == Verdict.OK
                assert read(dut.last_sequence) == bench.sequence


@cocotb.test()
@cocotb.parametrize(high=[12_000, 40_000])
async def sclk_need_not_be_symmetric(dut: HierarchyObject, high: int) -> None:
    """SCLK high for a fifth or for most of its period."""
    random = rng("link, duty")
    bench = await Bench.begin(dut, SCLK_18, high=high)
    for _ in range(20):
        await bench.shift(random)
        bench.target.values = {n: random.randrange(1 << 32) for n in range(2)}
        assert await bench.read_registers(0, 2) == [bench.target.values[n] for n in range(2)]
        assert await bench.request(WRITE, 3, [random.randrange(1 << 32)]) == Verdict.OK


@cocotb.test()
async def frames_may_follow_each_other_closely(dut: HierarchyObject) -> None:
    """The shortest times around chip select, and the longest frames."""
    random = rng("link, close")
    bench = await Bench.begin(dut, SCLK_18, lead=3 * MHZ_72 + 100, trail=MHZ_72 + 100, gap=3 * MHZ_72)
    expected: list[Write] = []
    for length in (PAYLOAD_MAX, PAYLOAD_MAX, 1, PAYLOAD_MAX, 59, 1, 1):
        payload = [random.randrange(1 << 32) for _ in range(length)]
        expected += [Write(0x10, word, push=True) for word in payload]
        reply = await bench.spi.transfer(frame(PUSH, bench.next_sequence(), 0x10, payload))
        assert reply == [STATUS] * (length + 3) + [acknowledge(bench.sequence, Verdict.OK)]
    await bench.clocks.wait(250)
    assert bench.target.writes == expected


@cocotb.test()
async def the_longest_read_is_coherent(dut: HierarchyObject) -> None:
    """60 registers in one frame, with their CRC."""
    random = rng("link, long read")
    bench = await Bench.begin(dut)
    bench.target.values = {n: random.randrange(1 << 32) for n in range(0x100)}
    assert await bench.read_registers(0x20, PAYLOAD_MAX) == [bench.target.values[0x20 + n] for n in range(60)]


@cocotb.test()
async def the_status_is_that_of_chip_select(dut: HierarchyObject) -> None:
    """It may change afterwards; all words of a frame show the same value."""
    bench = await Bench.begin(dut)
    for status in (0x80000000, 0xBFFFFFFF, 0x9234ABCD):
        dut.status.value = status

        async def change(status: int = status) -> None:
            await Timer(40 * MHZ_72, "step")
            dut.status.value = ~status & 0x3FFFFFFF | 0x80000000

        cocotb.start_soon(change())
        sequence = bench.next_sequence()
        reply = await bench.spi.transfer(frame(WRITE, sequence, 5, [1, 2]))
        assert reply == [status] * 5 + [acknowledge(sequence, Verdict.OK)]


@cocotb.test()
@cocotb.parametrize(length=[0, 61, 255, 64, 65, 128][: patience(6, 3)])
async def a_bad_length_is_refused(dut: HierarchyObject, length: int) -> None:
    """0 or above 60 words, in every operation; nothing is executed and the next frame is fine."""
    bench = await Bench.begin(dut)
    for operation in (WRITE, PUSH):
        words = frame(operation, bench.next_sequence(), 0, list(range(length)))
        assert await bench.send(words) == Verdict.BAD_LENGTH
        assert await bench.request(WRITE, 0, [1]) == Verdict.OK
    assert await bench.read_registers(0, length) == Verdict.BAD_LENGTH
    assert await bench.request(WRITE, 0, [1]) == Verdict.OK


@cocotb.test()
async def an_unknown_operation_is_refused(dut: HierarchyObject) -> None:
    """All codes but 1, 2 and 3."""
    bench = await Bench.begin(dut)
    for operation in (0, *range(4, 16)):
        words = frame(operation, bench.next_sequence(), 0, [1, 2])
        assert await bench.send(words) == Verdict.BAD_OPERATION


@cocotb.test()
async def the_first_objection_counts(dut: HierarchyObject) -> None:
    """A refusal of any word refuses the whole frame, as does an unclaimed address."""
    random = rng("link, objections")
    bench = await Bench.begin(dut)
    for _ in range(40):
        length = random.randrange(1, 7)
        kinds = [random.choice((None, None, *list(Verdict)[3:])) for _ in range(length)]
        bench.target.known = {0x10 + n for n, kind in enumerate(kinds) if kind != Verdict.UNKNOWN_ADDRESS}
        bench.target.refusals = {0x10 + n: kind for n, kind in enumerate(kinds) if kind}
        expected = next((kind for kind in kinds if kind), Verdict.OK)
        assert (
            await bench.request(WRITE, 0x10, [random.randrange(1 << 32) for _ in range(length)]) == expected
        )
        # nobody claims: whatever the refusal lines say
        read_verdict = await bench.read_registers(0x10, length)
        assert read_verdict == (kinds[0] or [0] * length)


@cocotb.test()
async def a_payload_that_is_not_whole_is_a_bad_length(dut: HierarchyObject) -> None:
    """The queues say that the last line or ramp is not complete; an objection to a word goes before."""
    bench = await Bench.begin(dut)
    dut.bus_incomplete.value = 1
    assert await bench.request(PUSH, 0x20, [1, 2, 3]) == Verdict.BAD_LENGTH
    bench.target.refusals = {0x20: Verdict.QUEUE_FULL}
    assert await bench.request(PUSH, 0x20, [1, 2, 3]) == Verdict.QUEUE_FULL
    dut.bus_incomplete.value = 0
    bench.target.refusals = {}
    assert await bench.request(PUSH, 0x20, [1, 2, 3]) == Verdict.OK


@cocotb.test()
async def a_state_that_does_not_allow_the_frame_is_busy(dut: HierarchyObject) -> None:
    """Judged once for the whole frame, at its verdict; objections, a wrong CRC and a bad length go before."""
    bench = await Bench.begin(dut)
    for at_check in (0, 1):
        for at_verdict in (0, 1):

            async def change(level: int = at_verdict) -> None:
                await RisingEdge(dut.bus_commit)
                dut.bus_busy.value = level

            dut.bus_busy.value = at_check
            cocotb.start_soon(change())
            verdict = await bench.request(WRITE, 0x20, [1, 2, 3])
            assert verdict == (Verdict.BUSY if at_verdict else Verdict.OK)
    dut.bus_busy.value = 1
    bench.target.refusals = {0x21: Verdict.BAD_VALUE}
    assert await bench.request(WRITE, 0x20, [1, 2, 3]) == Verdict.BAD_VALUE
    bench.target.refusals = {}
    dut.bus_incomplete.value = 1
    assert await bench.request(PUSH, 0x20, [1, 2, 3]) == Verdict.BAD_LENGTH
    dut.bus_incomplete.value = 0
    words = frame(WRITE, bench.next_sequence(), 0x20, [1, 2, 3])
    assert await bench.send([*words[:-3], words[-3] ^ 1, *words[-2:]]) == Verdict.BAD_CRC


@cocotb.test()
async def a_commit_covers_the_verdict_and_the_replay(dut: HierarchyObject) -> None:
    """From 30 clocks before the verdict until a clock after the last word; not while words are checked."""
    bench = await Bench.begin(dut)
    commit, verdicts = Recorder(bench.clocks, dut.bus_commit), Recorder(bench.clocks, dut.u_link.in_ack)
    strobes = {name: Recorder(bench.clocks, getattr(dut, f"bus_{name}")) for name in ("check", "write")}
    for length in (1, 2, PAYLOAD_MAX):
        await bench.spi.transfer(frame(PUSH, bench.next_sequence(), 0x20, list(range(length))))
        await bench.clocks.wait(300)
        (rise, _), (fall, _) = commit.changes
        assert rise <= verdicts.changes[0][0] - 30
        checks, writes = ([n for n, level in strobes[name].changes if level] for name in ("check", "write"))
        assert len(checks) == len(writes) == length
        assert checks[-1] < rise and writes[-1] + 1 < fall <= writes[-1] + 3
        for recorder in (commit, verdicts, *strobes.values()):
            recorder.changes.clear()


@cocotb.test()
async def chip_select_may_be_high_for_two_clocks(dut: HierarchyObject) -> None:
    """At all phases: the frame before is complete, the next one begins."""
    random = rng("link, chip select")
    bench = await Bench.begin(dut, SCLK_18, lead=3 * MHZ_72 + 100, trail=MHZ_72 + 100, gap=1)
    for _ in range(60):
        bench.spi.gap = random.randrange(1, MHZ_72)
        payload = [random.getrandbits(32)]
        assert await bench.request(WRITE, 0x30, payload) == Verdict.OK
        bench.spi.gap = 1  # and SCLK is high for two clocks


@cocotb.test()
async def a_reset_in_a_frame_ends_it(dut: HierarchyObject) -> None:
    """Wherever it comes, for however long: the rest of the frame is ignored, the next frame is fine."""
    random = rng("link, reset")
    bench = await Bench.begin(dut)
    halves = Recorder(bench.clocks, dut.u_spi.half_valid)
    for length in (1, 2, 50):
        for _ in range(25):
            words = frame(WRITE, bench.next_sequence(), 0x40, [5, 6])
            bits = 32 * len(words)
            cut = random.randrange(bits)
            sending = cocotb.start_soon(bench.spi.transfer_bits(words, random.choice((cut, cut + 1, bits))))
            # after the frame was seen to begin, and before it is complete
            await Timer(random.randrange(4 * MHZ_72, 32 * 5 * bench.spi.period), "step")
            await bench.clocks.fall
            over = sending.done()
            dut.rst.value = 1
            await bench.clocks.wait(length)
            writes = len(bench.target.writes)
            halves.changes.clear()
            dut.rst.value = 0
            if over:
                await bench.clocks.wait(20)
                assert not halves.changes
            else:
                await sending
            await bench.clocks.wait(300)
            assert len(bench.target.writes) == writes
            assert await bench.request(WRITE, 0x50, [random.getrandbits(32)]) in (
                Verdict.OK,
                Verdict.DUPLICATE,
            )


@cocotb.test()
async def holes_read_as_zero_behind_the_first_address(dut: HierarchyObject) -> None:
    """Only the first address of a read must exist."""
    bench = await Bench.begin(dut)
    bench.target.known = {0x10, 0x12}
    bench.target.values = {0x10: 0x11111111, 0x12: 0x22222222}
    assert await bench.read_registers(0x10, 4) == [0x11111111, 0, 0x22222222, 0]
    assert await bench.read_registers(0x11, 3) == Verdict.UNKNOWN_ADDRESS
    assert await bench.read_registers(0x12, 1) == [0x22222222]


@cocotb.test()
async def a_frame_is_executed_only_once(dut: HierarchyObject) -> None:
    """The sequence number of the last executed frame is a duplicate; refusals and reads do not count."""
    bench = await Bench.begin(dut)
    # nothing was executed yet: even the sequence number that the register shows after reset is new
    assert await bench.request(WRITE, 1, [5], sequence=0) == Verdict.OK
    assert await bench.request(WRITE, 1, [5], sequence=0) == Verdict.DUPLICATE
    assert await bench.request(PUSH, 2, [6, 7], sequence=0) == Verdict.DUPLICATE
    bench.target.refusals = {9: Verdict.BAD_VALUE}
    assert await bench.request(WRITE, 9, [1], sequence=0) == Verdict.DUPLICATE
    assert await bench.request(WRITE, 9, [1], sequence=1) == Verdict.BAD_VALUE
    bench.target.refusals = {}
    assert await bench.request(WRITE, 9, [1], sequence=1) == Verdict.OK
    bench.sequence = 0
    assert await bench.read_registers(1, 2) == [0, 0]
    assert bench.sequence == 1 and read(dut.last_sequence) == 1
    assert await bench.request(WRITE, 9, [1], sequence=0) == Verdict.OK
    words = frame(WRITE, 0, 9, [1])
    words[-3] ^= 1
    assert await bench.send(words) == Verdict.BAD_CRC
    words = frame(0, 0, 9, [1])
    assert await bench.send(words) == Verdict.BAD_OPERATION


@cocotb.test()
async def a_wrong_bit_anywhere_executes_nothing(dut: HierarchyObject) -> None:
    """A bit error in header, payload or CRC: BAD_CRC has priority; the next frame works."""
    random = rng("link, bits")
    bench = await Bench.begin(dut)
    bench.target.refusals = {0x33: Verdict.BUSY}
    for n in range(60):
        words = frame(
            random.choice((WRITE, PUSH)), bench.next_sequence(), random.choice((0x20, 0x33)), [1, 2, n]
        )
        at, bit = random.randrange(len(words) - 2), random.randrange(32)
        if at == 0 and (bit >= 28 or 12 <= bit < 20):
            # another operation or length: the rest is read differently, but never executed
            words[0] ^= 1 << bit
            writes = len(bench.target.writes)
            await bench.spi.transfer(words)
            assert len(bench.target.writes) == writes
        else:
            words[at] ^= 1 << bit
            assert await bench.send(words) == Verdict.BAD_CRC
        assert await bench.request(WRITE, 1, [n]) == Verdict.OK
    # a read with a wrong CRC is answered by its ack
    words = frame(READ, 7, 0, [0, 0])
    words[1] ^= 1 << 9
    reply = await bench.spi.transfer(words)
    assert reply[3:] == [acknowledge(7, Verdict.BAD_CRC)] * 3


@cocotb.test()
async def a_frame_that_is_cut_off_executes_nothing(dut: HierarchyObject) -> None:
    """Chip select rises after any number of bits, SCLK low or high; the next frame is fine."""
    random = rng("link, cut")
    bench = await Bench.begin(dut)
    words = frame(PUSH, bench.next_sequence(), 4, [0xFFFFFFFF, 0, 0x55555555])
    whole = 32 * (len(words) - 2)  # all that is executed
    for count in [0, 1, 2, 31, 32, 33, whole - 33, whole - 1, *(random.randrange(whole) for _ in range(60))]:
        for cut_high in (False, True):
            await bench.shift(random)
            received = len(bench.words.clocks_where(bool, bench.clocks.now))
            await bench.spi.transfer_bits(words, count, cut_high=cut_high)
            assert bench.target.writes == [], f"after {count} bits"
            received = len(bench.words.clocks_where(bool, bench.clocks.now)) - received
            # the word that ends with chip select instead of SCLK may count or not
            assert received in (
                {count // 32} if count % 32 or not cut_high else {count // 32, count // 32 - 1}
            )
    assert await bench.send(words) == Verdict.OK


@cocotb.test()
async def an_impatient_master_gets_its_frame_executed_exactly_once(dut: HierarchyObject) -> None:
    """Chip select rises on any clock around the verdict: the repetition is executed or a duplicate."""
    random = rng("link, impatient")
    bench = await Bench.begin(dut)
    outcomes: set[int] = set()
    for clocks in range(1, 100, patience(1, 4)):
        sequence = bench.next_sequence()
        words = frame(WRITE, sequence, 8, [clocks, sequence])
        bench.spi.trail = clocks * MHZ_72 + random.randrange(MHZ_72)
        bench.spi.gap = 12 * MHZ_72
        writes = len(bench.target.writes)
        await bench.spi.transfer(words[:-2])
        await Timer(100 * MHZ_72, "step")
        executed = len(bench.target.writes) - writes
        outcomes.add(executed)
        bench.spi.trail = 2 * SCLK_18
        reply = await bench.spi.transfer(words)
        assert reply[-1] == acknowledge(sequence, Verdict.DUPLICATE if executed else Verdict.OK), clocks
        assert len(bench.target.writes) - writes == 2, f"chip select rose {clocks} clocks after the crc"
    assert outcomes == {0, 2}


@cocotb.test()
async def a_frame_may_begin_during_a_replay(dut: HierarchyObject) -> None:
    """A long frame is acknowledged before it is executed to its end: the next one may begin immediately."""
    random = rng("link, replay")
    bench = await Bench.begin(dut, SCLK_18, lead=3 * MHZ_72 + 100, trail=MHZ_72)
    for gap in range(3, 40, 4):
        bench.spi.gap = gap * MHZ_72
        bench.target.writes = []
        long = [random.randrange(1 << 32) for _ in range(PAYLOAD_MAX)]
        first, second = bench.next_sequence(), bench.next_sequence()
        await bench.spi.transfer(frame(PUSH, first, 8, long))
        reply = await bench.spi.transfer(frame(WRITE, second, 9, [gap]))
        assert reply[-1] == acknowledge(second, Verdict.OK)
        assert bench.target.writes == [*(Write(8, word, True) for word in long), Write(9, gap, False)]


@cocotb.test()
async def a_frame_whose_header_is_missed_is_ignored(dut: HierarchyObject) -> None:
    """A master omits the words after the CRC of a long frame, so the next one comes too early.

    Neither that frame nor a part of its payload that looks like a frame is executed or acknowledged.
    """
    bench = await Bench.begin(dut, SCLK_18)
    inner = frame(WRITE, 199, 0x40, [1])[:-2]
    missed = 0
    for gap in (3, 20, 50, 90, 120, 180):
        bench.target.writes = []
        long = frame(PUSH, bench.next_sequence(), 8, list(range(PAYLOAD_MAX)))
        bench.spi.trail, bench.spi.gap = 90 * MHZ_72, gap * MHZ_72
        await bench.spi.transfer(long[:-2])
        bench.spi.trail, bench.spi.gap = 2 * SCLK_18, 8 * SCLK_18
        early = frame(WRITE, bench.next_sequence(), 9, [7, *inner, *inner, 8])
        reply = await bench.spi.transfer(early)
        await bench.clocks.wait(300)
        executed = [write.data for write in bench.target.writes]
        if reply[-1] == acknowledge(bench.sequence, Verdict.OK):
            assert executed == [*range(PAYLOAD_MAX), *early[1:-3]], f"{gap=}"
        else:
            missed += 1
            assert reply == [STATUS] * len(early), f"{gap=}"
            assert executed == list(range(PAYLOAD_MAX)), f"{gap=}"
            assert await bench.send(early) == Verdict.OK
    assert 0 < missed < 6


@cocotb.test()
async def garbage_executes_nothing(dut: HierarchyObject) -> None:
    """Random bits of any number, headers of good frames among them, and good frames in between."""
    random = rng("link, garbage")
    bench = await Bench.begin(dut)
    for _ in range(60):
        words = [
            random.choice((0, 0xFFFFFFFF, random.randrange(1 << 32))) for _ in range(random.randrange(1, 9))
        ]
        if random.random() < 0.5:
            words[0] = header(
                random.choice((READ, WRITE, PUSH)), random.randrange(256), random.randrange(1, 6), 4
            )
        writes = len(bench.target.writes)
        await bench.spi.transfer_bits(
            words, random.choice((32 * len(words), random.randrange(32 * len(words))))
        )
        assert len(bench.target.writes) == writes
        await bench.shift(random)
        assert await bench.request(WRITE, 2, [random.randrange(1 << 32)]) == Verdict.OK


async def read_counters(bench: Bench) -> dict[Verdict, int]:
    """The counters of refusals, read at addresses 4 and 5."""
    bench.dut.bus_counters.value = 1
    words = await bench.read_registers(4, 2)
    bench.dut.bus_counters.value = 0
    assert isinstance(words, list)
    return {verdict: words[n // 4] >> n % 4 * 8 & 0xFF for n, verdict in enumerate(list(Verdict)[2:])}


@cocotb.test()
async def refusals_are_counted(dut: HierarchyObject) -> None:
    """Each in its own 8-bit counter, which wraps; reset clears them all."""
    refused = patience(300, 10)
    random = rng("link, counters")
    bench = await Bench.begin(dut)
    expected = dict.fromkeys(list(Verdict)[2:], 0)
    assert await read_counters(bench) == expected
    for _ in range(60):
        verdict = random.choice((Verdict.BAD_CRC, *list(Verdict)[4:]))
        bench.target.refusals = {9: verdict}
        words = frame(WRITE, bench.next_sequence(), 9, [1])
        words[2] ^= verdict == Verdict.BAD_CRC
        assert await bench.send(words) == verdict
        expected[verdict] += 1
    assert await read_counters(bench) == expected
    for _ in range(refused):
        await bench.spi.transfer([header(WRITE, 0, 0, 0), crc_of_words([header(WRITE, 0, 0, 0)]), 0])
    expected[Verdict.BAD_LENGTH] = (expected[Verdict.BAD_LENGTH] + refused) % 256
    assert await read_counters(bench) == expected
    dut.rst.value = 1
    await bench.clocks.wait(2)
    dut.rst.value = 0
    assert await read_counters(bench) == dict.fromkeys(expected, 0)
    bench.target.refusals = {9: Verdict.BUSY}
    assert await bench.request(WRITE, 9, [1]) == Verdict.BUSY
    assert await read_counters(bench) == {verdict: verdict == Verdict.BUSY for verdict in expected}


@cocotb.test()
async def a_refusal_is_counted_whatever_chip_select_does(dut: HierarchyObject) -> None:
    """From the verdict on, 74 clocks after the CRC, chip select may rise and the next frame begin."""
    bench = await Bench.begin(dut, lead=3 * MHZ_72 + 100)
    words = frame(0, 7, 0, [1])[:-2]
    for n, clocks in enumerate(range(80, 120, 3)):
        bench.spi.trail, bench.spi.gap = clocks * MHZ_72, 3 * MHZ_72
        await bench.spi.transfer(words)
        bench.spi.trail, bench.spi.gap = 2 * SCLK_18, 8 * SCLK_18
        counters = await read_counters(bench)
        assert counters[Verdict.BAD_OPERATION] == n + 1, f"chip select rose {clocks} clocks after the crc"


@cocotb.test()
async def other_slaves_on_the_bus_do_not_matter(dut: HierarchyObject) -> None:
    """SCLK and MOSI move while chip select is high: no word arrives, the next frame is fine."""
    bench = await Bench.begin(dut)
    for bits in (1, 31, 32, 33, 100):
        received = len(bench.words.clocks_where(bool, bench.clocks.now))
        await bench.spi.clock_others(bits)
        assert len(bench.words.clocks_where(bool, bench.clocks.now)) == received
        assert await bench.request(WRITE, 2, [bits]) == Verdict.OK
