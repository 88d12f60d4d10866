/* SPDX-License-Identifier: MIT
 * What is going to happen in a history: a list of frames, edges of sync and resets, drawn at random.
 */
#ifndef SOAK_PLOT_H
#define SOAK_PLOT_H

#include "world.h"

#define PLOT_ACTIONS_MAX 64u

/* xorshift64*, seeded by splitmix64: a history is known by its seed and number. */
struct plot_random {
	uint64_t state;
};

void plot_seed(struct plot_random *random, uint64_t seed, uint64_t number);
/* 0 .. below - 1 */
uint32_t plot_draw(struct plot_random *random, uint32_t below);
/* True in `percent` of 100. */
bool plot_chance(struct plot_random *random, uint32_t percent);
/* from .. to, all powers of two alike. */
uint32_t plot_log(struct plot_random *random, uint32_t from, uint32_t to);

enum action_kind { ACTION_FRAME, ACTION_SYNC, ACTION_RESET };

/* How a frame is spoilt. */
enum action_fault { FAULT_NONE, FAULT_CRC, FAULT_REPEATED, FAULT_CUT, FAULT_VALUE };

struct action {
	enum action_kind kind;
	uint64_t at;     /* not before this clock */
	uint32_t clocks; /* chip select high before a frame; length of a sync pulse or reset */
	uint16_t operation, address, length;
	enum action_fault fault;
	uint16_t bits; /* of a frame that is cut */
	uint32_t payload[PASSO_FRAME_PAYLOAD_MAX];
	/* at what it was aimed, for people; kind EVENT_KINDS: at nothing */
	enum world_event_kind event;
	uint64_t event_clock;
	int32_t offset;
	char point;
};

/* The parts of a disturbance that make sense together. */
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
	PLOT_KINDS
};

struct plot {
	struct passo_parameters parameters;
	struct plot_random random;
	uint32_t half_period, setup;
	struct action actions[PLOT_ACTIONS_MAX]; /* frames in their order; pins in any */
	size_t count, prologue;                  /* the first ones set up the motions */
	bool waits;                              /* for sync */
	uint32_t gap_enabled[PASSO_CHANNELS_MAX][PASSO_AXES_MAX];
};

/* The core's parameters for a history. */
#define PLOT_SETS 3u
struct passo_parameters plot_parameters(unsigned set);

/* Set-up and motions. */
void plot_begin(struct plot *plot, uint64_t seed, uint64_t number);
/* One more action, if there is room. */
void plot_add(struct plot *plot, const struct action *action);
/* A disturbance; not yet in the list. */
struct action plot_disturbance(struct plot *plot, enum plot_kind kind);
enum plot_kind plot_kind(struct plot *plot);

const char *plot_kind_name(enum plot_kind kind);
/* One line for people. */
void plot_print(const struct action *action, char *text, size_t size);
const char *plot_event_name(enum world_event_kind kind);

#endif
