/* SPDX-License-Identifier: MIT
 * Power in proportion to the velocity: the bit-serial unit. See rtl/passo_power.v.
 */
#include "passo_outputs.h"

enum { SAMPLE = 0, SAMPLE_STEP = 18, CHECK = 44, DONE = 69 };

static const uint32_t COST_MAX = 0xFFFFFFu;
static const uint32_t LOW_MASK = 0x1FFFFFFu;

void passo_power_reset(struct passo_power *power)
{
	*power = (struct passo_power){0};
}

static void multiply(struct passo_power *power, uint32_t factor)
{
	const uint64_t sum = (uint64_t)power->high + ((power->low & 1u) != 0u ? factor : 0u);

	power->high = (uint32_t)(sum >> 1);
	power->low = power->low >> 1 | (uint32_t)(sum & 1u) << 24;
}

static void divide(struct passo_power *power)
{
	const uint64_t left = (uint64_t)power->high << 1 | power->low >> 24;
	const bool fits = left >= power->factor;

	power->high = (uint32_t)(left - (fits ? power->factor : 0u));
	power->low = (power->low << 1 & LOW_MASK) | (fits ? 1u : 0u);
}

void passo_power_clock(struct passo_power *power, const struct passo_outputs_wires *wires, bool moves)
{
	if (!moves) {
		power->count = 0;
		power->cost = 0;
		return;
	}
	if (power->count == SAMPLE) {
		power->factor = wires->velocity;
		power->high = 0;
		power->low = wires->rate;
	} else if (power->count == SAMPLE_STEP) {
		power->factor = power->high;
		power->high = 0;
		power->low = wires->settings.pwm_step;
	} else if (power->count == CHECK) {
		power->too_large = power->high >= power->factor;
	} else if (power->count == DONE) {
		power->cost = power->too_large ? COST_MAX : power->low & COST_MAX;
	} else if (power->count > CHECK) {
		divide(power);
	} else {
		multiply(power, power->count < SAMPLE_STEP ? power->factor : wires->settings.power_reference);
	}
	power->count = power->count == DONE ? 0u : (uint8_t)(power->count + 1u);
}
