/* SPDX-License-Identifier: MIT
 * The core under test with a wire at its pins: one clock after another, and everything that its pins and its
 * replies tell is written down for the judge.
 *
 * The C model always runs. When a Verilated core is given it is the one under test: it gets the same inputs,
 * its replies are used, and its pins must be those of the model on every clock.
 */
#ifndef SOAK_WORLD_H
#define SOAK_WORLD_H

#include <stdio.h>

#include "engine_core.h"
#include "passo_core.h"
#include "passo_frame.h"

#define WORLD_PINS_MAX 64u
#define WORLD_TEXT 200u

/* The output pins from this clock on. */
struct world_row {
	uint64_t clock;
	struct passo_outputs pins;
};

/* What the host knows: it follows from what it sent and what the core answered. */
enum world_fact_kind {
	FACT_WRITE, /* an accepted word takes effect: words[0], address, words[1], value */
	FACT_LINE,  /* the last word of an accepted line: words[0], control, words[1 + i], steps */
	FACT_RAMP,  /* the last word of an accepted ramp: words[0], control */
	FACT_BUSY,  /* a frame was refused as BUSY: words[0], operation and address, words[1], first word */
	FACT_STATE, /* words[0 .. 2]: STATE, RATE, ROOM, not older than `clock` */
	FACT_READS, /* a position is going to be read */
	FACT_POSITION,  /* words[i]: position at some clock since FACT_READS */
	FACT_STATUS,    /* words[0]: status word when chip select fell */
	FACT_RESET,     /* rst rises */
	FACT_RESET_DONE /* rst has fallen */
};

struct world_fact {
	uint64_t clock;
	enum world_fact_kind kind;
	uint8_t channel;
	uint32_t words[1u + PASSO_AXES_MAX];
};

/* Clocks at which something changes, as the model has them. What is aimed at them is judged without. */
enum world_event_kind {
	EVENT_STATE,    /* state of the motion */
	EVENT_GAP,      /* a motion has ended, and the next one is prepared at once */
	EVENT_STOPPING, /* a soft stop begins */
	EVENT_SLEW,     /* slew tick while something moves */
	EVENT_RATE,     /* the rate changes */
	EVENT_LINE,     /* a line is taken, or turns around */
	EVENT_RAMP,     /* a ramp leaves its queue */
	EVENT_TICK,     /* a tick ends */
	EVENT_STEP,     /* edge of STEP */
	EVENT_DIR,      /* edge of DIR */
	EVENT_WAITS,    /* a step begins, or ceases, to wait at an axis */
	EVENT_QUIET,    /* the last axis has come to rest */
	EVENT_KINDS
};

struct world_event {
	uint64_t clock;
	enum world_event_kind kind;
	uint8_t channel;
};

/* An input pin that changes at a clock of its own, whatever is on the wire. */
struct world_pin {
	uint64_t clock;
	bool is_reset; /* or sync */
	bool level;
};

/* Clocks from the end of the CRC word, measured once. */
struct world_latency {
	int64_t enable, pins; /* to the pin, for the first word of a write */
	int64_t command;      /* to the STEP pin's last active edge that an abort lets through */
	int64_t check;        /* from the end of a payload word to its check */
};

struct world_rtl; /* functions of a shared library */

struct world {
	struct passo_core model;
	const struct world_rtl *rtl;
	struct engine_core *core; /* NULL: the model is under test */
	struct passo_inputs inputs;
	struct passo_outputs outputs; /* of the core under test */
	uint64_t clock;               /* executed */
	uint32_t half_period;         /* clocks of each level of SCLK */
	uint32_t setup;               /* clocks from chip select to SCLK */
	const struct world_latency *latency;

	struct world_pin pins[WORLD_PINS_MAX]; /* by clock */
	size_t pin_count, pin_next;
	uint32_t resets;                /* that rst is high for */
	uint64_t reset_at, reset_until; /* of the last reset; 0: none */
	uint8_t sequence;               /* of the last write */
	/* Enabled clocks from step to step while the channel moves at constant speed; 0: not known. */
	uint32_t gap_enabled[PASSO_CHANNELS_MAX][PASSO_AXES_MAX];

	struct world_row *rows;
	size_t row_count, row_room;
	struct world_fact *facts;
	size_t fact_count, fact_room;
	struct world_event *events; /* recorded from `events_from` on */
	size_t event_count, event_room;
	uint64_t events_from;
	uint64_t idle_since[PASSO_CHANNELS_MAX];
	FILE *record; /* for the bench that plays it; NULL: none */
	struct passo_inputs recorded_inputs;
	struct passo_outputs recorded_outputs;
	uint64_t recorded_clocks;

	bool blind;         /* the rate is judged by the steps alone; kept by world_open() */
	uint64_t failed_at; /* 0: nothing has */
	char failure[WORLD_TEXT];
};

/* Functions of the library of a Verilated core; NULL, with a message, if it cannot be loaded. */
const struct world_rtl *world_load(const char *library);

/* Power-up. False if the parameters do not fit the Verilated core. */
bool world_open(struct world *world, const struct passo_parameters *parameters, const struct world_rtl *rtl);
void world_close(struct world *world);
/* Writes the rest of the record. */
void world_end_record(struct world *world);

void world_run(struct world *world, uint64_t clocks);
/* Chip select falls, `bits` bits of the words are exchanged, chip select rises. */
void world_exchange(struct world *world, const uint32_t *mosi, uint32_t *miso, size_t count, size_t bits);

/* Adds an edge of an input pin; in any order, not in the past. */
void world_add_pin(struct world *world, struct world_pin pin);
void world_add_fact(struct world *world, const struct world_fact *fact);
/* The first failure counts. */
void world_fail(struct world *world, uint64_t clock, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Chip select to the clock on which word `index` of a write or push of `length` words shows at the pins, and
 * to the clock of its check. */
int64_t world_executes(const struct world *world, unsigned length, unsigned index);
int64_t world_checks(const struct world *world, unsigned index);

/* Measures the latencies on the model. */
bool world_measure(struct world_latency *latency);

#endif
