/* SPDX-License-Identifier: MIT
 * A simulated machine at the pins of an engine: axes that follow STEP and DIR, switches, noise and encoders,
 * and changes at a time, at a position or at the edge of an input.
 *
 * It is exact to the clock: it sees the outputs after each clock, and what it changes is seen by the core on
 * the next one, during frames as well. Equal rigs at two engines with the same outputs do the same.
 */
#ifndef PASSO_RIG_H
#define PASSO_RIG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_pins.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PASSO_RIG_WIRES 32u
#define PASSO_RIG_WHEELS 8u
#define PASSO_RIG_EVENTS 64u
#define PASSO_RIG_AXES 64u
#define PASSO_RIG_NOT_YET UINT64_MAX

/* An input of the core. It is inactive unless a switch or an event says otherwise. */
struct passo_rig_wire {
	uint8_t input, bit; /* enum passo_input, and which of its bits */
	bool inverted;      /* active low */
	bool is_switch;     /* it is active from position `at` of `axis` on, upward if `above` */
	bool above;
	uint8_t axis;
	uint8_t other; /* of a switch of an axis that two motors move: it is where their sum is `at`, */
	int8_t share;  /* of this sign; 0: where `axis` is */
	int64_t at, hysteresis;
	uint64_t bounce;        /* clocks of chatter after every change */
	uint64_t every, glitch; /* noise: mean clocks from one glitch to the next, 0: none; their length */
};

/* An encoder at an axis. Its counts come one by one, at least `gap` clocks apart. With an interval it is that
 * of a spindle, which turns by itself and has an index. */
struct passo_rig_wheel {
	uint8_t axis;
	int64_t ratio; /* counts per step, 2^16 */
	uint64_t gap;
	uint64_t interval; /* of a spindle: clocks per count at its mean speed, 2^16 */
	uint32_t wander;   /* by which its speed wanders either way, 2^16 of the mean */
	uint32_t per_turn; /* counts from index to index; of other encoders 0: without an index */
	uint64_t
	    start_up; /* clocks from rest to that speed; not 0: output 0 turns it on, output 1 reverses it */
	/* The same, 1 and up: the motor whose home input says that the spindle is at its speed; 0: none.
	 * Without `per_turn` it has no encoder. */
	uint8_t ready;
	bool inverted; /* that input is active low */
};

enum passo_rig_when { PASSO_RIG_TIME, PASSO_RIG_POSITION, PASSO_RIG_RISING, PASSO_RIG_FALLING };
enum passo_rig_what { PASSO_RIG_ACTIVE, PASSO_RIG_INACTIVE, PASSO_RIG_SLIP, PASSO_RIG_CALL };

struct passo_rig_event {
	uint8_t when, what; /* enum passo_rig_when, enum passo_rig_what */
	uint64_t clocks;    /* TIME: after the clock on which the first motion starts */
	uint8_t axis;       /* POSITION: on the step that takes this axis there */
	int64_t position;
	uint8_t source;  /* RISING, FALLING: the wire that becomes active or inactive, without its noise */
	uint8_t target;  /* wire that becomes active or inactive, or wheel that slips; CALL ends the run */
	uint64_t length; /* clocks until the wire is as before; 0: it stays */
	int64_t counts;  /* by which the wheel slips */
};

struct passo_rig_config {
	uint64_t seed;
	uint32_t axes; /* pins of STEP */
	uint32_t wires, wheels, events;
	struct passo_rig_wire wire[PASSO_RIG_WIRES];
	struct passo_rig_wheel wheel[PASSO_RIG_WHEELS];
	struct passo_rig_event event[PASSO_RIG_EVENTS];
	int64_t start[PASSO_RIG_AXES]; /* positions at the beginning */
};

/* What has happened. */
struct passo_rig_moment {
	uint64_t clock; /* PASSO_RIG_NOT_YET: it has not */
	int64_t positions[PASSO_RIG_AXES];
};

/* The levels of an input from the clock after `clock` on. */
struct passo_rig_change {
	uint64_t clock;
	uint64_t input;
	uint64_t levels;
};

struct passo_rig;

struct passo_rig *passo_rig_create(const struct passo_rig_config *config, struct passo_inputs *inputs);
void passo_rig_destroy(struct passo_rig *rig);

/* The next clock, after `clock`, after which the rig must act; UINT64_MAX: none. */
uint64_t passo_rig_next(const struct passo_rig *rig, uint64_t clock);
/* The outputs after a clock: moves the axes and changes the inputs. */
void passo_rig_follow(
    struct passo_rig *rig, uint64_t clock, const struct passo_outputs *outputs, struct passo_inputs *inputs);
/* Whether an event CALL has come since this was asked last. */
bool passo_rig_calls(struct passo_rig *rig);

/* A wheel slips now by `counts`, like with an event. */
void passo_rig_slip(struct passo_rig *rig, uint32_t wheel, int64_t counts);
/* Mean speed that a spindle with `start_up` is to have when it is on: 2^16 of that of its interval. */
void passo_rig_drive(struct passo_rig *rig, uint32_t wheel, uint32_t speed);
/* Whether it has that speed, and is on. */
bool passo_rig_at_speed(const struct passo_rig *rig, uint32_t wheel);
const struct passo_rig_moment *passo_rig_moment(const struct passo_rig *rig, uint32_t event);
int64_t passo_rig_position(const struct passo_rig *rig, uint32_t axis);
/* Moves up to `capacity` of the oldest changes of inputs to `changes`, of encoders only those of spindles;
 * returns their number. */
size_t passo_rig_drain(struct passo_rig *rig, struct passo_rig_change *changes, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
