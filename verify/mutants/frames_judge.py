# SPDX-License-Identifier: MIT
"""The link as judge: frames of all kinds, good and bad, with each word of the reply as docs/link.md says."""

import random
from dataclasses import dataclass

from passo import frame
from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.registers import Verdict

from verify.mutants.engine_judge import Check

FRAMES = 70
READ, WRITE, PUSH = r.Operation.READ, r.Operation.WRITE, r.Operation.PUSH
COUNTED = (  # in the order of the bytes of REFUSALS_0 and REFUSALS_1
    *(Verdict.BAD_CRC, Verdict.BAD_LENGTH, Verdict.BAD_OPERATION, Verdict.UNKNOWN_ADDRESS),
    *(Verdict.READ_ONLY, Verdict.QUEUE_FULL, Verdict.BUSY, Verdict.BAD_VALUE),
)
NO_REGISTER = 0x00F
HALF = 1 << 31  # the control word of a ramp to the greatest velocity, if the next word is 0


@dataclass
class Sent:
    """A frame, and what its words are worth if its header and CRC are good."""

    operation: int
    address: int
    words: list[int]
    verdict: Verdict
    length: int = -1  # that the header tells; default: of the words
    lines: int = 0  # that it queues
    ramps: int = 0
    data: list[int] | None = None  # that a read gives, if they are known


class Frames:
    """A host at the pins that knows each word that the core has to say. No motion runs."""

    def __init__(self, engine: Engine, parameters: Parameters, rng: random.Random):
        self.engine, self.parameters, self.rng = engine, parameters, rng
        self.sequence = 0
        self.known = False  # a frame with the sequence has been accepted
        self.channel = 0  # of the status
        self.room = [
            [1 << parameters.line_queue_log2, 1 << parameters.ramp_queue_log2]
            for _ in range(parameters.channels)
        ]
        self.refused = dict.fromkeys(COUNTED, 0)
        self.rates = [1 << 16] * parameters.channels

    @property
    def status(self) -> int:
        """The word of the status."""
        lines, ramps = (min(room, 255) for room in self.room[self.channel])
        return 2 << 30 | self.channel << 24 | self.sequence << 16 | lines << 8 | ramps

    def draw(self) -> Sent:
        """Any frame; each kind of refusal has its share."""
        rng, axes = self.rng, self.parameters.axes
        number = rng.randrange(self.parameters.channels)
        base = r.ADDRESS_CHANNEL_BASE + number * r.ADDRESS_CHANNEL_STRIDE
        lines, ramps = self.room[number]
        kind = rng.randrange(12)
        if kind == 0:
            words = [rng.getrandbits(17) for _ in range(rng.randint(1, 3))]
            good = all(word <= 1 << 16 for word in words)
            return Sent(WRITE, base + r.CHANNEL_RATE_TARGET, words, Verdict.OK if good else Verdict.BAD_VALUE)
        if kind == 1:
            return Sent(WRITE, r.ADDRESS_IDENTIFICATION, [rng.getrandbits(32)], Verdict.READ_ONLY)
        if kind == 2:
            operation = rng.choice((WRITE, PUSH, READ))
            words = [rng.getrandbits(32) for _ in range(rng.randint(1, 9))]
            return Sent(operation, NO_REGISTER, words, Verdict.UNKNOWN_ADDRESS)
        if kind == 3:
            address = rng.choice((r.ADDRESS_IDENTIFICATION, base + r.CHANNEL_RATE_TARGET))
            return Sent(PUSH, address, [rng.getrandbits(16)], Verdict.BAD_OPERATION)
        if kind in (4, 5):
            count, m = rng.randint(1, 3), rng.randint(1, (1 << 30) - 1)
            line = [0, m, *(rng.randint(0, m) for _ in range(axes)), *[0] * self.parameters.outputs]
            words = line * count
            if rng.random() < 0.3:
                bad = rng.choice(([0, 0], [0, 1 << 30], [1 << rng.randint(2, 7), m], [0, m, m + 1]))
                words = [*bad, *line[len(bad) :]]
                return Sent(PUSH, base + r.CHANNEL_LINE, words, Verdict.BAD_VALUE)
            if rng.random() < 0.3:
                words = words[: -rng.randint(1, axes)]
                verdict = Verdict.QUEUE_FULL if count > lines else Verdict.BAD_LENGTH
                return Sent(PUSH, base + r.CHANNEL_LINE, words, verdict)
            verdict = Verdict.QUEUE_FULL if count > lines else Verdict.OK
            return Sent(PUSH, base + r.CHANNEL_LINE, words, verdict, lines=count)
        if kind in (6, 7):
            count = rng.randint(1, 4)
            control = rng.getrandbits(15) << 16 | rng.getrandbits(2) << r.RAMP_CONTROL_SHAPE_LSB
            ramp = [control, rng.getrandbits(32), rng.getrandbits(32), rng.getrandbits(16), 0]
            if rng.random() < 0.1:
                ramp[:2] = [HALF, 0]
            words = ramp * count
            if rng.random() < 0.3:
                undefined = control | 1 << rng.choice((3, rng.randint(6, 15)))
                bad = rng.choice(
                    ([HALF | 1 << rng.randint(16, 30)], [HALF, 1 << rng.randrange(32)], [undefined])
                )
                return Sent(PUSH, base + r.CHANNEL_RAMP, [*bad, *ramp[len(bad) :]], Verdict.BAD_VALUE)
            if rng.random() < 0.3:
                words = words[: -rng.randint(1, 4)]
                verdict = Verdict.QUEUE_FULL if count > ramps else Verdict.BAD_LENGTH
                return Sent(PUSH, base + r.CHANNEL_RAMP, words, verdict)
            verdict = Verdict.QUEUE_FULL if count > ramps else Verdict.OK
            return Sent(PUSH, base + r.CHANNEL_RAMP, words, verdict, ramps=count)
        if kind == 8:
            operation = rng.choice([n for n in range(16) if n not in (READ, WRITE, PUSH)])
            words = [rng.getrandbits(32) for _ in range(rng.randint(1, 4))]
            return Sent(operation, base + r.CHANNEL_RATE_TARGET, words, Verdict.BAD_OPERATION)
        if kind == 9:
            length = rng.choice((0, 61, 62, 64, 128, 188, 255))
            operation = rng.choice((READ, WRITE, PUSH))
            address = base + r.CHANNEL_RATE_TARGET
            return Sent(operation, address, [0] * length, Verdict.BAD_LENGTH, length=length)
        if kind == 10:
            status = rng.randrange(self.parameters.channels)
            word = status << r.RUN_STATUS_CHANNEL_LSB
            return Sent(WRITE, r.ADDRESS_RUN, [word], Verdict.OK)
        known = {
            r.ADDRESS_IDENTIFICATION: [r.IDENTIFICATION_RESET],
            r.ADDRESS_RUN: [self.channel << r.RUN_STATUS_CHANNEL_LSB],
            base + r.CHANNEL_RATE: [self.rates[number]],
            base + r.CHANNEL_ROOM: [lines << r.CHANNEL_ROOM_LINE_ROOM_LSB | ramps],
            base + r.CHANNEL_POSITION_BASE: [0] * axes,
            r.ADDRESS_REFUSALS_0: self.counters(),
        }
        address, data = rng.choice(list(known.items()))
        return Sent(READ, address, [0] * len(data), Verdict.OK, data=data)

    def counters(self) -> list[int]:
        """The words that count refusals."""
        return [
            sum(self.refused[verdict] % 256 << 8 * n for n, verdict in enumerate(COUNTED[at : at + 4]))
            for at in (0, 4)
        ]

    def exchange(self, chosen: Sent | None = None) -> None:
        """Send a frame and judge the reply; one that is drawn may have a bad CRC."""
        rng, sent = self.rng, chosen or self.draw()
        length = len(sent.words) if sent.length < 0 else sent.length
        sequence = self.sequence if rng.random() < 0.2 else rng.getrandbits(8)
        header = sent.operation << 28 | sequence << 20 | length << 12 | sent.address
        request = [header] if sent.operation == READ else [header, *sent.words]
        crc = frame.crc(request)
        verdict = sent.verdict
        headed = sent.operation in (READ, WRITE, PUSH) and 0 < length <= frame.PAYLOAD_MAX
        if headed and sent.operation != READ and self.known and sequence == self.sequence:
            verdict = Verdict.DUPLICATE
        if chosen is None and rng.random() < 0.12:
            crc ^= 1 << rng.randrange(32)
            verdict = Verdict.BAD_CRC
        mosi = [*request, crc, 0, 0] if sent.operation != READ else [header, crc, 0, *[0] * length, 0]
        where = f"operation {sent.operation} of {length} at 0x{sent.address:03X}"
        miso = self.engine.transfer(mosi, 100)
        ack = sequence << 8 | verdict
        ack = ack << 16 | ~ack & 0xFFFF
        status = self.status
        if sent.operation == READ and verdict == Verdict.OK:
            assert miso[:3] == [status] * 3, f"{where}: status"
            data = miso[3:-1]
            assert sent.data in (None, data), f"{where}: {data} instead of {sent.data}"
            assert miso[-1] == frame.crc([header, *data]), f"{where}: CRC of the reply"
        else:
            before = 3 if sent.operation == READ else len(mosi) - 1
            assert miso[:before] == [status] * before, f"{where}: status"
            assert miso[before:] == [ack] * (len(mosi) - before), f"{where}: {verdict.name} is due"
        self.note(sent, sequence, verdict)

    def cut(self) -> None:
        """A frame that ends before its CRC does nothing."""
        rng = self.rng
        words = [WRITE << 28 | rng.getrandbits(8) << 20 | 1 << 12 | r.ADDRESS_RUN, 0, rng.getrandbits(32)]
        mosi = b"".join(word.to_bytes(4, "big") for word in words)
        self.engine.select(True)
        self.engine.run(4)
        self.engine.pace(1, 1)
        self.engine.exchange(mosi[: rng.randrange(len(mosi))], 2)
        self.engine.run(4)
        self.engine.select(False)
        self.engine.run(20)

    def count(self) -> None:
        """Read how many frames have been refused."""
        data = self.counters()
        self.exchange(Sent(READ, r.ADDRESS_REFUSALS_0, [0] * len(data), Verdict.OK, data=data))

    def note(self, sent: Sent, sequence: int, verdict: Verdict) -> None:
        """What it has changed."""
        if verdict in self.refused:
            self.refused[verdict] += 1
        if verdict != Verdict.OK or sent.operation == READ:
            return
        self.sequence, self.known = sequence, True
        number = (sent.address - r.ADDRESS_CHANNEL_BASE) // r.ADDRESS_CHANNEL_STRIDE
        if sent.address == r.ADDRESS_RUN:
            self.channel = sent.words[0] >> r.RUN_STATUS_CHANNEL_LSB
            return
        self.room[number][0] -= sent.lines
        self.room[number][1] -= sent.ramps
        if sent.operation == WRITE:
            self.rates[number] = sent.words[0]


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Exchange many frames, and cut some short.

    Raises:
        AssertionError: A reply is not as it is known to be.
    """
    frames = Frames(engine, parameters, rng)
    for number in range(FRAMES):
        if number % 8 == 7:
            frames.cut()
        frames.exchange()
    frames.count()
    refused = (
        Sent(WRITE, r.ADDRESS_IDENTIFICATION, [0], Verdict.READ_ONLY),
        Sent(WRITE, NO_REGISTER, [0], Verdict.UNKNOWN_ADDRESS),
    )
    for sent in refused:  # each is the first one after a reset
        engine.set("rst", 1)
        engine.run(rng.randint(1, 9))
        engine.set("rst", 0)
        engine.run(100)
        frames = Frames(engine, parameters, rng)
        frames.count()
        frames.exchange(sent)
        frames.count()


CHECK = Check("frames", "frames", check)
