/* SPDX-License-Identifier: MIT
 * Parts of the simulated machine: switches with their noise, encoders, spindles.
 */
#include "rig.h"

#define CHATTER 8u /* changes of a bouncing contact, about */
#define SPEED_ONE (INT64_C(1) << 16)

uint64_t rig_random(struct passo_rig *rig, uint64_t limit)
{
	rig->random ^= rig->random << 13;
	rig->random ^= rig->random >> 7;
	rig->random ^= rig->random << 17;
	return rig->random % limit;
}

uint64_t rig_levels(const struct passo_inputs *inputs, enum passo_input input)
{
	switch (input) {
#define GET(name, type, number)                                                                              \
	case number:                                                                                         \
		return inputs->name;
		PASSO_INPUTS(GET)
#undef GET
	case PASSO_INPUT_COUNT:
		break;
	}
	return 0;
}

bool rig_set(struct passo_inputs *inputs, enum passo_input input, unsigned bit, bool level)
{
	const uint64_t before = rig_levels(inputs, input);
	const uint64_t after = (before & ~(UINT64_C(1) << bit)) | (uint64_t)level << bit;

	switch (input) {
#define SET(name, type, number)                                                                              \
	case number:                                                                                         \
		inputs->name = (type)after;                                                                  \
		break;
		PASSO_INPUTS(SET)
#undef SET
	case PASSO_INPUT_COUNT:
		break;
	}
	return after != before;
}

void rig_switch(struct passo_rig *rig, unsigned number)
{
	const struct passo_rig_wire *fitted = &rig->config.wire[number];
	struct wire *wire = &rig->wire[number];
	const int64_t here = rig->position[fitted->axis] + fitted->share * rig->position[fitted->other];
	const int64_t beyond = fitted->above ? here - fitted->at : fitted->at - here;

	wire->beyond = fitted->is_switch && beyond >= (wire->beyond ? -fitted->hysteresis : 0);
	if (!wire->forced)
		wire->active = wire->beyond;
}

/* Noise and chatter. */
void rig_disturb(struct passo_rig *rig, unsigned number, bool changed, uint64_t clock)
{
	const struct passo_rig_wire *fitted = &rig->config.wire[number];
	struct wire *wire = &rig->wire[number];

	if (changed && fitted->bounce != 0u) {
		wire->until = clock + fitted->bounce;
		wire->flips = clock + 1u + rig_random(rig, fitted->bounce / CHATTER + 1u);
	} else if (clock < wire->flips) {
		return;
	} else if (clock < wire->until) {
		wire->flipped = !wire->flipped;
		wire->flips = clock + 1u + rig_random(rig, fitted->bounce / CHATTER + 1u);
		if (wire->flips > wire->until)
			wire->flips = wire->until;
	} else if (fitted->every != 0u && !wire->flipped) {
		wire->flipped = true;
		wire->flips = clock + fitted->glitch;
	} else {
		wire->flipped = false;
		wire->flips =
		    fitted->every != 0u ? clock + 1u + rig_random(rig, 2u * fitted->every) : UINT64_MAX;
	}
}

int64_t rig_counts(const struct passo_rig *rig, unsigned number)
{
	const struct passo_rig_wheel *fitted = &rig->config.wheel[number];
	const int64_t way = (rig->position[fitted->axis] - rig->config.start[fitted->axis]) * fitted->ratio;
	const int64_t one = 1 << 16;

	/* rounded down */
	return (way >= 0 ? way : way - (one - 1)) / one + rig->wheel[number].slip;
}

/* A leads: 00 10 11 01 */
void rig_show(const struct passo_rig *rig, unsigned number, struct passo_inputs *inputs)
{
	const uint8_t axis = rig->config.wheel[number].axis;
	const int64_t count = rig->wheel[number].count;

	rig_set(inputs, PASSO_INPUT_ENCODER_A, axis, ((count + 1) & 2) != 0);
	rig_set(inputs, PASSO_INPUT_ENCODER_B, axis, (count & 2) != 0);
}

void rig_turn(struct passo_rig *rig, unsigned number, uint64_t clock, struct passo_inputs *inputs)
{
	struct wheel *wheel = &rig->wheel[number];
	const int64_t wanted = rig_counts(rig, number);

	if (wheel->count == wanted || clock < wheel->next)
		return;
	wheel->count += wanted > wheel->count ? 1 : -1;
	wheel->next = clock + rig->config.wheel[number].gap;
	rig_show(rig, number, inputs);
	if (rig->config.wheel[number].per_turn != 0u)
		rig_set(inputs, PASSO_INPUT_ENCODER_INDEX, rig->config.wheel[number].axis,
		    wheel->count % (int64_t)rig->config.wheel[number].per_turn == 0);
}

/* Clocks to the next count, 2^16: the speed goes from one random value to the next in a part of a turn. */
static uint64_t interval(struct passo_rig *rig, unsigned number)
{
	const struct passo_rig_wheel *fitted = &rig->config.wheel[number];
	struct wheel *wheel = &rig->wheel[number];

	if (wheel->progress == wheel->length) {
		wheel->from = wheel->length == 0u ? SPEED_ONE : wheel->to;
		wheel->to =
		    SPEED_ONE - fitted->wander + (int64_t)rig_random(rig, 2u * (uint64_t)fitted->wander + 1u);
		wheel->length = 1u + (uint32_t)rig_random(rig, fitted->per_turn);
		wheel->progress = 0;
	}
	wheel->progress++;
	return (fitted->interval << 16)
	     / (uint64_t)(wheel->from + (wheel->to - wheel->from) * wheel->progress / wheel->length);
}

bool rig_spin(struct passo_rig *rig, unsigned number, uint64_t clock, struct passo_inputs *inputs)
{
	const struct passo_rig_wheel *fitted = &rig->config.wheel[number];
	struct wheel *wheel = &rig->wheel[number];

	if (clock < wheel->next)
		return false;
	wheel->count++;
	wheel->due += interval(rig, number);
	wheel->next = wheel->due >> 16;
	rig_show(rig, number, inputs);
	rig_set(inputs, PASSO_INPUT_ENCODER_INDEX, fitted->axis, wheel->count % fitted->per_turn == 0);
	return true;
}
