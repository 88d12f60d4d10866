/* SPDX-License-Identifier: MIT
 * Every operation of the driver, and every way to end it early; docs/driver.md has the table.
 */
#ifndef SOAK_ENDINGS_ENDINGS_H
#define SOAK_ENDINGS_ENDINGS_H

#include "bench.h"

enum operation {
	OP_MOVE,
	OP_QUEUE, /* three moves, one behind the other */
	OP_PATH,
	OP_STREAM,
	OP_JOG,     /* by distance */
	OP_ENDLESS, /* jog */
	OP_GOTO,
	OP_HOME,
	OP_PROBE,
	OP_THREAD,
	OP_RASTER,
	OP_COMPARE,
	OP_TOGETHER,
	OPERATIONS
};

enum ending {
	END_CANCEL, /* passo_jog_cancel() */
	END_STOP,
	END_HOLD, /* and resume */
	END_ABORT,
	END_LIMIT, /* a hard one */
	END_SOFT_LIMIT,
	END_ALARM,
	END_ESTOP,
	END_TRIGGER,      /* its soft stop */
	END_HARD_TRIGGER, /* its hard stop */
	END_SILENCE,      /* of the host, until the watchdog trips */
	END_SECOND,       /* the call once more */
	ENDINGS
};

/* An operation that runs. */
struct scene {
	enum operation operation;
	enum ending ending;
	double speed, acceleration; /* steps/s, steps/s^2, of axis 0 */
	double bend;                /* the steepest slope of its profile, of the mean one */
	int32_t start[AXES], target[AXES];
	int32_t low[AXES], high[AXES]; /* between which it may go */
	double seconds;                /* how long it takes, about */
	uint64_t hold_clocks, stop_clocks;
	bool lines; /* both axes go in proportion */
};

const char *operation_name(enum operation operation);
/* Draws its numbers; begins it; after its polls. */
void operation_draw(struct bench *bench, struct scene *scene);
enum passo_error operation_begin(struct bench *bench, struct scene *scene);
enum passo_error operation_poll(struct bench *bench, const struct scene *scene);
/* Whether it is one of passo_jog() or passo_goto(). */
bool operation_is_jog(enum operation operation);

const char *ending_name(enum ending ending);
/* A history: one operation, ended early. `only`: of these, or OPERATIONS, ENDINGS. False if a promise was
 * broken. */
bool ending_play(
    struct bench *bench, uint32_t seed, enum operation operation, enum ending ending, struct scene *scene);

#endif
