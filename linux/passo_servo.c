/* SPDX-License-Identifier: MIT
 * A line for each period, ramps that are prolonged in time, and the loop on the depth of the queue.
 *
 * All lines run under one velocity, half a substep per clock. The last ramp in the core always holds its
 * velocity for the cover, then goes down to 0 in the stop time: a shape of its own. It is prolonged by the
 * same ramp with NOW, after one up to full speed where that is lost, if the lines in the core reach to the
 * end of its deceleration.
 */
#include "passo_servo.h"

#include "passo_math.h"
#include "passo_words.h"

#define ONE_Q16 (UINT32_C(1) << 16)
#define VELOCITY PASSO_VELOCITY_MAX /* UQ0.48 substeps per clock */
#define VELOCITY_Q32 (VELOCITY >> 16)
#define GRAIN 2u /* clocks of a substep */
#define NANOSECONDS UINT64_C(1000000000)
#define MICROSECOND 1000u /* ns */
#define POLLS 4u
#define HOLD_RAMP 1u          /* the last one of a push: holds, then goes down */
#define RISE_RAMP 2u          /* before it, unless there is full speed; at the start a jump to it */
#define BANK PASSO_SHAPE_EASE /* its table is replaced */
#define NEARLY_Q16 64u        /* below full speed: less than the rounding of a line */
#define HALVINGS 8u
#define FREE 8u     /* lines that a queue must have beyond the lag */
#define STARTING 2u /* calls until the core begins */
/* The line that is running, and a period since the depth was read. */
#define UNSURE 1u

/* The loop: the depth is smoothed over 2^10 periods. 2^-12 of its error is the trim, and 2^-26 of the sum of
 * the errors: critically damped with 2^-13 rad per period, at 1 kHz a bandwidth of 0.02 Hz. */
#define SMOOTH_LOG2 10u
#define TRIM_LOG2 40u /* UQ0.40 */
#define PART_LOG2 4u  /* Q31.32 lines to 2^-12 of it in UQ0.40 */
#define SUM_LOG2 18u
#define PPM_Q40 INT64_C(1099512)
#define SUM_MAX ((1000 * PPM_Q40) << SUM_LOG2)
#define PPB 1000

static int64_t between(int64_t value, int64_t least, int64_t most)
{
	return value < least ? least : value > most ? most : value;
}

static uint32_t now(const struct passo_servo *servo)
{
	const struct passo_hardware *hardware = &servo->passo->host->hardware;

	return hardware->microseconds(hardware->context);
}

static uint32_t microseconds(const struct passo_servo *servo, uint32_t periods)
{
	return (uint32_t)((uint64_t)periods * servo->options.period_ns / MICROSECOND);
}

/* Rounded to nearest; a right shift of a negative number is not portable. */
static int32_t to_steps(int64_t place)
{
	const uint64_t size = (passo_size64(place) + PASSO_UNIT_Q32 / 2u) >> 32;

	return place < 0 ? -(int32_t)size : (int32_t)size;
}

static int64_t over(int64_t value, uint32_t log2)
{
	return value / (INT64_C(1) << log2);
}

/* ---------------------------------------------------------------------------------------- commands ---- */

/* How fast an axis may approach a command that is `way` off, so that it arrives with half its change. */
static int64_t approach(int64_t way, uint64_t change)
{
	const uint64_t root = passo_isqrt128(passo_multiply(change, passo_size64(way)));
	const uint64_t size = root < passo_size64(way) ? root : passo_size64(way);

	return way < 0 ? -(int64_t)size : (int64_t)size;
}

static void follow(struct passo_servo *servo, unsigned axis, int64_t command)
{
	const int64_t top = (int64_t)servo->top[axis], change = (int64_t)servo->change[axis];
	const int64_t before = servo->speed[axis];
	const int64_t wanted = command - servo->command[axis]
	                     + approach(servo->command[axis] - servo->place[axis], servo->change[axis]);
	const int64_t speed = between(between(wanted, before - change, before + change), -top, top);

	servo->limited |= (uint32_t)(speed != wanted) << axis;
	servo->command[axis] = command;
	servo->place[axis] += speed;
	servo->speed[axis] = speed;
}

static uint32_t waiting(const struct passo_servo *servo)
{
	return servo->head - servo->tail;
}

static void add_line(struct passo_servo *servo, const int64_t *commands)
{
	struct passo_servo_line *line = &servo->line[servo->head++ % PASSO_SERVO_LINES];

	servo->limited = 0;
	line->output = servo->output;
	for (unsigned axis = 0; axis < servo->options.axes; axis++) {
		follow(servo, axis, commands[axis]);
		const int32_t steps = to_steps(servo->place[axis]);
		line->steps[axis] = steps - servo->steps[axis];
		servo->steps[axis] = steps;
	}
	if (servo->rest > 0u)
		servo->rest--; /* this line is one of the lag */
}

/* ------------------------------------------------------------------------------------------- items ---- */

/* Substeps of the next line; what is left over goes to those after it. */
static uint32_t length(struct passo_servo *servo)
{
	const int64_t trim = between(-over(servo->error, PART_LOG2) - over(servo->sum, SUM_LOG2),
	    -PASSO_SERVO_TRIM_MAX * PPM_Q40, PASSO_SERVO_TRIM_MAX * PPM_Q40);
	const uint64_t change = passo_mul_shift(servo->substeps, passo_size64(trim), TRIM_LOG2);

	servo->trim = (int32_t)(trim * PPB / PPM_Q40);
	servo->part += trim < 0 ? servo->substeps - change : servo->substeps + change;
	const uint32_t substeps = (uint32_t)(servo->part >> 32);
	servo->part &= PASSO_UNIT_Q32 - 1u;
	return substeps;
}

static bool give_line(void *context, struct passo_line *line)
{
	struct passo_servo *servo = context;

	if (servo->rest == 0u && waiting(servo) == 0u)
		return false;
	line->substeps = length(servo);
	if (servo->rest > 0u) {
		servo->rest--;
		line->directions = servo->directions;
		line->output = servo->output;
		return true;
	}
	const struct passo_servo_line *next = &servo->line[servo->tail++ % PASSO_SERVO_LINES];
	for (unsigned axis = 0; axis < servo->options.axes; axis++) {
		const int32_t steps = next->steps[axis];
		line->steps[axis] = steps < 0 ? 0u - (uint32_t)steps : (uint32_t)steps;
		if (steps != 0)
			servo->directions =
			    (uint8_t)((servo->directions & ~(1u << axis)) | (unsigned)(steps < 0) << axis);
	}
	line->directions = servo->directions;
	line->output = next->output;
	return true;
}

/* Ticks of a time in periods, UQ48.16. */
static uint32_t ticks(const struct passo_servo *servo, uint64_t periods)
{
	const uint64_t clocks = passo_mul_shift(servo->substeps * GRAIN, periods, 48);
	const uint64_t found = clocks >> passo_machine(servo->passo)->tick_log2;

	return found > 1u ? (uint32_t)found : 1u;
}

/* Periods of the ramp that holds and goes down, UQ48.16. */
static uint64_t hold_time(const struct passo_servo *servo)
{
	return servo->cover + ((uint64_t)servo->stop << 16);
}

/* It is prolonged every `buffer` periods, and then the program may be late by as many; the frames take a part
 * of one. */
static uint32_t cover_of(const struct passo_servo *servo)
{
	return 2u * servo->options.buffer + 1u;
}

/* Points of its shape while it holds. */
static uint32_t hold_points(uint32_t cover, uint32_t stop)
{
	return (PASSO_TABLE_SIZE * cover + cover + stop - 1u) / (cover + stop);
}

static enum passo_error load_shape(struct passo_servo *servo)
{
	const uint32_t held = hold_points(cover_of(servo), servo->stop), rest = PASSO_TABLE_SIZE - held;
	uint16_t points[PASSO_TABLE_SIZE];

	for (uint32_t k = 0; k < PASSO_TABLE_SIZE; k++)
		points[k] = k < held ? 0u : (uint16_t)(((k - held) * ONE_Q16 + rest / 2u) / rest);
	return passo_load_table(servo->passo, BANK, points);
}

static void set_ramp(struct passo_ramp *ramp, uint64_t velocity, uint32_t ticks)
{
	*ramp = (struct passo_ramp){
	    .velocity_end = velocity,
	    .ticks = ticks,
	    .progress_step = ticks > 1u ? (PASSO_ONE_Q48 + ticks / 2u) / ticks : PASSO_PROGRESS_STEP_MAX,
	};
}

static bool give_ramp(void *context, struct passo_ramp *ramp)
{
	struct passo_servo *servo = context;
	const bool runs = servo->phase == PASSO_SERVO_RUNS;

	if (runs && servo->ramps == servo->due
	    && (passo_snapshot(servo->passo)->ramp_room < servo->due
	        || now(servo) - servo->decided_at > microseconds(servo, 1) / 2u))
		servo->ramps = 0; /* it was decided too long ago, or the two would be parted */
	if (servo->ramps == 0u)
		return false;
	if (servo->ramps == RISE_RAMP) {
		set_ramp(ramp, (VELOCITY >> 16) * servo->to,
		    runs ? ticks(servo, (uint64_t)(servo->to - servo->from) * servo->stop) : 0u);
	} else {
		set_ramp(ramp, 0, ticks(servo, hold_time(servo)));
		ramp->shape = BANK;
		servo->pushed_at = servo->decided_at;
		servo->calls = 0;
	}
	ramp->now = runs && servo->ramps == servo->due;
	servo->ramps--;
	return true;
}

/* -------------------------------------------------------------------------------------- the ramps ---- */

/* Lines that the ramps take to their end: from a speed to another, which is held, then down to 0; UQ48.16. */
static uint64_t lines_of(const struct passo_servo *servo, uint64_t from, uint64_t to)
{
	/* the shape keeps its proportions, so that it goes down in the whole stop time from any speed */
	return ((from + to) * (to - from) * servo->stop
	           + to * (2u * (uint64_t)servo->cover + ((uint64_t)servo->stop << 16)))
	    >> 17;
}

/* The highest speed that the lines in the core allow, at least `from`; 0: they do not allow even that. */
static uint32_t reachable(const struct passo_servo *servo, uint32_t from)
{
	const uint64_t lines = servo->depth > UNSURE ? (uint64_t)(servo->depth - UNSURE) << 16 : 0u;
	uint32_t least = from, most = ONE_Q16;

	if (lines_of(servo, from, ONE_Q16) <= lines)
		return ONE_Q16;
	if (lines_of(servo, from, from) > lines)
		return 0;
	for (unsigned i = 0; i < HALVINGS; i++) {
		const uint32_t middle = (least + most) / 2u;
		if (lines_of(servo, from, middle) <= lines)
			least = middle;
		else
			most = middle;
	}
	return least;
}

/* Decides on the next pair of ramps: in time, from full speed; otherwise from the speed that the core has. */
static enum passo_error decide(struct passo_servo *servo)
{
	const uint32_t since = now(servo) - servo->pushed_at;
	const bool sure =
	    servo->full && since + microseconds(servo, 1) < microseconds(servo, servo->cover >> 16);
	uint32_t from = ONE_Q16;

	if (++servo->calls < servo->options.buffer)
		return PASSO_OK;
	servo->decided_at = now(servo);
	if (!sure) {
		struct passo_snapshot snapshot;
		const enum passo_error error = passo_read_state(servo->passo, &snapshot);

		if (error != PASSO_OK || snapshot.state != PASSO_STATE_RUN)
			return error; /* the next poll tells why */
		from = (uint32_t)(snapshot.velocity >> 15);
		servo->slowed += servo->full && from + NEARLY_Q16 < ONE_Q16;
		servo->full = from + NEARLY_Q16 >= ONE_Q16;
		servo->depth = servo->places - snapshot.line_room;
	}
	const uint32_t to = reachable(servo, from);
	if (to == 0u)
		return PASSO_OK; /* it decelerates until there are more lines */
	servo->from = from;
	servo->to = to;
	servo->ramps = servo->due = to > from ? RISE_RAMP : HOLD_RAMP;
	return PASSO_OK;
}

/* ------------------------------------------------------------------------------------------- loop ---- */

static void control(struct passo_servo *servo)
{
	const int64_t error = ((int64_t)servo->depth - servo->lag) * (int64_t)PASSO_UNIT_Q32;

	servo->error += over(error - servo->error, SMOOTH_LOG2);
	if (servo->full)
		servo->sum = between(servo->sum + servo->error, -SUM_MAX, SUM_MAX);
}

/* What is sent no more would leave the core at rest, but in motion. */
static enum passo_error fail(struct passo_servo *servo, enum passo_error error)
{
	passo_servo_stop(servo);
	return error;
}

static bool is_sending(const struct passo_servo *servo)
{
	return servo->passo->host->posted != NULL;
}

/* Sends what there is, with at most `polls` frames. */
static enum passo_error send(struct passo_servo *servo, uint32_t polls)
{
	enum passo_error error = PASSO_OK;

	while (error == PASSO_OK && polls-- > 0u
	       && (servo->rest > 0u || waiting(servo) > 0u || servo->ramps > 0u || is_sending(servo)))
		error = passo_poll(servo->passo);
	return error;
}

static enum passo_error fill(struct passo_servo *servo)
{
	enum passo_error error = send(servo, POLLS);

	if (error != PASSO_OK || servo->rest > 0u || waiting(servo) > 0u || servo->ramps > 0u
	    || is_sending(servo))
		return error;
	error = passo_stream_start(servo->passo);
	if (error != PASSO_OK)
		return error;
	servo->phase = PASSO_SERVO_RUNS;
	servo->pushed_at = now(servo);
	return PASSO_OK;
}

static enum passo_error run(struct passo_servo *servo)
{
	const struct passo_host *host = servo->passo->host;
	enum passo_error error = send(servo, POLLS);

	servo->depth = servo->places - host->line_room;
	if (error == PASSO_OK)
		error = decide(servo);
	if (error == PASSO_OK && servo->ramps > 0u)
		error = send(servo, POLLS);
	control(servo);
	if (error == PASSO_OK
	    && (++servo->looked >= PASSO_SERVO_LOOK || passo_unpack_status(host->status).any_stopped)) {
		servo->looked = 0;
		error = passo_poll(servo->passo);
	}
	return error;
}

/* ------------------------------------------------------------------------------------------ calls ---- */

static enum passo_servo_problem check_axis(struct passo_servo *servo, uint8_t axis)
{
	const struct passo_servo_axis *limits = &servo->options.axis[axis];
	const uint32_t period = servo->options.period_ns;
	const uint64_t highest = passo_highest_speed(servo->passo, axis, PASSO_UNIT_Q32);

	servo->axis = axis;
	servo->top[axis] = passo_mul_div(limits->speed, period, NANOSECONDS);
	servo->change[axis] =
	    passo_mul_div(passo_mul_div(limits->acceleration, period, NANOSECONDS), period, NANOSECONDS);
	if (servo->top[axis] == 0u)
		return PASSO_SERVO_SPEED;
	if (servo->change[axis] == 0u)
		return PASSO_SERVO_ACCELERATION;
	if (limits->stop == 0u)
		return PASSO_SERVO_STOP;
	/* a line may be shorter by the trim, and round up a step */
	if (limits->speed > highest - highest / (1000000u / PASSO_SERVO_TRIM_MAX)
	    || servo->top[axis] > servo->substeps - servo->substeps / 64u)
		return PASSO_SERVO_PINS;
	const uint64_t stop =
	    passo_mul_div_ceil(passo_mul_div_ceil(limits->speed, NANOSECONDS, limits->stop), 1, period);
	if (stop > UINT16_MAX)
		return PASSO_SERVO_LAG;
	if (stop > servo->stop)
		servo->stop = (uint32_t)stop;
	return PASSO_SERVO_OK;
}

static enum passo_servo_problem check(struct passo_servo *servo)
{
	const struct passo_servo_options *options = &servo->options;
	const struct passo_machine *machine = passo_machine(servo->passo);

	if (options->period_ns < PASSO_SERVO_PERIOD_MIN || options->period_ns > PASSO_SERVO_PERIOD_MAX)
		return PASSO_SERVO_PERIOD;
	servo->axis = options->axes;
	if (options->axes == 0u || options->axes > machine->axes)
		return PASSO_SERVO_AXES;
	servo->substeps = passo_mul_div(
	    (uint64_t)machine->clock_hz * options->period_ns, PASSO_UNIT_Q32, NANOSECONDS * GRAIN);
	for (uint8_t axis = 0; axis < options->axes; axis++) {
		const enum passo_servo_problem problem = check_axis(servo, axis);
		if (problem != PASSO_SERVO_OK)
			return problem;
	}
	const uint32_t held = hold_points(cover_of(servo), servo->stop);
	if (held == PASSO_TABLE_SIZE)
		return PASSO_SERVO_LAG;
	servo->cover = (uint32_t)(((uint64_t)servo->stop * held << 16) / (PASSO_TABLE_SIZE - held));
	servo->lag =
	    (uint32_t)((lines_of(servo, ONE_Q16, ONE_Q16) + ONE_Q16 - 1u) >> 16) + PASSO_SERVO_MARGIN;
	return servo->lag + FREE > servo->places ? PASSO_SERVO_LAG : PASSO_SERVO_OK;
}

enum passo_error passo_servo_check(
    struct passo_servo *servo, struct passo *passo, const struct passo_servo_options *options)
{
	struct passo_snapshot snapshot;

	if (!servo || !passo || !options)
		return PASSO_ERROR_ARGUMENT_POINTER;
	const enum passo_error error = passo_read_state(passo, &snapshot);
	if (error != PASSO_OK)
		return error;
	if (!passo->host->hardware.microseconds)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (snapshot.state != PASSO_STATE_IDLE && snapshot.state != PASSO_STATE_STOPPED)
		return PASSO_ERROR_MOVING;
	*servo = (struct passo_servo){.passo = passo, .options = *options, .places = snapshot.line_room};
	if (options->buffer == 0u || options->buffer > PASSO_SERVO_LINES)
		servo->options.buffer = options->buffer == 0u ? PASSO_SERVO_BUFFER : PASSO_SERVO_LINES;
	servo->problem = check(servo);
	return servo->problem == PASSO_SERVO_OK ? PASSO_OK : PASSO_ERROR_ARGUMENT;
}

static enum passo_error take_over(struct passo_servo *servo)
{
	const uint64_t stop = (servo->substeps * GRAIN >> 32) * servo->stop;
	struct passo_snapshot snapshot;
	enum passo_error error = passo_read_state(servo->passo, &snapshot);

	if (error == PASSO_OK && snapshot.state != PASSO_STATE_IDLE)
		error = passo_clear(servo->passo);
	if (error == PASSO_OK)
		error = passo_configure_motion(servo->passo, stop, stop, 0);
	if (error == PASSO_OK)
		error = load_shape(servo);
	return error == PASSO_OK ? passo_positions(servo->passo, servo->steps) : error;
}

enum passo_error passo_servo_start(struct passo_servo *servo)
{
	const struct passo_source source = {.line = give_line, .ramp = give_ramp, .context = servo};

	if (!servo || !servo->passo || servo->problem != PASSO_SERVO_OK)
		return PASSO_ERROR_NOT_PREPARED;
	enum passo_error error = take_over(servo);
	if (error == PASSO_OK)
		error = passo_stream(servo->passo, &source);
	if (error != PASSO_OK)
		return error;
	for (unsigned axis = 0; axis < servo->options.axes; axis++) {
		servo->command[axis] = servo->place[axis] = servo->steps[axis] * (int64_t)PASSO_UNIT_Q32;
		servo->speed[axis] = 0;
	}
	servo->rest = servo->lag - STARTING;
	servo->head = servo->tail = 0;
	servo->ramps = servo->due = RISE_RAMP;
	servo->from = servo->to = ONE_Q16;
	servo->full = true;
	servo->error = 0; /* the difference of the clocks is still the same */
	servo->depth = servo->lag;
	servo->looked = 0;
	servo->phase = PASSO_SERVO_FILLS;
	return PASSO_OK;
}

enum passo_error passo_servo_write(struct passo_servo *servo, const int64_t *commands)
{
	if (!servo || !commands)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (servo->phase == PASSO_SERVO_OFF)
		return PASSO_ERROR_NOT_PREPARED;
	if (waiting(servo) == PASSO_SERVO_LINES)
		return fail(servo, PASSO_ERROR_FULL);
	add_line(servo, commands);
	const enum passo_error error = servo->phase == PASSO_SERVO_FILLS ? fill(servo) : run(servo);
	return error == PASSO_OK ? PASSO_OK : fail(servo, error);
}

enum passo_error passo_servo_stop(struct passo_servo *servo)
{
	if (!servo || servo->phase == PASSO_SERVO_OFF)
		return PASSO_ERROR_NOT_PREPARED;
	servo->phase = PASSO_SERVO_OFF;
	return passo_stop(servo->passo);
}

bool passo_servo_is_on(const struct passo_servo *servo)
{
	return servo && servo->phase != PASSO_SERVO_OFF;
}
