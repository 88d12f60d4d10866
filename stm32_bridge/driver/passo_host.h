/* SPDX-License-Identifier: MIT
 * The link library: the host end of the SPI link. Each frame is executed exactly once, or an error is
 * returned.
 *
 * Every write and push carries a sequence number, 1 .. 255 (0 is the number of a core after reset). It is
 * resent with the same number until the reply is valid, up to `tries` times in total; the core executes a
 * number once and acknowledges repetitions as duplicates. The program provides a function that exchanges
 * words and, optionally, a clock and a wait function.
 *
 * A write that was given up may have been executed, but cannot be executed later: its number is not reused
 * until a valid reply has shown the last number that the core accepted.
 *
 *     passo_host_read, _write, _push     blocking: return when the outcome is known
 *     passo_host_post_..., _step         for a main loop: a step begins at most one chip select
 *
 * Not reentrant: a host belongs to one thread or main loop. No heap, no floating point.
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

/* Default number of attempts per frame, including the first. */
#define PASSO_TRIES 8u
/* Words at the end of the reply to a write that are evaluated: the status, repeated, and the ack. */
#define PASSO_REPLY_WORDS 5u

/* What the program provides. Only `transfer` is required; unused functions are null. */
struct passo_hardware {
	/* One chip select in SPI mode 0: exchanges `words` words (1 .. PASSO_FRAME_WORDS_MAX), most
	 * significant bit first. Returns false on failure. The next one may follow immediately. */
	bool (*transfer)(void *context, const uint32_t *send, uint32_t *receive, size_t words);
	/* Free-running microsecond counter that wraps at 2^32. Without it waiting has no timeout. */
	uint32_t (*microseconds)(void *context);
	/* Called by passo_wait() when there is nothing to do for `microseconds`. It may return immediately,
	 * sleep for at most about that time, or do other work, but must not call the library. */
	void (*wait)(void *context, uint32_t microseconds);
	/* Level of the core's irq pin, which is high while a channel is stopped. Lets passo_poll() see a stop
	 * without delay. */
	bool (*irq)(void *context);
	/* `transfer` in two halves, by DMA, all three or none: the next frame of a stream is prepared in
	 * `spare`, of PASSO_FRAME_WORDS_MAX words, while one is in flight. `start` begins an exchange and
	 * returns; both arrays must not change until its end. `finish` returns PENDING during the exchange,
	 * then OK, or TRANSFER if it failed or takes too long; OK if there is none. Only the last
	 * PASSO_REPLY_WORDS received words matter. */
	bool (*start)(void *context, const uint32_t *send, uint32_t *receive, size_t words);
	enum passo_error (*finish)(void *context);
	uint32_t *spare;
	void *context; /* first argument of all functions */
	uint8_t tries; /* attempts per frame; 0: PASSO_TRIES */
};

/* Event counters since the host was opened; they wrap. */
struct passo_counters {
	uint32_t frames;   /* chip selects */
	uint32_t retries;  /* frames sent again */
	uint32_t stuck;    /* replies in which MISO never changed */
	uint32_t no_ack;   /* replies of a core that saw an incomplete frame */
	uint32_t damaged;  /* replies that failed their check */
	uint32_t sequence; /* replies that belong to another frame */
	uint32_t failed;   /* frames given up */
	/* rejected frames by response code; DUPLICATE: an earlier attempt was executed */
	uint32_t refused[PASSO_VERDICT_BAD_VALUE + 1u];
};

/* One core. All members are read-only for users. */
struct passo_host {
	struct passo_hardware hardware;
	struct passo_counters counters;
	uint32_t status;       /* last valid status word */
	uint32_t run;          /* last value written to the RUN register; 0: none */
	bool run_due;          /* `run` is not acknowledged and has to be written; see passo_host_write() */
	uint8_t line_words;    /* words of a line, for counting lines; 0: unknown */
	uint8_t channels;      /* of the core; 0: unknown */
	uint8_t last_sequence; /* sequence number of the last write sent */
	uint8_t sent_before;   /* of the write before that */
	uint8_t accepted;      /* of the last write known to be accepted by the core */
	uint8_t attempt;       /* attempts of the current frame */
	uint8_t proofs;        /* attempts to verify that the core has not been reset */
	bool opened;
	bool guarded;     /* resets of the core and writes of other hosts are detected */
	bool lost;        /* one was detected: passo_host_open() is required */
	bool fresh;       /* the core had not been written to since its reset when the host was opened */
	bool proving;     /* the current frame was executed; verifying that the core has not been reset */
	bool in_flight;   /* the current frame is being exchanged */
	uint8_t prepared; /* sequence number of the push in `ahead`; 0: none */
	/* Free queue entries of the status channel, a lower bound; 255: 255 or more. */
	uint8_t line_room, ramp_room;
	enum passo_error *posted;    /* destination of the posted frame's result; null: none */
	uint32_t table[PASSO_BANKS]; /* contents of the table banks; see passo_table.c */
	size_t words;                /* length of the current frame */
	uint32_t *send, *ahead; /* the current frame, and where the next push is prepared; may be equal */
	uint32_t frame[PASSO_FRAME_WORDS_MAX], receive[PASSO_FRAME_WORDS_MAX];
};

/* Connects to a core: reads the identification and the current sequence number, and writes nothing. *hardware
 * is copied. Errors: ARGUMENT, link errors, NOT_PASSO. */
enum passo_error passo_host_open(struct passo_host *host, const struct passo_hardware *hardware);

/* Starts to detect core resets and writes of other hosts: from then on every call returns CORE_RESET until
 * the host is opened again. Marks the core with a write that is rejected as READ_ONLY, which makes a reject
 * counter nonzero. `line_words` are the words of a line of the core. About two frames. Errors: ARGUMENT,
 * NOT_OPEN, link errors. */
enum passo_error passo_host_guard(struct passo_host *host, uint8_t line_words);

/* Read or write 1 .. 60 consecutive registers, or write all words to one register (push). `address` is a word
 * address. Errors: ARGUMENT, NOT_OPEN, link errors, CORE_RESET, REFUSED + verdict. After a link error it is
 * unknown whether a write was executed; it will not be executed later. If it was a write of RUN, `run` then
 * combines the old and the new value such that fewer motions can start, and `run_due` requests that it be
 * written. */
enum passo_error passo_host_read(struct passo_host *host, uint16_t address, uint32_t *words, size_t length);
enum passo_error passo_host_write(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length);
enum passo_error passo_host_push(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length);

/* Like passo_host_read, but with a single attempt. */
enum passo_error passo_host_read_once(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length);

/* Posts a write of a word, or the push that was prepared; passo_host_step() sends it. *result is PENDING
 * until the outcome is known. Other calls complete a posted frame first. Errors: ARGUMENT (also if a frame is
 * already pending, or while passo_host_is_unsure()), NOT_OPEN, CORE_RESET. */
enum passo_error passo_host_post_write(
    struct passo_host *host, uint16_t address, uint32_t word, enum passo_error *result);
enum passo_error passo_host_post_push(struct passo_host *host, enum passo_error *result);
/* Prepares a push of the `length` words in passo_host_payload(): also while a frame is posted if `ahead` is
 * not `send`, otherwise to be posted before any other call. */
uint32_t *passo_host_payload(struct passo_host *host);
void passo_host_prepare_push(struct passo_host *host, uint16_t address, size_t length);
/* Advances the posted frame: begins at most one chip select. Returns PENDING while a frame is posted and OK
 * otherwise; the result of the frame is in *result. */
enum passo_error passo_host_step(struct passo_host *host);
/* Abandons the posted frame as after its last attempt; its *result stays PENDING. If it is in flight, waits
 * for its end. */
void passo_host_drop(struct passo_host *host);
/* True if enough writes were given up that the next sequence number could be taken for a duplicate: a read
 * is required first. The blocking calls do it themselves. */
bool passo_host_is_unsure(const struct passo_host *host);

/* Recovers the status word by majority: at least three, and more than half, of the first `count` words of a
 * reply must be copies of it. Returns false if the reply is too corrupt. */
bool passo_host_status_of(const uint32_t *miso, size_t count, uint32_t *status);

#ifdef __cplusplus
}
#endif

#endif
