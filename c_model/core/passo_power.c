/* SPDX-License-Identifier: MIT
 * Speed-proportional power. See rtl/passo_power.v.
 */
#include "passo_core_outputs.h"

enum { LAST = 69, SCALE = 96, SCALED = 122 };
enum { RATE_BITS = 17 };

static const uint32_t COST_MAX = 0xFFFFFFu;

void passo_power_reset(struct passo_power *power)
{
	*power = (struct passo_power){.stale = true};
}

static uint32_t quotient(uint64_t scaled, uint64_t velocity, uint32_t rate)
{
	const uint64_t factor = velocity * rate >> RATE_BITS;

	if (factor == 0u || scaled / factor > COST_MAX)
		return COST_MAX;
	return (uint32_t)(scaled / factor);
}

/* Results are computed at the start of an operation and take effect when the RTL has them. */
void passo_power_clock(struct passo_power *power, const struct passo_outputs_wires *wires, bool moves)
{
	const struct passo_output_settings *settings = &wires->settings;
	const bool begins = power->count == 0u;

	if (begins) {
		power->cost = power->next_cost;
		if (power->stale) {
			power->count = SCALE;
		} else if (moves) {
			power->next_cost = quotient(power->scaled, wires->velocity, wires->rate);
			power->count = 1;
		}
	} else if (power->count == SCALED) {
		power->scaled = (uint64_t)settings->pwm_step * settings->power_reference >> 1;
		power->count = 0;
	} else {
		power->count = power->count == LAST ? 0u : (uint8_t)(power->count + 1u);
	}
	if (!moves) {
		power->cost = 0;
		power->next_cost = 0;
		if (power->count < SCALE)
			power->count = 0;
	}
	power->stale = wires->write_power || (power->stale && !begins);
}

bool passo_power_divides(const struct passo_power *power)
{
	return !power->stale && power->count <= LAST;
}

void passo_power_skip(struct passo_power *power, uint32_t velocity, uint32_t rate, uint64_t clocks)
{
	const unsigned count = power->count;
	const uint64_t to_begin = count == 0u ? 0u : LAST + 1u - count;

	power->count = (uint8_t)((count + clocks) % (LAST + 1u));
	if (clocks <= to_begin)
		return;
	const uint32_t cost = quotient(power->scaled, velocity, rate);
	power->cost = clocks > to_begin + LAST + 1u ? cost : power->next_cost;
	power->next_cost = cost;
}
