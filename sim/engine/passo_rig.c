/* SPDX-License-Identifier: MIT
 * The simulated machine at the pins of an engine.
 */
#include <stdlib.h>
#include <string.h>

#include "rig.h"

#define LOG_START 1024u

static void record(
    struct passo_rig *rig, uint64_t clock, enum passo_input input, const struct passo_inputs *inputs)
{
	if (rig->length == rig->capacity) {
		rig->capacity *= 2;
		rig->log = realloc(rig->log, rig->capacity * sizeof *rig->log);
		if (!rig->log)
			abort();
	}
	rig->log[rig->length++] = (struct passo_rig_change){clock, input, rig_levels(inputs, input)};
}

/* One entry for a count, and one where its index changes. */
static void record_spindle(
    struct passo_rig *rig, unsigned number, uint64_t clock, int64_t before, const struct passo_inputs *inputs)
{
	const int64_t turn = rig->config.wheel[number].per_turn, count = rig->wheel[number].count;
	const int64_t edge = count > before ? count : before;

	record(rig, clock, (edge & 1) != 0 ? PASSO_INPUT_ENCODER_A : PASSO_INPUT_ENCODER_B, inputs);
	if (count % turn == 0 || before % turn == 0)
		record(rig, clock, PASSO_INPUT_ENCODER_INDEX, inputs);
}

static void happen(struct passo_rig *rig, unsigned number, uint64_t clock)
{
	const struct passo_rig_event *event = &rig->config.event[number];

	rig->moment[number].clock = clock;
	memcpy(rig->moment[number].positions, rig->position, sizeof rig->position);
	if (event->what == PASSO_RIG_SLIP) {
		rig->wheel[event->target].slip += event->counts;
	} else if (event->what == PASSO_RIG_CALL) {
		rig->calls = true;
	} else {
		struct wire *wire = &rig->wire[event->target];

		wire->forced = true;
		wire->active = event->what == PASSO_RIG_ACTIVE;
		wire->release = event->length != 0u ? clock + event->length : UINT64_MAX;
	}
}

static bool is_pending(const struct passo_rig *rig, unsigned number, enum passo_rig_when when)
{
	return rig->config.event[number].when == when && rig->moment[number].clock == PASSO_RIG_NOT_YET;
}

/* Events at the edges of inputs, which may change other inputs. */
static void edges(struct passo_rig *rig, const bool *before, uint64_t clock)
{
	bool again = true;

	while (again) {
		again = false;
		for (unsigned i = 0; i < rig->config.events; i++) {
			const unsigned source = rig->config.event[i].source;
			const bool active = rig->wire[source].active;

			if (active == before[source]
			    || !is_pending(rig, i, active ? PASSO_RIG_RISING : PASSO_RIG_FALLING))
				continue;
			happen(rig, i, clock);
			again = true;
		}
	}
}

static void move_axes(struct passo_rig *rig, const struct passo_outputs *outputs, uint64_t clock)
{
	const uint64_t rising = outputs->step & ~rig->step;

	rig->step = outputs->step;
	if (rising == 0u)
		return;
	for (unsigned axis = 0; axis < rig->config.axes; axis++)
		if ((rising >> axis & 1u) != 0u)
			rig->position[axis] += (outputs->dir >> axis & 1u) != 0u ? -1 : 1;
	for (unsigned i = 0; i < rig->config.events; i++) {
		const struct passo_rig_event *event = &rig->config.event[i];

		if (is_pending(rig, i, PASSO_RIG_POSITION) && (rising >> event->axis & 1u) != 0u
		    && rig->position[event->axis] == event->position)
			happen(rig, i, clock);
	}
}

struct passo_rig *passo_rig_create(const struct passo_rig_config *config, struct passo_inputs *inputs)
{
	struct passo_rig *rig = calloc(1, sizeof *rig);

	if (!rig)
		return NULL;
	rig->config = *config;
	rig->random = config->seed * UINT64_C(0x9E3779B97F4A7C15) + 1u;
	rig->started = UINT64_MAX;
	rig->capacity = LOG_START;
	rig->log = malloc(rig->capacity * sizeof *rig->log);
	if (!rig->log) {
		free(rig);
		return NULL;
	}
	memcpy(rig->position, config->start, sizeof rig->position);
	for (unsigned i = 0; i < PASSO_RIG_EVENTS; i++)
		rig->moment[i].clock = PASSO_RIG_NOT_YET;
	for (unsigned i = 0; i < config->wires; i++) {
		const struct passo_rig_wire *fitted = &config->wire[i];

		rig_switch(rig, i);
		rig->wire[i].release = UINT64_MAX;
		rig->wire[i].flips =
		    fitted->every != 0u ? 1u + rig_random(rig, 2u * fitted->every) : UINT64_MAX;
		rig_set(inputs, fitted->input, fitted->bit, rig->wire[i].active != fitted->inverted);
		record(rig, 0, fitted->input, inputs);
	}
	return rig;
}

void passo_rig_destroy(struct passo_rig *rig)
{
	if (rig)
		free(rig->log);
	free(rig);
}

static uint64_t sooner(uint64_t next, uint64_t clock, uint64_t when)
{
	if (when <= clock)
		when = clock + 1u;
	return when < next ? when : next;
}

uint64_t passo_rig_next(const struct passo_rig *rig, uint64_t clock)
{
	uint64_t next = UINT64_MAX;

	for (unsigned i = 0; i < rig->config.wires; i++) {
		next = sooner(next, clock, rig->wire[i].flips);
		next = sooner(next, clock, rig->wire[i].release);
	}
	for (unsigned i = 0; i < rig->config.wheels; i++)
		if (rig->config.wheel[i].interval != 0u || rig->wheel[i].count != rig_counts(rig, i))
			next = sooner(next, clock, rig->wheel[i].next);
	for (unsigned i = 0; i < rig->config.events; i++)
		if (rig->started != UINT64_MAX && is_pending(rig, i, PASSO_RIG_TIME))
			next = sooner(next, clock, rig->started + rig->config.event[i].clocks);
	return next;
}

void passo_rig_follow(
    struct passo_rig *rig, uint64_t clock, const struct passo_outputs *outputs, struct passo_inputs *inputs)
{
	bool before[PASSO_RIG_WIRES];

	for (unsigned i = 0; i < rig->config.wires; i++)
		before[i] = rig->wire[i].active;
	if (rig->started == UINT64_MAX && outputs->running != 0u)
		rig->started = clock;
	for (unsigned i = 0; i < rig->config.wires; i++)
		if (rig->wire[i].release <= clock) {
			rig->wire[i].release = UINT64_MAX;
			rig->wire[i].forced = false;
		}
	move_axes(rig, outputs, clock);
	for (unsigned i = 0; i < rig->config.events; i++)
		if (rig->started != UINT64_MAX && is_pending(rig, i, PASSO_RIG_TIME)
		    && clock >= rig->started + rig->config.event[i].clocks)
			happen(rig, i, clock);
	for (unsigned i = 0; i < rig->config.wires; i++)
		rig_switch(rig, i);
	edges(rig, before, clock);
	for (unsigned i = 0; i < rig->config.wires; i++) {
		const struct passo_rig_wire *fitted = &rig->config.wire[i];

		rig_disturb(rig, i, rig->wire[i].active != before[i], clock);
		if (rig_set(inputs, fitted->input, fitted->bit,
			(rig->wire[i].active != rig->wire[i].flipped) != fitted->inverted))
			record(rig, clock, fitted->input, inputs);
	}
	for (unsigned i = 0; i < rig->config.wheels; i++) {
		const int64_t before = rig->wheel[i].count;

		if (rig->config.wheel[i].interval == 0u)
			rig_turn(rig, i, clock, inputs);
		else if (rig->config.wheel[i].start_up != 0u
			     ? rig_drive(rig, i, clock, outputs->outputs, inputs)
			     : rig_spin(rig, i, clock, inputs))
			record_spindle(rig, i, clock, before, inputs);
	}
}

bool passo_rig_calls(struct passo_rig *rig)
{
	const bool calls = rig->calls;

	rig->calls = false;
	return calls;
}

void passo_rig_slip(struct passo_rig *rig, uint32_t wheel, int64_t counts)
{
	rig->wheel[wheel].slip += counts;
}

void passo_rig_drive(struct passo_rig *rig, uint32_t wheel, uint32_t speed)
{
	rig->wheel[wheel].wanted = speed;
}

bool passo_rig_at_speed(const struct passo_rig *rig, uint32_t wheel)
{
	return rig->wheel[wheel].there;
}

const struct passo_rig_moment *passo_rig_moment(const struct passo_rig *rig, uint32_t event)
{
	return &rig->moment[event];
}

int64_t passo_rig_position(const struct passo_rig *rig, uint32_t axis)
{
	return rig->position[axis];
}

size_t passo_rig_drain(struct passo_rig *rig, struct passo_rig_change *changes, size_t capacity)
{
	const size_t count = rig->length < capacity ? rig->length : capacity;

	memcpy(changes, rig->log, count * sizeof *changes);
	memmove(rig->log, rig->log + count, (rig->length - count) * sizeof *changes);
	rig->length -= count;
	return count;
}
