/* SPDX-License-Identifier: MIT
 * Each axis in one pass over the rows.
 */
#include "passo_pulses.h"

#include <math.h>
#include <string.h>

/* Substeps: the rounding to clocks is centered at full speed, ... */
static const double EARLY = 0.25;
/* ... the steps of the leading axis are at whole substeps, those of the others are not. */
static const double LATE = 1.25, LATE_LEADING = 0.25;
static const int64_t LATENCY = 8;      /* clocks from the substep to the pin */
static const int64_t FAR = 1000000000; /* clocks */

/* A place in a curve: that of the last time asked for, where the next one is near. */
struct curve {
	const struct passo_pulse_plan *plan;
	size_t place;
};

struct judge {
	const struct passo_pulse_pins *pins;
	const struct passo_pulse_plan *plan; /* of the next step */
	size_t plans;                        /* left, with this one */
	unsigned axis;
	int64_t begin;            /* clock of the plan */
	int64_t first, steps;     /* step of the plan, and how many it has */
	double latest;            /* substeps that they may be late, beside its tolerance */
	struct curve at, before;  /* at the clock of a step, and before what may have held it up */
	int64_t step;             /* number of the next one */
	int64_t rise, fall, turn; /* clocks of the last ones */
	int64_t turns;            /* of DIR since the last step */
	int64_t early_turn;       /* clock at which DIR changed in a pulse; -FAR: it did not */
	int direction;            /* of the last step; 0: there is none */
	int wanted;               /* that it should have */
	struct passo_pulse_fault *faults, *of_curve;
	bool found;
};

static void tell(
    struct judge *judge, struct passo_pulse_fault *fault, int64_t step, int64_t value, double off)
{
	judge->found = true;
	if (!fault->found)
		*fault = (struct passo_pulse_fault){.found = true, .step = step, .value = value, .off = off};
}

/* Linear between the points. */
static double place_at(struct curve *curve, double time)
{
	const double *times = curve->plan->times, *places = curve->plan->places;
	const size_t last = curve->plan->points - 1u;
	size_t i = curve->place;

	while (i > 0u && times[i] > time)
		i--;
	while (i < last && times[i + 1u] <= time)
		i++;
	curve->place = i;
	if (i == last || times[i] >= time)
		return places[i];
	return (places[i + 1u] - places[i]) / (times[i + 1u] - times[i]) * (time - times[i]) + places[i];
}

static int64_t magnitude(int64_t steps)
{
	return steps < 0 ? -steps : steps;
}

/* Of the plan of the next step; the axes with the most steps have them at whole substeps. */
static double latest_of(const struct judge *judge)
{
	const struct passo_pulse_plan *plan = judge->plan;
	bool leads = plan->oversampled;

	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		leads = leads && magnitude(plan->steps[i]) <= magnitude(plan->steps[judge->axis]);
	return leads ? LATE_LEADING : LATE;
}

static void take_plan(struct judge *judge)
{
	judge->steps = magnitude(judge->plan->steps[judge->axis]);
	judge->latest = latest_of(judge);
	judge->at = judge->before = (struct curve){judge->plan, 0};
}

/* Each plan has its faults of the curve. */
static void go_to_plan(struct judge *judge)
{
	while (judge->plans > 0u && judge->step - judge->first >= judge->steps) {
		judge->first += judge->steps;
		judge->begin += judge->plan->clocks;
		judge->plan++;
		judge->of_curve += 2;
		if (--judge->plans > 0u)
			take_plan(judge);
	}
}

/* Whether the step is where the curve of its plan says, unless the pins kept it waiting. */
static void judge_curve(struct judge *judge, int64_t clock, bool turned, int64_t gap)
{
	const struct passo_pulse_pins *pins = judge->pins;
	const struct passo_pulse_plan *plan = judge->plan;
	const int64_t turning = pins->dir_hold + pins->dir_setup;
	const bool waited = gap <= pins->step_high + pins->step_low + (turned ? turning + LATENCY : 0);
	const int64_t time = clock - judge->begin;
	const int64_t asked = time - LATENCY - (turned ? pins->step_low + turning : 0);
	const double number = (double)(judge->step - judge->first) + 0.5;
	const double due = number * (double)plan->substeps / (double)judge->steps;
	const double lead = place_at(&judge->at, (double)time) - due;

	if (lead < -EARLY - plan->tolerance)
		tell(judge, &judge->of_curve[0], judge->step, clock, fabs(lead));
	if (!waited && !(place_at(&judge->before, (double)asked) - due <= judge->latest + plan->tolerance))
		tell(judge, &judge->of_curve[1], judge->step, clock, fabs(lead));
}

static void rises(struct judge *judge, int64_t clock, bool back)
{
	const struct passo_pulse_pins *pins = judge->pins;
	struct passo_pulse_fault *faults = judge->faults;
	const int direction = back ? -1 : 1, wanted_before = judge->wanted;
	const bool turned = direction != judge->direction;

	if (judge->step > 0 && clock - judge->fall < pins->step_low)
		tell(judge, &faults[PASSO_PULSE_LOW], judge->step, clock - judge->fall, 0);
	if (clock - judge->turn < pins->dir_setup)
		tell(judge, &faults[PASSO_PULSE_SETUP], judge->step, clock - judge->turn, 0);
	go_to_plan(judge);
	if (judge->plans > 0u) {
		judge->wanted = judge->plan->steps[judge->axis] < 0 ? -1 : 1;
		if (direction != judge->wanted)
			tell(judge, &faults[PASSO_PULSE_DIRECTION], judge->step, direction, 0);
		const int64_t needed = judge->wanted != wanted_before ? 1 : 0;
		if (judge->turns != needed)
			tell(judge, &faults[PASSO_PULSE_TURNS], judge->step, judge->turns, (double)needed);
		judge_curve(judge, clock, turned, clock - judge->rise);
	}
	judge->rise = clock;
	judge->direction = direction;
	judge->turns = 0;
	judge->step++;
}

static void falls(struct judge *judge, int64_t clock)
{
	const int64_t high = clock - judge->rise, low = judge->pins->step_low;

	if (high != judge->pins->step_high)
		tell(judge, &judge->faults[PASSO_PULSE_HIGH], judge->step - 1, high, 0);
	if (judge->early_turn != -FAR)
		tell(judge, &judge->faults[PASSO_PULSE_HOLD], judge->early_turn,
		    judge->early_turn - clock - low, 0);
	judge->early_turn = -FAR;
	judge->fall = clock;
}

static void turns(struct judge *judge, int64_t clock, bool in_pulse)
{
	const int64_t held = clock - judge->fall - judge->pins->step_low;

	if (in_pulse && judge->early_turn == -FAR)
		judge->early_turn = clock;
	else if (!in_pulse && held < judge->pins->dir_hold)
		tell(judge, &judge->faults[PASSO_PULSE_HOLD], clock, held, 0);
	judge->turn = clock;
	judge->turns++;
}

static uint64_t clock_of(const uint8_t *row)
{
	uint64_t clock = 0;

	for (unsigned i = 0; i < 8u; i++)
		clock |= (uint64_t)row[i] << 8u * i;
	return clock;
}

/* STEP or DIR of an axis, in a row or, without one, before. */
static bool level_of(const uint8_t *row, unsigned pin, unsigned axis)
{
	return row && ((uint32_t)row[8u + pin] >> axis & 1u) != 0u;
}

size_t passo_pulses_steps(
    const uint8_t *rows, size_t count, uint64_t start, unsigned axis, int64_t *clocks, int8_t *directions)
{
	bool was = false;
	size_t steps = 0;

	for (size_t i = 0; i < count; i++, rows += PASSO_PULSES_ROW) {
		const bool step = level_of(rows, 0, axis);

		if (step && !was) {
			clocks[steps] = (int64_t)(clock_of(rows) - start);
			directions[steps++] = level_of(rows, 1, axis) ? -1 : 1;
		}
		was = step;
	}
	return steps;
}

/* DIR first: a step in the same clock has the new direction. */
static void judge_axis(struct judge *judge, const uint8_t *rows, size_t count, uint64_t start)
{
	const uint8_t *before = NULL;

	for (size_t i = 0; i < count; i++, rows += PASSO_PULSES_ROW) {
		const bool step = level_of(rows, 0, judge->axis), was = level_of(before, 0, judge->axis);
		const bool back = level_of(rows, 1, judge->axis);

		if (back != level_of(before, 1, judge->axis))
			turns(judge, (int64_t)(clock_of(rows) - start), was);
		if (step && !was)
			rises(judge, (int64_t)(clock_of(rows) - start), back);
		else if (!step && was)
			falls(judge, (int64_t)(clock_of(rows) - start));
		before = rows;
	}
	if (level_of(before, 0, judge->axis)) {
		/* the clocks of the pulses are those of pairs of edges: without the last one, they say
		 * nothing */
		memset(judge->faults, 0, PASSO_PULSE_EARLY * sizeof *judge->faults);
		tell(judge, &judge->faults[PASSO_PULSE_HIGH], judge->step - 1, PASSO_PULSE_ENDLESS, 0);
	} else if (judge->turns != 0) {
		tell(judge, &judge->faults[PASSO_PULSE_TURNS], judge->step, judge->turns, 0);
	}
}

bool passo_pulses_judge(const uint8_t *rows, size_t count, uint64_t start,
    const struct passo_pulse_pins *pins, const struct passo_pulse_plan *plan, size_t plans, unsigned axes,
    struct passo_pulse_fault *faults)
{
	const size_t kinds = PASSO_PULSE_EARLY + 2u * plans;
	bool found = false;

	memset(faults, 0, axes * kinds * sizeof *faults);
	for (unsigned i = 0; i < axes; i++, faults += kinds) {
		struct judge judge = {.pins = pins,
		    .plan = plan,
		    .plans = plans,
		    .axis = i,
		    .rise = -FAR,
		    .fall = -FAR,
		    .turn = -FAR,
		    .early_turn = -FAR,
		    .wanted = 1,
		    .faults = faults,
		    .of_curve = faults + PASSO_PULSE_EARLY};

		if (plans > 0u)
			take_plan(&judge);
		judge_axis(&judge, rows, count, start);
		found = found || judge.found;
	}
	return found;
}
