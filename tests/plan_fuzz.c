/* SPDX-License-Identifier: MIT
 * All planning functions with arguments of all sizes: plan_fuzz SEED SECONDS.
 *
 * Built with sanitizers it finds undefined behavior; by itself it finds plans that the core would refuse,
 * and errors that modify the plan. Prints how often each function succeeded and failed.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "passo_plan.h"
#include "passo_shapes.h"

static uint64_t state;

static uint64_t any(void)
{
	state ^= state << 13;
	state ^= state >> 7;
	state ^= state << 17;
	return state * UINT64_C(0x2545F4914F6CDD1D);
}

static uint64_t below(uint64_t limit)
{
	return any() % limit;
}

/* A number of any size, often near a power of two. */
static uint64_t sized(uint32_t bits)
{
	uint64_t value = any() >> (64 - bits) >> below(bits);
	switch (below(16)) {
	case 0:
		return 0;
	case 1:
		return UINT64_MAX >> (64 - bits);
	case 2:
		return UINT64_C(1) << below(bits);
	case 3:
		return (UINT64_C(1) << below(bits)) - 1;
	default:
		return value;
	}
}

/* UQ32.32 that is often sensible: a thousandth to some millions. */
static uint64_t quantity(void)
{
	return below(4) > 0 ? any() >> (8 + below(34)) : sized(64);
}

static uint64_t up_to(uint64_t speed)
{
	switch (below(4)) {
	case 0:
		return 0;
	case 1:
		return speed;
	case 2:
		return speed / (1 + below(1000));
	default:
		return quantity();
	}
}

static struct passo_machine some_machine(void)
{
	static const uint32_t clocks[] = {1000000, 12000000, 72000000, 100000000, UINT32_MAX};
	struct passo_machine machine = {clocks[below(5)], (uint8_t)(7 + below(10)), (uint8_t)(1 + below(8))};
	switch (below(64)) {
	case 0:
		machine.clock_hz = (uint32_t)sized(32);
		break;
	case 1:
		machine.tick_log2 = (uint8_t)any();
		break;
	case 2:
		machine.axes = (uint8_t)any();
		break;
	default:
		break;
	}
	return machine;
}

static void some_steps(int32_t steps[PASSO_AXES_MAX])
{
	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++) {
		int32_t count = (int32_t)(below(1000) > 0 ? sized(30) : PASSO_SUBSTEPS_MAX + 1u);
		steps[axis] = below(2) > 0 ? count : -count;
		if (below(1000) == 0)
			steps[axis] = below(2) > 0 ? INT32_MAX : INT32_MIN;
	}
}

static enum passo_profile some_profile(void)
{
	return (enum passo_profile)(below(50) > 0 ? below(4) : any() & 7);
}

static void some_table(uint16_t table[PASSO_TABLE_SIZE])
{
	uint32_t sum = 0;
	uint32_t step = (uint32_t)(1 + below(600));
	for (unsigned k = 0; k < PASSO_TABLE_SIZE; k++) {
		table[k] = (uint16_t)(sum < 65535 ? sum : 65535);
		sum += (uint32_t)below(step);
	}
	if (below(20) == 0)
		table[below(PASSO_TABLE_SIZE)] = (uint16_t)any();
}

/* -------------------------------------------------------------------------------------------- the plan ----
 */

enum kind { WHOLE, TURNING, RAMPS_ONLY };

static const char *function;
static uint64_t round_number;

static void expect(bool good, const char *what)
{
	if (good)
		return;
	fprintf(stderr, "round %" PRIu64 ", %s: %s\n", round_number, function, what);
	exit(1);
}

static void check_line(const struct passo_plan *plan, uint8_t axes, bool endless)
{
	const struct passo_line *line = &plan->line;
	uint32_t longest = 0;
	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++) {
		expect(line->steps[axis] <= line->substeps, "an axis has more steps than substeps");
		expect(axis < axes || line->steps[axis] == 0, "an axis that does not exist moves");
		longest = longest > line->steps[axis] ? longest : line->steps[axis];
	}
	expect(longest > 0 && line->substeps > 0, "the line is empty");
	expect(line->substeps <= PASSO_SUBSTEPS_MAX, "the line is too long");
	expect((uint64_t)longest * plan->oversampling == line->substeps, "M is not K * N");
	expect(plan->oversampling == 1 || plan->oversampling % 2 == 0, "K is odd");
	expect(line->endless == endless && line->last == !endless, "the line's flags are wrong");
}

static void check_ramps(const struct passo_plan *plan, uint8_t tick_log2, enum kind kind)
{
	uint64_t ticks = 0;
	expect(plan->ramp_count >= 1 && plan->ramp_count <= PASSO_PLAN_RAMPS_MAX,
	    "the number of ramps is wrong");
	for (uint32_t i = 0; i < plan->ramp_count; i++) {
		const struct passo_ramp *ramp = &plan->ramps[i];
		const bool final = i + 1 == plan->ramp_count;
		expect(ramp->velocity_end <= PASSO_VELOCITY_MAX, "a velocity is above 1/2");
		expect(ramp->velocity_end <= plan->velocity_peak || kind == RAMPS_ONLY,
		    "the peak is not the highest");
		expect((unsigned)ramp->shape <= PASSO_BANKS, "there is no such shape");
		expect(ramp->now == (kind == RAMPS_ONLY && i == 0), "NOW is wrong");
		if (kind == WHOLE)
			expect(ramp->last == final && (!final || ramp->velocity_end == 0),
			    "it does not end at rest");
		if (ramp->ticks > 0) {
			expect(ramp->progress_step > 0 && ramp->progress_step <= PASSO_PROGRESS_STEP_MAX,
			    "du is wrong");
			uint64_t last =
			    ramp->progress_step / 2 + (ramp->ticks - UINT64_C(1)) * ramp->progress_step;
			expect(last < PASSO_ONE_Q48, "progress goes beyond 1");
		}
		ticks += ramp->ticks;
	}
	expect(
	    kind == TURNING || ticks >> (44 - tick_log2) == 0 || kind == RAMPS_ONLY, "the move is too long");
	expect(kind != WHOLE || ticks > 0, "the move takes no time");
	uint64_t phases = (uint64_t)plan->accelerate_ticks + plan->cruise_ticks + plan->decelerate_ticks;
	expect(ticks == phases, "the phases are not the ramps");
}

/* ------------------------------------------------------------------------------------------- functions ----
 */

static enum passo_plan_error in_time(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_in_time move = {.profile = some_profile(), .total_clocks = sized(46)};
	some_steps(move.steps);
	move.ramp_clocks = up_to(move.total_clocks / 2);
	return passo_plan_in_time(machine, &move, plan);
}

static struct passo_move_by_speed some_by_speed(void)
{
	struct passo_move_by_speed move = {.profile = some_profile(), .speed = quantity()};
	some_steps(move.steps);
	move.start_speed = up_to(move.speed);
	move.stop_speed = up_to(move.speed);
	move.acceleration = below(3) > 0 ? quantity() : 0;
	move.deceleration = below(3) > 0 ? quantity() : 0;
	move.ramp_clocks = sized(45);
	return move;
}

static enum passo_plan_error by_speed(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_by_speed move = some_by_speed();
	return passo_plan_by_speed(machine, &move, plan);
}

static enum passo_plan_error below_speed(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_below_speed move = {
	    .profile = some_profile(), .total_clocks = sized(46), .speed = quantity()};
	some_steps(move.steps);
	passo_longest_ramp(machine->clock_hz, (uint32_t)any(), move.total_clocks, move.speed);
	return passo_plan_below_speed(machine, &move, plan);
}

static enum passo_plan_error at_speed(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_at_speed move = {
	    .profile = some_profile(), .speed = quantity(), .ramp_clocks = sized(45)};
	some_steps(move.steps);
	return passo_plan_at_speed(machine, &move, plan);
}

static enum passo_plan_error axes(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_axes move = {.speed = quantity(), .ramp_clocks = sized(45)};
	some_steps(move.steps);
	move.start_speed = up_to(move.speed);
	return passo_plan_axes(machine, &move, plan);
}

static enum passo_plan_error turn(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_turn move = {
	    .axis = (uint8_t)below(9),
	    .steps_per_turn = (uint32_t)sized(32),
	    .rpm = quantity(),
	    .acceleration = quantity(),
	};
	uint64_t angle = sized(64);
	memcpy(&move.angle, &angle, sizeof angle);
	move.minimum_rpm = up_to(move.rpm);
	passo_angle_of((int32_t)sized(31), move.steps_per_turn);
	passo_rpm_of(any(), (uint32_t)sized(32), machine->clock_hz, move.steps_per_turn);
	return passo_plan_turn(machine, &move, plan);
}

static struct passo_turning some_turning(void)
{
	struct passo_turning turning = {
	    .axis = (uint8_t)below(9),
	    .steps_per_turn = (uint32_t)sized(16),
	    .backward = below(2) > 0,
	    .top_rpm = quantity(),
	    .acceleration = quantity(),
	};
	turning.minimum_rpm = up_to(turning.top_rpm);
	return turning;
}

static enum passo_plan_error turning_start(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_turning turning = some_turning();
	return passo_plan_turning_start(machine, &turning, up_to(turning.top_rpm), plan);
}

static enum passo_plan_error turning_speed(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_turning turning = some_turning();
	return passo_plan_turning_speed(machine, &turning, sized(47), up_to(turning.top_rpm), plan);
}

static enum passo_plan_error turning_stop(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_turning turning = some_turning();
	return passo_plan_turning_stop(machine, &turning, sized(48), plan);
}

static enum passo_plan_error sigmoid(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_sigmoid move = {
	    .speed = quantity(),
	    .accelerate_clocks = sized(45),
	    .decelerate_clocks = sized(45),
	    .alpha = (uint32_t)(below(20) > 0 ? 3 * 4096 + below(2 * 4096 + 1) : any()),
	};
	some_steps(move.steps);
	move.start_speed = up_to(move.speed);
	move.stop_speed = up_to(move.speed);
	uint16_t table[PASSO_TABLE_SIZE];
	if (below(64) == 0)
		passo_sigmoid_table(move.alpha, table);
	return passo_plan_sigmoid(machine, &move, plan);
}

static enum passo_plan_error jerk(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_jerk move = {.speed = quantity(), .acceleration = quantity(), .jerk = quantity()};
	some_steps(move.steps);
	move.start_speed = up_to(move.speed);
	move.stop_speed = up_to(move.speed);
	return passo_plan_jerk(machine, &move, plan);
}

static enum passo_plan_error straight(const struct passo_machine *machine, struct passo_plan *plan)
{
	struct passo_move_straight move = {.feed = quantity()};
	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++) {
		uint64_t distance = below(4) > 0 ? quantity() : sized(64);
		memcpy(&move.distance[axis], &distance, sizeof distance);
		if (below(4) > 0)
			move.distance[axis] %= INT64_C(1) << 44;
		move.limits[axis] = (struct passo_axis_limits){
		    .steps_per_mm = below(50) > 0 ? 1 + sized(44) : sized(64),
		    .speed = quantity() + 1,
		    .acceleration = quantity() + 1,
		    .jerk = below(2) > 0 ? quantity() : 0,
		};
	}
	return passo_plan_straight(machine, &move, plan);
}

static enum passo_plan_error user_in_time(const struct passo_machine *machine, struct passo_plan *plan)
{
	uint16_t table[PASSO_TABLE_SIZE];
	some_table(table);
	const struct passo_user_shape shape = {(enum passo_shape)(1 + below(3)), table, below(2) > 0};
	struct passo_move_in_time move = {.total_clocks = sized(46)};
	some_steps(move.steps);
	move.ramp_clocks = up_to(move.total_clocks / 2);
	return passo_plan_user_in_time(machine, &move, &shape, plan);
}

static enum passo_plan_error user_by_speed(const struct passo_machine *machine, struct passo_plan *plan)
{
	uint16_t table[PASSO_TABLE_SIZE];
	some_table(table);
	const struct passo_user_shape shape = {
	    (enum passo_shape)(below(50) > 0 ? 1 + below(3) : any() & 7), table, below(2) > 0};
	struct passo_move_by_speed move = some_by_speed();
	return passo_plan_user_by_speed(machine, &move, &shape, plan);
}

static struct passo_course some_course(void)
{
	struct passo_course course = {
	    .axis = (uint8_t)below(below(20) > 0 ? PASSO_AXES_MAX : 256),
	    .backward = below(2) > 0,
	    .top_speed = quantity(),
	    .acceleration = quantity(),
	};
	course.speed = up_to(course.top_speed);
	return course;
}

static enum passo_plan_error course(const struct passo_machine *machine, struct passo_plan *plan)
{
	const struct passo_course made = some_course();
	return passo_plan_course(machine, &made, (uint32_t)sized(32), plan);
}

static enum passo_plan_error course_change(const struct passo_machine *machine, struct passo_plan *plan)
{
	const struct passo_course made = some_course();
	const uint64_t high = up_to(made.top_speed);
	return passo_plan_course_change(machine, &made, up_to(high), high, sized(64), plan);
}

static struct {
	const char *name;
	enum passo_plan_error (*call)(const struct passo_machine *machine, struct passo_plan *plan);
	enum kind kind;
	uint64_t planned, refused;
} functions[] = {
    {"in_time", in_time, WHOLE, 0, 0},
    {"by_speed", by_speed, WHOLE, 0, 0},
    {"below_speed", below_speed, WHOLE, 0, 0},
    {"at_speed", at_speed, WHOLE, 0, 0},
    {"axes", axes, WHOLE, 0, 0},
    {"turn", turn, WHOLE, 0, 0},
    {"turning_start", turning_start, TURNING, 0, 0},
    {"turning_speed", turning_speed, RAMPS_ONLY, 0, 0},
    {"turning_stop", turning_stop, RAMPS_ONLY, 0, 0},
    {"course", course, TURNING, 0, 0},
    {"course_change", course_change, RAMPS_ONLY, 0, 0},
    {"sigmoid", sigmoid, WHOLE, 0, 0},
    {"jerk", jerk, WHOLE, 0, 0},
    {"straight", straight, WHOLE, 0, 0},
    {"user_in_time", user_in_time, WHOLE, 0, 0},
    {"user_by_speed", user_by_speed, WHOLE, 0, 0},
};

int main(int count, char **arguments)
{
	if (count != 3)
		return 2;
	state = strtoull(arguments[1], NULL, 10) * 2 + 1;
	const clock_t end = clock() + (clock_t)(strtod(arguments[2], NULL) * CLOCKS_PER_SEC);
	const size_t functions_count = sizeof functions / sizeof *functions;

	while (round_number % 1024 != 0 || clock() < end) {
		size_t chosen = round_number % functions_count;
		struct passo_plan plan, before;
		memset(&plan, 0xA5, sizeof plan);
		memcpy(&before, &plan, sizeof plan);
		const struct passo_machine machine = some_machine();
		function = functions[chosen].name;
		enum passo_plan_error error = functions[chosen].call(&machine, &plan);
		if (error == PASSO_PLAN_OK) {
			if (functions[chosen].kind != RAMPS_ONLY)
				check_line(&plan, machine.axes, functions[chosen].kind == TURNING);
			check_ramps(&plan, machine.tick_log2, functions[chosen].kind);
			functions[chosen].planned++;
		} else {
			expect(memcmp(&plan, &before, sizeof plan) == 0, "a refused plan was touched");
			expect(strcmp(passo_plan_error_name(error), "UNKNOWN") != 0, "an error has no name");
			functions[chosen].refused++;
		}
		round_number++;
	}
	for (size_t i = 0; i < functions_count; i++)
		printf("%s %" PRIu64 " %" PRIu64 "\n", functions[i].name, functions[i].planned,
		    functions[i].refused);
	return 0;
}
