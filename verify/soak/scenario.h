/* SPDX-License-Identifier: MIT
 * The scenario of a history: a random list of frames, sync edges and resets.
 */
#ifndef SOAK_PLOT_H
#define SOAK_PLOT_H

#include "world.h"

#define SCENARIO_ACTIONS_MAX 128u

/* xorshift64*, seeded by splitmix64: seed and number determine a history. */
struct scenario_random {
	uint64_t state;
};

void scenario_seed(struct scenario_random *random, uint64_t seed, uint64_t number);
/* 0 .. below - 1 */
uint32_t scenario_draw(struct scenario_random *random, uint32_t below);
/* True with a probability of `percent`. */
bool scenario_chance(struct scenario_random *random, uint32_t percent);
/* from .. to, log-uniform by powers of two. */
uint32_t scenario_log(struct scenario_random *random, uint32_t from, uint32_t to);

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
enum scenario_kind {
	SCENARIO_STOP,
	SCENARIO_ABORT,
	SCENARIO_CLEAR,
	SCENARIO_ZERO,
	SCENARIO_COMMAND, /* any bits */
	SCENARIO_RATE,
	SCENARIO_RATES, /* command, rate and slews in one frame */
	SCENARIO_SLEW,
	SCENARIO_DRAIN,
	SCENARIO_PINS,
	SCENARIO_ENABLE,
	SCENARIO_TIMING,
	SCENARIO_RUN,
	SCENARIO_SYNC,
	SCENARIO_RESET,
	SCENARIO_NOW,
	SCENARIO_MOTION,
	SCENARIO_TABLE,
	SCENARIO_READ,
	SCENARIO_BAD,
	/* of a machine */
	SCENARIO_LIMIT,
	SCENARIO_ALARM,
	SCENARIO_ESTOP,
	SCENARIO_HOME,
	SCENARIO_PROBE,
	SCENARIO_NOISE, /* glitches and flicker of any input */
	SCENARIO_TURN,  /* an encoder slips or is turned */
	SCENARIO_ARM,
	SCENARIO_SILENCE, /* the host says nothing until the watchdog trips */
	SCENARIO_MEASURE, /* a read of what was latched and counted */
	SCENARIO_KINDS
};

struct scenario {
	struct passo_parameters parameters;
	struct scenario_random random;
	uint32_t half_period, setup;
	struct action actions[SCENARIO_ACTIONS_MAX]; /* frames in order; pins in any order */
	size_t count, prologue;                      /* the first `prologue` actions set up the motions */
	bool waits;                                  /* for the sync input */
	uint32_t gap_enabled[PASSO_CHANNELS_MAX][PASSO_AXES_MAX];
	/* Of a machine: levels of its inputs, the coupled encoders, and the filters. */
	struct passo_inputs levels;
	uint8_t coupled;
	uint32_t filter, encoder_filter, shaft_period;
};

/* Parameters of the core with a machine, and the scenario of a history with one; `tries`: one that drives
 * into active limit switches again and again. */
struct passo_parameters scenario_machine_parameters(void);
void scenario_begin_machine(struct scenario *scenario, uint64_t seed, uint64_t number, bool tries);
/* The same core: motions that begin while its switches are active, or become so. */
void scenario_begin_starts(struct scenario *scenario, uint64_t seed, uint64_t number);
/* The same core, and nothing is set up. */
void scenario_begin_pokes(struct scenario *scenario, uint64_t seed, uint64_t number);
/* Draws an event of a machine. */
struct action scenario_machine_event(struct scenario *scenario, enum scenario_kind kind);

/* Parameter sets of the core. */
#define SCENARIO_SETS 3u
struct passo_parameters scenario_parameters(unsigned set);

/* Draws setup and motions. */
void scenario_begin(struct scenario *scenario, uint64_t seed, uint64_t number);
/* Appends an action, if there is room. */
void scenario_add(struct scenario *scenario, const struct action *action);
/* Draws a disturbance; it is not appended. */
struct action scenario_disturbance(struct scenario *scenario, enum scenario_kind kind);
enum scenario_kind scenario_kind(struct scenario *scenario);

const char *scenario_kind_name(enum scenario_kind kind);
/* Description of an action in one line. */
void scenario_print(const struct action *action, char *text, size_t size);
const char *scenario_event_name(enum world_event_kind kind);

#endif
