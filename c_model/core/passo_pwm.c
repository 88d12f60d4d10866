/* SPDX-License-Identifier: MIT
 * Power PWM with a credit accumulator. See rtl/passo_pwm.v.
 */
#include "passo_core_outputs.h"

enum { PERIOD = 1 << 24 };

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
	pwm->cost = wires->proportional && wires->cost > wires->step ? wires->cost : wires->step;
	pwm->phase = (fresh ? 0u : pwm->phase) + wires->step;
	pwm->begins = pwm->phase >= PERIOD;
	pwm->phase %= PERIOD;
	pwm->idle = !wires->go;
	pwm->pin = wires->go && pwm->credit >= 0;
}
