/* SPDX-License-Identifier: MIT
 * Internal: the parts of the simulated machine.
 */
#ifndef PASSO_RIG_PARTS_H
#define PASSO_RIG_PARTS_H

#include "passo_rig.h"

struct wire {
	bool beyond;      /* the axis is at the switch */
	bool forced;      /* an event says whether it is active */
	bool active;      /* without noise and chatter */
	bool flipped;     /* by noise or chatter */
	uint64_t until;   /* end of chatter */
	uint64_t flips;   /* clock of the next flip */
	uint64_t release; /* end of what the event says */
};

struct wheel {
	int64_t slip, count;
	uint64_t next; /* clock after which the next count is possible */
	/* of a spindle */
	uint64_t due;              /* the same, 2^16 */
	int64_t from, to;          /* speeds between which it changes, 2^16 of the mean */
	uint32_t length, progress; /* counts of the change, and made; with `start_up`: ticks */
	/* of a spindle with `start_up`; 2^32 counts, per tick where they are speeds */
	int64_t angle, speed;
	uint32_t wanted; /* 2^16 of its greatest speed */
	bool there;      /* it has that, and is on */
};

struct passo_rig {
	struct passo_rig_config config;
	struct wire wire[PASSO_RIG_WIRES];
	struct wheel wheel[PASSO_RIG_WHEELS];
	struct passo_rig_moment moment[PASSO_RIG_EVENTS];
	int64_t position[PASSO_RIG_AXES];
	uint64_t step, random, started;
	bool calls;
	struct passo_rig_change *log;
	size_t length, capacity;
};

uint64_t rig_random(struct passo_rig *rig, uint64_t limit);

uint64_t rig_levels(const struct passo_inputs *inputs, enum passo_input input);
/* Whether this changes it. */
bool rig_set(struct passo_inputs *inputs, enum passo_input input, unsigned bit, bool level);

/* The axis of a switch has moved. */
void rig_switch(struct passo_rig *rig, unsigned number);
/* Noise and chatter of a wire. */
void rig_disturb(struct passo_rig *rig, unsigned number, bool changed, uint64_t clock);

/* Where a wheel belongs, in counts. */
int64_t rig_counts(const struct passo_rig *rig, unsigned number);
/* Makes a count if one is due. */
void rig_turn(struct passo_rig *rig, unsigned number, uint64_t clock, struct passo_inputs *inputs);
/* The same of a spindle; whether it has. */
bool rig_spin(struct passo_rig *rig, unsigned number, uint64_t clock, struct passo_inputs *inputs);
/* The same of a spindle that outputs turn on and reverse. */
bool rig_drive(
    struct passo_rig *rig, unsigned number, uint64_t clock, uint64_t outputs, struct passo_inputs *inputs);
/* The levels of A and B at the count of a wheel. */
void rig_show(const struct passo_rig *rig, unsigned number, struct passo_inputs *inputs);

#endif
