/* SPDX-License-Identifier: MIT
 * Power PWM with a credit accumulator. See rtl/passo_pwm.v.
 */
#include "passo_core_outputs.h"

enum { PERIOD = 1 << 24 };

uint32_t passo_pwm_cost(bool proportional, uint32_t step, uint32_t cost)
{
	return proportional && cost > step ? cost : step;
}

void passo_pwm_clock(struct passo_pwm *pwm, const struct passo_pwm_wires *wires)
{
	const bool fresh = wires->restart || pwm->idle;
	const int32_t duty = (wires->power + (wires->power >> 15)) * (PERIOD >> 16);

	if (fresh)
		pwm->credit = -1;
	else if (pwm->pin)
		pwm->credit -= (int32_t)pwm->cost;
	if (fresh || pwm->begins)
		pwm->credit += duty;
	pwm->cost = passo_pwm_cost(wires->proportional, wires->step, wires->cost);
	pwm->phase = (fresh ? 0u : pwm->phase) + wires->step;
	pwm->begins = pwm->phase >= PERIOD;
	pwm->phase %= PERIOD;
	pwm->idle = !wires->go;
	pwm->pin = wires->go && pwm->credit >= 0;
}

uint64_t passo_pwm_quiet(const struct passo_pwm *pwm, const struct passo_pwm_wires *wires)
{
	if (!wires->go || wires->restart || wires->proportional || pwm->idle || pwm->begins
	    || pwm->cost != wires->step)
		return 0;
	const uint32_t period = (PERIOD - 1u - pwm->phase) / wires->step;
	const uint32_t pulse = (uint32_t)pwm->credit / pwm->cost;

	return pwm->pin && pulse < period ? pulse : period;
}

void passo_pwm_skip(struct passo_pwm *pwm, uint32_t step, uint64_t clocks)
{
	pwm->phase += step * (uint32_t)clocks;
	if (pwm->pin)
		pwm->credit -= (int32_t)(pwm->cost * (uint32_t)clocks);
}
