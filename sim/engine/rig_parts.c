/* SPDX-License-Identifier: MIT
 * Parts of the simulated machine: switches with their noise, encoders.
 */
#include "rig.h"

#define CHATTER 8u /* changes of a bouncing contact, about */

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
	const int64_t here = rig->position[fitted->axis];
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

void rig_turn(struct passo_rig *rig, unsigned number, uint64_t clock, struct passo_inputs *inputs)
{
	const struct passo_rig_wheel *fitted = &rig->config.wheel[number];
	struct wheel *wheel = &rig->wheel[number];
	const int64_t wanted = rig_counts(rig, number);

	if (wheel->count == wanted || clock < wheel->next)
		return;
	wheel->count += wanted > wheel->count ? 1 : -1;
	wheel->next = clock + fitted->gap;
	/* A leads: 00 10 11 01 */
	rig_set(inputs, PASSO_INPUT_ENCODER_A, fitted->axis, ((wheel->count + 1) & 2) != 0);
	rig_set(inputs, PASSO_INPUT_ENCODER_B, fitted->axis, (wheel->count & 2) != 0);
}
