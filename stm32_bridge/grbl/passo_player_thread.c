/* SPDX-License-Identifier: MIT
 * Threads: each pass begins at the index of the spindle, with a run-in that catches up with it. A rigid one
 * is made back in the same phase: behind its target the line continues with the spindle reversed, until
 * counts come back; then it is made once more, by counts the other way round.
 *
 * Where a count says c, the line is made up to c + 1/2, both ways: so steps are within half a count of their
 * angle. The spindle is slow while it reverses: what the host needs for that is less than a count of it.
 */
#include "passo_driver.h"
#include "passo_math.h"
#include "passo_outputs.h"
#include "passo_player_private.h"

#ifndef PASSO_WITHOUT_THREADS

#define SPEED_MICROSECONDS 10000u /* in which the speed of the spindle is measured */
#define RATIO_ONE (UINT32_C(1) << 16)
#define CLOCKS_PER_COUNT 32u /* at least, of the core */
#define LEVELS_AT 16u        /* in the output word */
#define NUDGES_PER_SECOND 2000u
#define MARGIN(speed) ((speed) + (speed) / 4u) /* of a spindle whose speed wanders */

static struct passo_output output_of(const struct passo_player_thread *thread, uint32_t toggled)
{
	const uint32_t word = thread->output ^ toggled;

	return (struct passo_output){
	    .levels = (uint8_t)(word >> LEVELS_AT), .power = word & PASSO_POWER_FULL};
}

/* Counts go up in the sense in which the spindle turns, or is to turn. */
static enum passo_error set_encoder(struct passo_player *player, bool back)
{
	const bool reverse = (player->thread.output & PASSO_GCODE_OUTPUT_REVERSE) != 0u;
	const struct passo_encoder_config config = {.inverted = reverse != back,
	    .ratio = RATIO_ONE,
	    .limit = UINT16_MAX,
	    .stop = PASSO_FOLLOWING_SHOW};

	return passo_configure_encoder(player->feed->passo, player->machine->spindle, &config);
}

static enum passo_error read_encoder(struct passo_player *player, struct passo_encoder_reading *reading)
{
	return passo_read_encoder(player->feed->passo, player->machine->spindle, reading);
}

/* Steps of the axes at a place. */
static void steps_at(const struct passo_player *player, const int64_t *place, int64_t *steps)
{
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++) {
		const uint64_t twice = passo_mul_div(passo_size64(place[axis]),
		    player->machine->axis[axis].steps_per_mm, (uint64_t)PASSO_GCODE_MILLION << 31);

		steps[axis] = (int64_t)((twice + 1u) / 2u) * (place[axis] < 0 ? -1 : 1);
	}
}

/* Speed and run of a thread that makes `steps` of an axis in `counts`. */
static void limit(struct passo_player *player, unsigned axis, uint64_t steps, uint32_t counts)
{
	const struct passo_path_axis *limits = &player->machine->axis[axis];
	struct passo_player_thread *thread = &player->thread;
	const uint64_t scale = limits->steps_per_mm, one = UINT64_C(1) << 32, speed = MARGIN(thread->speed);

	if (steps == 0u)
		return;
	const uint64_t top = passo_mul_div(passo_mul_div(limits->speed, scale, one), counts, steps);
	const uint64_t change = passo_mul_div(limits->acceleration, scale, one);
	const uint64_t run = passo_mul_div(speed, passo_mul_div(speed, steps, counts), change) >> 32;
	thread->top_speed = top < thread->top_speed ? top : thread->top_speed;
	thread->run = run >= thread->run ? (uint32_t)(run < UINT16_MAX ? run + 1u : UINT16_MAX) : thread->run;
}

/* Where a line of `counts` follows the last one, an axis changes its speed immediately. It may by as much as
 * is within the junction deviation at its acceleration, or by its start-stop speed. */
static void limit_corner(struct passo_player *player, unsigned axis, int64_t steps, uint32_t counts)
{
	const struct passo_path_axis *limits = &player->machine->axis[axis];
	struct passo_player_thread *thread = &player->thread;
	const unsigned corner = thread->pass.lines - 2u;
	const uint32_t before = thread->pass.line[corner].half_counts / 2u;
	const uint64_t change = passo_size64(steps * before - thread->way[axis] * (int64_t)counts);
	const struct passo_u128 square = passo_multiply(limits->acceleration, player->machine->deviation);
	const uint64_t rounded = passo_isqrt128(passo_u128_shift_left(square, 3));
	const uint64_t most = limits->jump > rounded ? limits->jump : rounded;

	if (change == 0u)
		return;
	const uint64_t speed = passo_mul_div(
	    passo_mul_div(most, limits->steps_per_mm, UINT64_C(1) << 32), (uint64_t)before * counts, change);
	thread->corner_speed[corner] =
	    speed < thread->corner_speed[corner] ? speed : thread->corner_speed[corner];
}

/* Adds the line of the action to the pass. */
static void add_line(struct passo_player *player)
{
	const struct passo_gcode_action *action = &player->action;
	const struct passo_path_planner *path = player->feed->path;
	struct passo_player_thread *thread = &player->thread;
	struct passo_pass_line *line = &thread->pass.line[thread->pass.lines++];
	int64_t begin[PASSO_AXES_MAX] = {0}, end[PASSO_AXES_MAX] = {0};
	struct passo_u128 square = {0, 0};

	thread->line = action->line;
	steps_at(player, thread->end, begin);
	steps_at(player, action->target, end);
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++) {
		const uint64_t way = passo_size64(action->target[axis] - thread->end[axis]);

		square = passo_u128_add(square, passo_multiply(way, way));
		thread->end[axis] = action->target[axis];
	}
	const uint64_t turns = 2u * (uint64_t)player->gcode->settings.turn_counts;
	const uint64_t twice = passo_mul_div(passo_isqrt128(square), turns, action->pitch);
	const uint32_t counts = twice < UINT32_C(1) << 30 ? (uint32_t)(twice + 1u) / 2u : 0u;
	line->half_counts = 2u * counts;
	if (thread->pass.lines > 1u)
		thread->corner_speed[thread->pass.lines - 2u] = UINT64_MAX;
	for (unsigned axis = 0; axis < player->gcode->settings.axes && counts > 0u; axis++) {
		const int64_t steps = end[axis] - begin[axis];

		limit(player, axis, passo_size64(steps), counts);
		if (thread->pass.lines > 1u)
			limit_corner(player, axis, steps, counts);
		thread->way[axis] = (int32_t)steps;
	}
	for (uint32_t motor = 0; motor < passo_path_motors(path); motor++)
		line->steps[motor] = (int32_t)(passo_path_motor_place(path, motor, end)
		                               - passo_path_motor_place(path, motor, begin));
}

enum passo_error passo_player_begin_thread(struct passo_player *player)
{
	struct passo_player_thread *thread = &player->thread;
	const struct passo *passo = player->feed->passo;
	const uint64_t counts = (uint64_t)player->gcode->settings.turn_counts << 32;

	*thread = (struct passo_player_thread){.rigid = player->action.rigid,
	    .output = player->action.output,
	    .speed = passo_mul_div(counts, player->action.speed, (uint64_t)PASSO_GCODE_MILLION * 60u),
	    .top_speed = (uint64_t)(passo->machine.clock_hz / CLOCKS_PER_COUNT) << 32,
	    .pass = {.encoder = player->machine->spindle, .wait_index = true}};
	const enum passo_error error = passo_positions(player->feed->passo, thread->from);
	if (error != PASSO_OK)
		return error;
	passo_player_place(player, thread->from, thread->end);
	thread->step = PASSO_PLAYER_SET;
	add_line(player);
	return PASSO_OK;
}

bool passo_player_continues(struct passo_player *player)
{
	if (player->action.kind != PASSO_GCODE_THREAD || player->action.rigid
	    || !passo_player_collects(player) || player->action.output != player->thread.output
	    || !passo_player_allows(player, player->action.target))
		return false;
	add_line(player);
	return true;
}

/* Whether all axes can follow the spindle from each line to the next; while the pass catches up, faster. */
static bool passes_corners(const struct passo_player_thread *thread)
{
	uint64_t behind = 0;

	for (unsigned corner = 0; corner + 1u < thread->pass.lines && !thread->rigid; corner++) {
		uint64_t speed = MARGIN(thread->speed);

		behind += thread->pass.line[corner].half_counts;
		if (behind < 4u * (uint64_t)thread->pass.run_in)
			speed = speed / 10u * PASSO_PASS_PEAK_TENTHS;
		if (thread->corner_speed[corner] < speed)
			return false;
	}
	return true;
}

static enum passo_error begin_pass(struct passo_player *player)
{
	struct passo_player_thread *thread = &player->thread;
	struct passo_pass *pass = &thread->pass;
	struct passo *passo = player->feed->passo;
	const struct passo_output forward = output_of(thread, 0);
	const struct passo_output backward = output_of(thread, PASSO_GCODE_OUTPUT_REVERSE);
	const uint64_t top = thread->top_speed / PASSO_PASS_PEAK_TENTHS * 10u;
	enum passo_error error = PASSO_OK;

	if (top < MARGIN(thread->speed))
		return PASSO_ERROR_FOLLOW_SPEED;
	pass->top_speed = top < 2u * thread->speed ? top : 2u * thread->speed;
	pass->run_in = thread->run * PASSO_PASS_PEAK_TENTHS / 10u + 1u;
	pass->run_out = thread->rigid ? 0u : thread->run;
	if (!passes_corners(thread))
		return PASSO_ERROR_FOLLOW_SPEED;
	if (thread->rigid) {
		for (pass->lines = 1; pass->lines < PASSO_PASS_LINES_MAX; pass->lines++)
			pass->line[pass->lines] = pass->line[0];
		pass->then = &backward;
	}
	if (passo->has_outputs)
		error = passo_set_output(passo, &forward);
	if (error == PASSO_OK)
		error = passo_pass(passo, pass);
	pass->then = NULL;
	if (error == PASSO_OK)
		thread->step = PASSO_PLAYER_PASS;
	return error == PASSO_ERROR_MOVING ? PASSO_OK : error;
}

/* Waits until the spindle turns at half its speed at least, and while held. */
static enum passo_error spin(struct passo_player *player)
{
	struct passo_encoder_reading *reading = &player->thread.reading;

	if (player->held)
		return PASSO_OK;
	if (reading->valid && passo_driver_now(player->feed->passo) - reading->at < SPEED_MICROSECONDS)
		return PASSO_OK;
	const enum passo_error error = read_encoder(player, reading);
	if (error != PASSO_OK || reading->speed == PASSO_NO_UNITS
	    || reading->speed < (int64_t)(player->thread.speed / 2u))
		return error;
	return begin_pass(player);
}

/* The motor of a line with the most steps. */
static unsigned longest_of(const struct passo_pass_line *line)
{
	unsigned longest = 0;

	for (unsigned motor = 1; motor < PASSO_AXES_MAX; motor++) {
		if (passo_size64(line->steps[motor]) > passo_size64(line->steps[longest]))
			longest = motor;
	}
	return longest;
}

/* Behind the target: the count at which the pass has begun, an index. */
static enum passo_error find_beginning(struct passo_player *player)
{
	struct passo_player_thread *thread = &player->thread;
	const struct passo_pass_line *line = &thread->pass.line[0];
	const unsigned motor = longest_of(line);
	int32_t now[PASSO_AXES_MAX];
	enum passo_error error = passo_positions(player->feed->passo, now);

	if (error != PASSO_OK)
		return error;
	const int64_t made = now[motor] - thread->from[motor], turn = player->gcode->settings.turn_counts;
	if (passo_size64(made) < passo_size64(line->steps[motor]))
		return PASSO_OK;
	error = read_encoder(player, &thread->reading);
	if (error != PASSO_OK)
		return error;
	const int32_t counts = thread->reading.counts;
	const int32_t index = counts - (int32_t)(uint16_t)((uint32_t)counts - thread->reading.latch);
	const int64_t way = made * (int64_t)(line->half_counts / 2u) / line->steps[motor]; /* about */
	const int64_t since = (int64_t)index - (counts - way);
	const int64_t turns = (2 * since + (since < 0 ? -turn : turn)) / (2 * turn);
	thread->began = (int32_t)(index - turns * turn);
	thread->step = PASSO_PLAYER_PAST;
	return PASSO_OK;
}

/* Nearest steps of a motor on the line at half counts from its beginning. */
static int32_t steps_of(const struct passo_pass_line *line, unsigned motor, int32_t half_counts)
{
	const uint64_t size = passo_size64(line->steps[motor]);
	const uint64_t steps = (passo_mul_div(2u * size, (uint64_t)half_counts, line->half_counts) + 1u) / 2u;

	return line->steps[motor] < 0 ? -(int32_t)steps : (int32_t)steps;
}

/* At rest where the spindle turns back: to where the line is at the present count, by the clock. */
static enum passo_error turn(struct passo_player *player)
{
	struct passo_player_thread *thread = &player->thread;
	struct passo *passo = player->feed->passo;
	const struct passo_pass_line *line = &thread->pass.line[0];
	const struct passo_output backward = output_of(thread, PASSO_GCODE_OUTPUT_REVERSE);
	struct passo_move_in_time move = {.total_clocks = passo->machine.clock_hz / NUDGES_PER_SECOND};
	int32_t now[PASSO_AXES_MAX];
	bool moves = false;
	enum passo_error error = passo_clear(passo);

	if (error == PASSO_OK)
		error = passo_positions(passo, now);
	if (error == PASSO_OK)
		error = read_encoder(player, &thread->reading);
	if (error == PASSO_OK && passo->has_outputs)
		error = passo_set_output(passo, &backward);
	if (error != PASSO_OK)
		return error == PASSO_ERROR_MOVING ? PASSO_OK : error;
	thread->left = thread->reading.counts - thread->began;
	for (unsigned motor = 0; motor < passo_path_motors(player->feed->path); motor++) {
		move.steps[motor] =
		    thread->from[motor] + steps_of(line, motor, 2 * thread->left + 1) - now[motor];
		moves = moves || move.steps[motor] != 0;
	}
	thread->step = PASSO_PLAYER_TURN;
	return moves ? passo_move_in_time(passo, &move) : PASSO_OK;
}

/* The same line back, by counts the other way round. */
static enum passo_error go_back(struct passo_player *player)
{
	struct passo_player_thread *thread = &player->thread;
	struct passo *passo = player->feed->passo;
	struct passo_pass pass = {.encoder = thread->pass.encoder,
	    .lines = 1,
	    .line = {{.half_counts = 2u * (uint32_t)thread->left + 1u}},
	    .run_out = thread->run,
	    .top_speed = thread->pass.top_speed};
	struct passo_encoder_reading before = {.valid = false}, after = {.valid = false};
	int32_t now[PASSO_AXES_MAX];
	enum passo_error error = passo_positions(passo, now);

	if (error == PASSO_OK)
		error = read_encoder(player, &before);
	if (error == PASSO_OK)
		error = set_encoder(player, true);
	if (error == PASSO_OK)
		error = read_encoder(player, &after);
	if (error != PASSO_OK)
		return error;
	const int32_t since = thread->began + thread->left - (before.counts - (after.counts - before.counts));
	pass.behind = since > 0 ? 2u * (uint32_t)since : 0u;
	for (unsigned motor = 0; motor < passo_path_motors(player->feed->path); motor++)
		pass.line[0].steps[motor] = thread->from[motor] - now[motor];
	thread->step = PASSO_PLAYER_BACK;
	return passo_pass(passo, &pass);
}

static enum passo_error watch(struct passo_player *player)
{
	struct passo_thread_state state;
	enum passo_error error = passo_read_thread(player->feed->passo, &state);

	if (error != PASSO_OK || state.owed >= 0)
		return error;
	player->thread.step = PASSO_PLAYER_STOP;
	error = passo_abort(player->feed->passo);
	return error == PASSO_OK ? turn(player) : error;
}

/* The spindle turns as before; the path begins where the motors are; the program, where it ends. */
static enum passo_error end(struct passo_player *player)
{
	struct passo *passo = player->feed->passo;
	int32_t now[PASSO_AXES_MAX];
	enum passo_error error = PASSO_OK;

	if (player->thread.rigid && passo->has_outputs)
		error = passo_set_levels(passo, output_of(&player->thread, 0).levels);
	if (error == PASSO_ERROR_MOVING)
		return PASSO_OK;
	if (error == PASSO_OK)
		error = passo_positions(passo, now);
	if (error != PASSO_OK)
		return error;
	passo_path_restart(player->feed->path, now);
	passo_path_feed_open(player->feed, player->feed->passo, player->feed->path);
	player->levels |= PASSO_PLAYER_UNSURE;
	player->thread.step = PASSO_PLAYER_FREE;
	player->chords++;
	player->threads++;
	return PASSO_OK;
}

enum passo_error passo_player_follow(struct passo_player *player)
{
	struct passo_player_thread *thread = &player->thread;
	const bool moves = passo_is_moving(player->feed->passo);
	enum passo_error error;

	switch (thread->step) {
	case PASSO_PLAYER_SET:
		error = set_encoder(player, false);
		if (error == PASSO_OK)
			thread->step = PASSO_PLAYER_SPIN;
		return error == PASSO_ERROR_MOVING ? PASSO_OK : error;
	case PASSO_PLAYER_SPIN:
		return spin(player);
	case PASSO_PLAYER_PASS:
		if (thread->rigid)
			return find_beginning(player);
		break;
	case PASSO_PLAYER_PAST:
		return watch(player);
	case PASSO_PLAYER_STOP:
		return turn(player);
	case PASSO_PLAYER_TURN:
		return moves ? PASSO_OK : go_back(player);
	default:
		break;
	}
	return moves ? PASSO_OK : end(player);
}

#endif
