/* SPDX-License-Identifier: MIT
 * A spindle that outputs of the core turn on and reverse. Its motor changes the speed evenly; what it cuts
 * makes the speed wander about that.
 */
#include "rig.h"

#define ON 1u
#define REVERSE 2u
#define TICKS_PER_COUNT 8u /* at full speed */
#define ONE (INT64_C(1) << 16)

/* A factor of the speed, 2^16: it goes from one random value to the next in a part of a turn. */
static int64_t wander(struct passo_rig *rig, unsigned number)
{
	const struct passo_rig_wheel *fitted = &rig->config.wheel[number];
	struct wheel *wheel = &rig->wheel[number];

	if (wheel->progress == wheel->length) {
		wheel->from = wheel->length == 0u ? ONE : wheel->to;
		wheel->to =
		    ONE - fitted->wander + (int64_t)rig_random(rig, 2u * (uint64_t)fitted->wander + 1u);
		wheel->length = 1u + (uint32_t)rig_random(rig, (uint64_t)fitted->per_turn * TICKS_PER_COUNT);
		wheel->progress = 0;
	}
	wheel->progress++;
	return wheel->from + (wheel->to - wheel->from) * wheel->progress / wheel->length;
}

bool rig_drive(
    struct passo_rig *rig, unsigned number, uint64_t clock, uint64_t outputs, struct passo_inputs *inputs)
{
	const struct passo_rig_wheel *fitted = &rig->config.wheel[number];
	struct wheel *wheel = &rig->wheel[number];
	const uint64_t per_count = fitted->interval >> 16;
	const uint64_t tick = per_count > TICKS_PER_COUNT ? per_count / TICKS_PER_COUNT : 1u;
	const int64_t full = (int64_t)((tick << 48) / fitted->interval);
	const int64_t change = (int64_t)((uint64_t)full * tick / fitted->start_up) + 1;

	if (clock < wheel->next)
		return false;
	wheel->next = clock + tick;
	const int64_t size = (outputs & ON) != 0u ? (full >> 16) * wheel->wanted : 0;
	const int64_t wanted = (outputs & REVERSE) != 0u ? -size : size;
	if (wheel->speed < wanted)
		wheel->speed = wanted - wheel->speed > change ? wheel->speed + change : wanted;
	else
		wheel->speed = wheel->speed - wanted > change ? wheel->speed - change : wanted;
	wheel->there = wheel->speed == wanted && (outputs & ON) != 0u;
	if (fitted->ready > 0u)
		rig_set(inputs, PASSO_INPUT_HOME, fitted->ready - 1u, wheel->there != fitted->inverted);
	if (fitted->per_turn == 0u)
		return false;
	wheel->angle += wheel->speed * wander(rig, number) / ONE;
	const int64_t count = wheel->angle >> 32;
	if (count == wheel->count)
		return false;
	wheel->count += count > wheel->count ? 1 : -1;
	rig_show(rig, number, inputs);
	rig_set(
	    inputs, PASSO_INPUT_ENCODER_INDEX, fitted->axis, wheel->count % (int64_t)fitted->per_turn == 0);
	return true;
}
