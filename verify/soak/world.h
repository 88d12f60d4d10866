/* SPDX-License-Identifier: MIT
 * The core under test with a link at its pins. Executes it clock by clock and records pins and replies for
 * the judge.
 *
 * The C model always runs. If a Verilated core is given, it is the one under test: it gets the same inputs,
 * its replies are used, and its pins must match those of the model on every clock.
 */
#ifndef SOAK_WORLD_H
#define SOAK_WORLD_H

#include <stdio.h>

#include "engine_core.h"
#include "passo_core.h"
#include "passo_frame.h"

#define WORLD_PINS_MAX 1024u
#define WORLD_TEXT 200u

/* Levels of the output pins from this clock on. */
struct world_row {
	uint64_t clock;
	struct passo_outputs pins;
};

/* Knowledge of the host, derived from its frames and the replies. */
enum world_fact_kind {
	FACT_WRITE, /* an accepted word takes effect: words[0], address, words[1], value */
	FACT_LINE,  /* the last word of an accepted line: words[0], control, words[1 + i], steps, then its
	               output */
	FACT_RAMP,  /* the last word of an accepted ramp: words[0], control */
	FACT_BUSY,  /* a frame was refused as BUSY: words[0], operation and address, words[1], first word */
	FACT_STATE, /* words[0 .. 2]: STATE, RATE, ROOM, not older than `clock` */
	FACT_READS, /* a read of positions starts */
	FACT_POSITION,  /* words[i]: position at some clock since FACT_READS */
	FACT_STATUS,    /* words[0]: status word when chip select fell */
	FACT_PIN,       /* words[0]: number of an input of the machine, words[1]: its new levels */
	FACT_FED,       /* a frame was executed */
	FACT_TRIGGER,   /* words[0]: TRIGGER_STATE */
	FACT_LATCH,     /* words[i]: latched position */
	FACT_COUNTS,    /* words[i]: encoder position at some clock since FACT_READS */
	FACT_FLAGS,     /* words[0]: INPUT_FLAGS */
	FACT_RESET,     /* rst rises */
	FACT_RESET_DONE /* rst has fallen */
};

struct world_fact {
	uint64_t clock;
	enum world_fact_kind kind;
	uint8_t channel;
	uint32_t words[2u + PASSO_AXES_MAX];
};

/* Events in the model at which disturbances can be aimed. The judge does not use them. */
enum world_event_kind {
	EVENT_STATE,    /* state of the motion */
	EVENT_GAP,      /* a motion has ended and the next one is prepared immediately */
	EVENT_STOPPING, /* a soft stop starts */
	EVENT_SLEW,     /* slew tick during a motion */
	EVENT_RATE,     /* the rate changes */
	EVENT_LINE,     /* a line is taken, or an endless line repeats */
	EVENT_RAMP,     /* a ramp leaves its queue */
	EVENT_TICK,     /* a tick ends */
	EVENT_STEP,     /* edge of STEP */
	EVENT_DIR,      /* edge of DIR */
	EVENT_WAITS,    /* a step enters or leaves the queue of an axis */
	EVENT_QUIET,    /* the last axis has become quiet */
	EVENT_KINDS
};

struct world_event {
	uint64_t clock;
	enum world_event_kind kind;
	uint8_t channel;
};

/* An edge of an input pin at a given clock, independent of the link. */
struct world_pin {
	uint64_t clock;
	enum passo_input input; /* PASSO_INPUT_COUNT: the shaft of an encoder turns */
	bool level;             /* of rst and sync */
	uint8_t mask;           /* other inputs: the bits that change */
	int32_t turn;           /* of axis `mask`, in counts */
};

/* The shaft of an encoder: turns with the steps of its axis if it is `coupled`, and as told. */
struct world_shaft {
	bool coupled;
	int32_t due;     /* counts still to be made */
	uint32_t period; /* clocks from one to the next */
	uint64_t next;
	uint8_t place; /* in the cycle of A and B */
};

/* Latencies in clocks from the end of the CRC word, measured once. */
struct world_latency {
	int64_t enable, pins; /* to the pin, for the first word of a write */
	int64_t command;      /* to the last active STEP edge that an abort lets through */
	int64_t check;        /* from the end of a payload word to its check */
};

struct world_rtl; /* functions of a shared library */

/* Mutants of a Verilated core, each of which plays a history in a process of its own. */
struct world_mutants {
	uint32_t *numbers; /* of those that live; 0: the core itself */
	size_t count;
};

struct world {
	struct passo_core model;
	const struct world_rtl *rtl;
	struct engine_core *core; /* NULL: the model is under test */
	struct passo_inputs inputs;
	struct passo_outputs outputs; /* of the core under test */
	uint64_t clock;               /* clocks executed */
	uint32_t half_period;         /* clocks per SCLK level */
	uint32_t setup;               /* clocks from chip select to SCLK */
	const struct world_latency *latency;

	struct world_pin pins[WORLD_PINS_MAX]; /* by clock */
	size_t pin_count, pin_next;
	uint32_t resets;                /* number of overlapping resets in progress */
	uint64_t reset_at, reset_until; /* of the last reset; 0: none */
	uint8_t sequence;               /* of the last write */
	/* Enabled clocks between steps while the channel moves at constant speed; 0: unknown. */
	uint32_t gap_enabled[PASSO_CHANNELS_MAX][PASSO_AXES_MAX];

	struct world_row *rows;
	size_t row_count, row_room;
	struct world_fact *facts;
	size_t fact_count, fact_room;
	struct world_event *events; /* recorded from `events_from` on */
	size_t event_count, event_room;
	uint64_t events_from;
	uint64_t idle_since[PASSO_CHANNELS_MAX];
	uint64_t known_from;   /* then come the moves of which all is known */
	uint64_t judged_until; /* from then on only what is expected of each single move; 0: to the end */
	struct passo_inputs levels;                /* of the inputs at rest */
	uint64_t noise;                            /* state of the random changes of inputs; 0: none */
	uint32_t noisy;                            /* a bit for each input that changes */
	struct world_shaft shafts[PASSO_AXES_MAX]; /* of channel 0 */
	FILE *record;                              /* stimulus for verify/soak/player.v; NULL: none */
	struct passo_inputs recorded_inputs;
	struct passo_outputs recorded_outputs;
	uint64_t recorded_clocks;

	/* not changed by world_open() */
	bool blind;                    /* the rate is judged by the steps alone */
	bool machine;                  /* a core with inputs, encoders and outputs */
	bool tries;                    /* that drives into its limit switches */
	bool starts;                   /* whose motions begin at active switches; the model may skip clocks */
	bool pokes;                    /* anything is written and anything happens at its pins; not judged */
	bool off;                      /* nothing fails: to show that without a judge no mutant is killed */
	bool alone;                    /* the Verilated core is not compared with the model */
	struct world_mutants *mutants; /* NULL: none */
	uint64_t failed_at;            /* clock of the first failure; 0: none */
	char failure[WORLD_TEXT];
};

/* Loads the library of a Verilated core; NULL, with a message, on failure. */
const struct world_rtl *world_load(const char *library);

/* Powers up the core. False if the parameters do not match the Verilated core. */
bool world_open(struct world *world, const struct passo_parameters *parameters, const struct world_rtl *rtl);
void world_close(struct world *world);
/* Completes the record; then deasserts the enables by e-stop, asynchronously. */
void world_end_record(struct world *world);
void world_record_estop(struct world *world);

void world_run(struct world *world, uint64_t clocks);
/* One chip select in which `bits` bits of the words are exchanged. */
void world_exchange(struct world *world, const uint32_t *mosi, uint32_t *miso, size_t count, size_t bits);

/* Words of a line. */
static inline unsigned world_line_words(const struct passo_parameters *parameters)
{
	return PASSO_LINE_WORDS((unsigned)parameters->axes - parameters->tracked) + parameters->outputs;
}

/* Schedules an edge of an input pin, in any order, but not in the past. */
void world_add_pin(struct world *world, struct world_pin pin);
/* Changes the pins that are due before a clock. */
void world_change_pins(struct world *world);
void world_add_fact(struct world *world, const struct world_fact *fact);
/* Records a failure; only the first one is kept. */
void world_fail(struct world *world, uint64_t clock, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Clocks from chip select until word `index` of a write or push of `length` words takes effect at the pins,
 * and until its check. */
int64_t world_executes(const struct world *world, unsigned length, unsigned index);
int64_t world_checks(const struct world *world, unsigned index);

/* Measures the latencies on the model. */
bool world_measure(struct world_latency *latency);

#endif
