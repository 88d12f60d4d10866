/* SPDX-License-Identifier: MIT
 * The probe: one motion of the driver.
 */
#include "passo_math.h"
#include "passo_player_private.h"

/* From steps of axes to those of motors, and what is the most of these; and the acceleration along the path
 * that they allow. */
static void mix(
    const struct passo_path_planner *path, struct passo_probe *probe, uint64_t *most, uint64_t *acceleration)
{
#ifdef PASSO_CARTESIAN
	(void)path, (void)probe, (void)most, (void)acceleration;
#else
	int64_t steps[PASSO_AXES_MAX];

	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++)
		steps[axis] = probe->steps[axis];
	*most = 0;
	*acceleration = passo_path_mixed_acceleration(path, *acceleration);
	for (unsigned motor = 0; motor < passo_path_motors(path); motor++) {
		const int64_t own = passo_path_motor_place(path, motor, steps);
		const uint64_t size = passo_size64(own);

		probe->steps[motor] = (int32_t)own;
		*most = size > *most ? size : *most;
	}
#endif
}

/* Steps of the probe, and its speed and acceleration: those of the motor with the most steps. */
static struct passo_probe plan_probe(struct passo_player *player, const int32_t *positions)
{
	const struct passo_gcode_action *action = &player->action;
	struct passo_probe probe = {.away = action->probe >= 384, .optional = action->probe % 2 == 1};
	struct passo_u128 square = {0, 0};
	uint64_t most = 0, way = 0, slowest = UINT64_MAX;
	passo_gcode_position from;

	passo_player_place(player, positions, from);
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++) {
		const struct passo_path_axis *limits = &player->machine->axis[axis];
		const uint64_t length = passo_size64(action->target[axis] - from[axis]);
		const uint64_t size = passo_mul_div(
		    passo_mul_div(length, limits->steps_per_mm, UINT64_C(1) << 32), 1, PASSO_GCODE_MILLION);

		probe.steps[axis] = action->target[axis] < from[axis] ? -(int32_t)size : (int32_t)size;
		square = passo_u128_add(square, passo_multiply(length, length));
		most = size > most ? size : most;
		if (size > 0 && limits->acceleration < slowest)
			slowest = limits->acceleration;
	}
	mix(player->feed->path, &probe, &most, &slowest);
	way = passo_isqrt128(square);
	player->probe_scale = 0;
	if (way > 0) {
		const uint64_t scale = passo_mul_div(most, (uint64_t)PASSO_GCODE_MILLION << 32, way);

		player->probe_scale = scale;

		probe.speed = passo_mul_div(action->feed, scale, UINT64_C(1) << 32);
		probe.acceleration = passo_mul_div(slowest, scale, UINT64_C(1) << 32);
	}
	return probe;
}

enum passo_error passo_player_begin_probe(struct passo_player *player, enum passo_player_event *event)
{
	int32_t positions[PASSO_AXES_MAX];
	struct passo *passo = player->feed->passo;
	enum passo_error error = PASSO_OK;

	error = passo_positions(passo, positions);
	if (error != PASSO_OK)
		return error;
	const struct passo_probe probe = plan_probe(player, positions);
	error = passo_probe(passo, &probe);
	player->probes = error == PASSO_OK;
	if (player->probes)
		return PASSO_OK;
	passo_player_drop(player);
	player->touched = false;
	if (error == PASSO_ERROR_NO_INPUTS || error == PASSO_ERROR_NO_SWITCH) {
		*event = PASSO_PLAYER_NO_PROBE;
		return PASSO_OK;
	}
	*event = error == PASSO_ERROR_SWITCH_LEVEL ? PASSO_PLAYER_UNEXPECTED : PASSO_PLAYER_NOTHING;
	return error == PASSO_ERROR_SWITCH_LEVEL ? PASSO_OK : error;
}

/* Where the probe has acted, or where an optional one has ended. */
enum passo_error passo_player_end_probe(struct passo_player *player, enum passo_player_event *event)
{
	struct passo_trigger_report report;
	enum passo_error error = passo_read_trigger(player->feed->passo, &report);

	player->probes = false;
	if (error == PASSO_OK && !report.fired)
		error = passo_positions(player->feed->passo, report.positions);
	if (error != PASSO_OK)
		return error;
	player->touched = report.fired;
	passo_player_place(player, report.positions, player->touch);
	*event = PASSO_PLAYER_PROBED;
	return passo_player_restart(player);
}
