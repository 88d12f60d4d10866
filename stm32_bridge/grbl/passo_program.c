/* SPDX-License-Identifier: MIT */
#include "passo_program.h"

enum passo_error passo_program_open(struct passo_program *program, struct passo *passo,
    const struct passo_program_settings *settings, struct passo_path_item *items, uint32_t capacity)
{
	const enum passo_plan_error error = passo_path_open(&program->path, &settings->path, items, capacity);

	if (error != PASSO_PLAN_OK)
		return PASSO_ERROR_PLAN + (enum passo_error)error;
	for (uint8_t motor = 0; motor < passo_path_motors(&program->path); motor++) {
		struct passo_path_axis mixed;
		const struct passo_path_axis *own = passo_path_motor_limits(&settings->path, motor, &mixed);

		if (own->speed > passo_highest_speed(passo, motor, own->steps_per_mm))
			return PASSO_ERROR_PINS_TOO_SLOW;
	}
	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++)
		program->axis[axis] = settings->path.axis[axis];
	program->machine = (struct passo_player_machine){.axis = program->axis,
	    .spin_up = settings->spin_up,
	    .at_speed = settings->at_speed,
	    .inputs = settings->inputs};
#ifndef PASSO_WITHOUT_THREADS
	program->machine.deviation = settings->path.junction_deviation;
#endif
	program->ends = program->slow = false;
	passo_path_feed_open(&program->feed, passo, &program->path);
	passo_gcode_open(&program->gcode, &settings->gcode);
	passo_player_open(&program->player, &program->gcode, &program->feed, &program->machine);
	return PASSO_OK;
}

bool passo_program_is_ready(const struct passo_program *program)
{
	return !program->ends && passo_player_is_ready(&program->player);
}

enum passo_gcode_error passo_program_line(struct passo_program *program, const char *text, size_t length)
{
	struct passo_gcode_line line;

	passo_gcode_line_read(&line, text, length);
	return line.overflow ? PASSO_GCODE_LINE_OVERFLOW : passo_gcode_execute(&program->gcode, line.text);
}

void passo_program_end(struct passo_program *program)
{
	program->ends = true;
}

enum passo_error passo_program_poll(struct passo_program *program)
{
	enum passo_player_event event;

	if (program->ends && passo_player_is_ready(&program->player))
		passo_path_end(&program->path);
	const enum passo_error error = passo_player_poll(&program->player, &event);
	if (event == PASSO_PLAYER_PAUSED || event == PASSO_PLAYER_TOOL)
		passo_player_go_on(&program->player);
	program->slow |= event == PASSO_PLAYER_SLOW;
	return error;
}

bool passo_program_is_done(const struct passo_program *program)
{
	return program->ends && passo_player_is_idle(&program->player);
}
