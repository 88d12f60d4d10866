/* SPDX-License-Identifier: MIT
 * The plot of a history: a random list of frames, sync edges and resets.
 */
#ifndef SOAK_PLOT_H
#define SOAK_PLOT_H

#include "world.h"

#define PLOT_ACTIONS_MAX 128u

/* xorshift64*, seeded by splitmix64: seed and number determine a history. */
struct plot_random {
	uint64_t state;
};

void plot_seed(struct plot_random *random, uint64_t seed, uint64_t number);
/* 0 .. below - 1 */
uint32_t plot_draw(struct plot_random *random, uint32_t below);
/* True with a probability of `percent`. */
bool plot_chance(struct plot_random *random, uint32_t percent);
/* from .. to, log-uniform by powers of two. */
uint32_t plot_log(struct plot_random *random, uint32_t from, uint32_t to);

enum action_kind { ACTION_FRAME, ACTION_SYNC, ACTION_RESET, ACTION_INPUT };

/* Fault of a frame. */
enum action_fault { FAULT_NONE, FAULT_CRC, FAULT_REPEATED, FAULT_CUT, FAULT_VALUE };

struct action {
	enum action_kind kind;
	uint64_t at; /* earliest clock */
	/* chip select high before a frame, length of a sync pulse or reset, time from edge to edge */
	uint32_t clocks;
	enum passo_input input; /* that `edges` edges invert at `mask`, or the shaft that turns */
	uint8_t mask;
	uint16_t edges;
	int32_t turn;
	uint16_t operation, address, length;
	enum action_fault fault;
	uint16_t bits; /* length of a cut frame */
	uint32_t payload[PASSO_FRAME_PAYLOAD_MAX];
	/* its target, for printing; EVENT_KINDS: none */
	enum world_event_kind event;
	uint64_t event_clock;
	int32_t offset;
	char point;
};

/* Kinds of disturbances. */
enum plot_kind {
	PLOT_STOP,
	PLOT_ABORT,
	PLOT_CLEAR,
	PLOT_ZERO,
	PLOT_COMMAND, /* any bits */
	PLOT_RATE,
	PLOT_RATES, /* command, rate and slews in one frame */
	PLOT_SLEW,
	PLOT_DRAIN,
	PLOT_PINS,
	PLOT_ENABLE,
	PLOT_TIMING,
	PLOT_RUN,
	PLOT_SYNC,
	PLOT_RESET,
	PLOT_NOW,
	PLOT_MOTION,
	PLOT_TABLE,
	PLOT_READ,
	PLOT_BAD,
	/* of a machine */
	PLOT_LIMIT,
	PLOT_ALARM,
	PLOT_ESTOP,
	PLOT_HOME,
	PLOT_PROBE,
	PLOT_NOISE, /* glitches and flicker of any input */
	PLOT_TURN,  /* an encoder slips or is turned */
	PLOT_ARM,
	PLOT_SILENCE, /* the host says nothing until the watchdog bites */
	PLOT_MEASURE, /* a read of what was latched and counted */
	PLOT_KINDS
};

struct plot {
	struct passo_parameters parameters;
	struct plot_random random;
	uint32_t half_period, setup;
	struct action actions[PLOT_ACTIONS_MAX]; /* frames in order; pins in any order */
	size_t count, prologue;                  /* the first `prologue` actions set up the motions */
	bool waits;                              /* for the sync input */
	uint32_t gap_enabled[PASSO_CHANNELS_MAX][PASSO_AXES_MAX];
	/* Of a machine: levels of its inputs, the coupled encoders, and the filters. */
	struct passo_inputs levels;
	uint8_t coupled;
	uint32_t filter, encoder_filter, shaft_period;
};

/* Parameters of the core with a machine, and the plot of a history with one; `tries`: one that drives into
 * active limit switches again and again. */
struct passo_parameters plot_machine_parameters(void);
void plot_begin_machine(struct plot *plot, uint64_t seed, uint64_t number, bool tries);
/* The same core: motions that begin while its switches are active, or become so. */
void plot_begin_starts(struct plot *plot, uint64_t seed, uint64_t number);
/* The same core, and nothing is set up. */
void plot_begin_pokes(struct plot *plot, uint64_t seed, uint64_t number);
/* Draws an event of a machine. */
struct action plot_machine_event(struct plot *plot, enum plot_kind kind);

/* Parameter sets of the core. */
#define PLOT_SETS 3u
struct passo_parameters plot_parameters(unsigned set);

/* Draws setup and motions. */
void plot_begin(struct plot *plot, uint64_t seed, uint64_t number);
/* Appends an action, if there is room. */
void plot_add(struct plot *plot, const struct action *action);
/* Draws a disturbance; it is not appended. */
struct action plot_disturbance(struct plot *plot, enum plot_kind kind);
enum plot_kind plot_kind(struct plot *plot);

const char *plot_kind_name(enum plot_kind kind);
/* Description of an action in one line. */
void plot_print(const struct action *action, char *text, size_t size);
const char *plot_event_name(enum world_event_kind kind);

#endif
