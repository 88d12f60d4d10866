/* SPDX-License-Identifier: MIT
 * The link library: the host's end of the SPI link. Frames are executed exactly once, or an error says why
 * not.
 *
 * Every write and push carries a sequence number (1 .. 255; 0 is what a core shows after reset). It is sent
 * again, with the same number, until the reply is clear, at most `tries` times: the core executes a number
 * only once and acknowledges the rest as duplicates. The library needs three things of its surroundings: a
 * function that exchanges words, and optionally a clock and a way to wait.
 *
 * A write that was given up may have been executed, but will not be later: its number is not used again
 * before a clear reply has told which number the core accepted last.
 *
 *     passo_host_read, _write, _push     blocking: return when the frame is settled
 *     passo_host_post_..., _step         for a main loop: each step is at most one chip select
 *
 * Not reentrant: one thread, or one main loop, uses a host. No heap, no floating point.
 */
#ifndef PASSO_HOST_H
#define PASSO_HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#include "passo_error.h"
#include "passo_frame.h"
#include "passo_shapes.h"

/* Tries of a frame, the first included, unless the hardware says otherwise. */
#define PASSO_TRIES 8u

/* What the library needs of the machine it runs on. Unused functions are null. */
struct passo_hardware {
	/* One chip select, SPI mode 0: sends `words` words (1 .. 64), the most significant bit first, and
	 * puts the words that came in at the same time into `receive`. Returns false if that was impossible.
	 */
	bool (*transfer)(void *context, const uint32_t *send, uint32_t *receive, size_t words);
	/* A clock that counts microseconds, starts anywhere and wraps at 2^32. Without it gaps and times are
	 * not kept: a frame that comes too early is then noticed and sent again, and waiting has no time
	 * limit. */
	uint32_t (*microseconds)(void *context);
	/* Called while passo_wait() waits; `microseconds` is how long there is nothing to do. It may return
	 * at once, sleep at most about so long, or do other work, but must not call the library. */
	void (*wait)(void *context, uint32_t microseconds);
	/* Level of the core's irq pin: a channel has stopped. With it a stop is seen without delay. */
	bool (*irq)(void *context);
	/* The first argument of all of them. */
	void *context;
	uint8_t tries; /* of each frame; 0: PASSO_TRIES */
	bool paced; /* transfer keeps the gap between frames by itself: 64 clocks of the core, 4 per word */
};

/* Since the host was opened; they wrap. */
struct passo_counters {
	uint32_t frames;   /* chip selects */
	uint32_t retries;  /* of them sent again */
	uint32_t stuck;    /* replies in which MISO never moved */
	uint32_t no_ack;   /* replies of a core that took the frame for unfinished */
	uint32_t damaged;  /* replies that do not agree with their check */
	uint32_t sequence; /* replies that belong to another frame */
	uint32_t failed;   /* frames given up */
	/* By verdict; DUPLICATE: an earlier try was executed. */
	uint32_t refused[PASSO_VERDICT_BAD_VALUE + 1u];
};

/* One core. All fields are read-only for users. */
struct passo_host {
	struct passo_hardware hardware;
	struct passo_counters counters;
	uint32_t status;       /* the last undamaged status word */
	uint32_t run;          /* what was written to the RUN register; 0: nothing */
	bool run_due;          /* that was not acknowledged: `run` is to be written, see passo_host_write() */
	uint32_t clock_hz;     /* of the core, for the gap between frames; 0: not known, no gap */
	uint32_t ready_at;     /* microseconds: when the core has executed the last frame */
	uint8_t axes;          /* of the core, for counting lines; 0: not known */
	uint8_t last_sequence; /* of the last write that was sent */
	uint8_t sent_before;   /* of the write before that */
	uint8_t accepted;      /* of the last write that the core is known to have accepted */
	uint8_t attempt;       /* of the present frame */
	uint8_t proofs;        /* tries to prove that the core is the same as before */
	bool opened;
	bool guarded; /* a core that was reset, or written to by others, is noticed */
	bool lost;    /* it was: nothing but passo_host_open() helps */
	bool fresh;   /* nobody had written to the core since its reset when the host was opened */
	bool proving; /* the present frame was executed, but by which core is still to be proved */
	/* Free places in the queues of the status channel: never more than there are; 255: or more. */
	uint8_t line_room, ramp_room;
	enum passo_error *posted;    /* where the result of the posted frame goes; null: none */
	uint32_t table[PASSO_BANKS]; /* what the banks of shapes hold; see passo_table.c */
	size_t words;                /* of the present frame */
	uint32_t send[PASSO_FRAME_WORDS_MAX], receive[PASSO_FRAME_WORDS_MAX];
};

/* Makes contact: reads the identification and learns the sequence number. Writes nothing. Errors: ARGUMENT,
 * those of the wire, NOT_PASSO. The hardware is copied. */
enum passo_error passo_host_open(struct passo_host *host, const struct passo_hardware *hardware);

/* From now on a core that was reset, or that others write to, is reported as CORE_RESET, by every call until
 * the host is opened again. It marks the core: a write that is refused as READ_ONLY makes a counter of
 * refusals other than 0. About two frames. `axes` and `clock_hz` are the core's. Errors: those of the wire.
 */
enum passo_error passo_host_guard(struct passo_host *host, uint8_t axes, uint32_t clock_hz);

/* Reads 1 .. 60 consecutive registers, writes so many, or writes all words to one register. Errors: ARGUMENT,
 * NOT_OPEN, those of the wire, CORE_RESET, REFUSED + verdict. After an error of the wire it is not known
 * whether a write was executed; it will not be executed later. If it was one of RUN, `run` is then what lets
 * fewer motions start, of this word and the one before, and `run_due` says that it has to be written. */
enum passo_error passo_host_read(struct passo_host *host, uint16_t address, uint32_t *words, size_t length);
enum passo_error passo_host_write(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length);
enum passo_error passo_host_push(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length);

/* Like passo_host_read, but with a single try. */
enum passo_error passo_host_read_once(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length);

/* Prepares a push, or a write, whose payload stands already in passo_host_payload(), and sends it in
 * passo_host_step(). *result is PENDING until it is settled; other calls settle it first. Only one frame can
 * be posted, and none before a read while passo_host_is_unsure(): ARGUMENT. */
uint32_t *passo_host_payload(struct passo_host *host);
enum passo_error passo_host_post_push(
    struct passo_host *host, uint16_t address, size_t length, enum passo_error *result);
enum passo_error passo_host_post_write(
    struct passo_host *host, uint16_t address, size_t length, enum passo_error *result);
/* At most one chip select for the posted frame; nothing if there is none. Returns PENDING while a frame is
 * posted, otherwise OK: the result is where it was asked for. */
enum passo_error passo_host_step(struct passo_host *host);
/* Gives up the posted frame, as after its last try; its result is not told. */
void passo_host_drop(struct passo_host *host);
/* So many writes were given up that the next number could pass for a duplicate: there must be a read first.
 * The blocking calls see to that themselves. */
bool passo_host_is_unsure(const struct passo_host *host);

/* The status word, of which at least three and more than half of the first `count` words of a reply are
 * copies; false: too damaged. */
bool passo_host_status_of(const uint32_t *miso, size_t count, uint32_t *status);

#ifdef __cplusplus
}
#endif

#endif
