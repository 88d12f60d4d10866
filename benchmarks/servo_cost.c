/* SPDX-License-Identifier: MIT
 * Calls of a servo thread at a served core, for a count of instructions: servo_cost DEVICE AXES CALLS. A call
 * is passo_servo_write() and a read of the positions.
 */
#include <stdio.h>
#include <stdlib.h>

#include "passo_linux.h"
#include "passo_servo.h"

#define PERIOD 1000u /* us */

static struct passo passo;
static struct passo_host host;
static struct passo_linux linux_host;
static struct passo_servo servo;

int main(int count, char **given)
{
	const uint8_t axes = count > 3 ? (uint8_t)atoi(given[2]) : 1;
	const struct passo_linux_options device = {.device = count > 1 ? given[1] : "", .axes = axes};
	const struct passo_axis_config pins = {
	    .step_high_ns = 1000, .step_low_ns = 1000, .dir_setup_ns = 1000, .dir_hold_ns = 1000};
	struct passo_servo_options options = {.period_ns = PERIOD * 1000u, .axes = axes};
	int64_t commands[PASSO_AXES_MAX] = {0};
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error =
	    passo_open_linux(&passo, &host, &linux_host, &device, &(struct passo_options){0});

	for (uint8_t axis = 0; axis < axes && error == PASSO_OK; axis++) {
		options.axis[axis] = (struct passo_servo_axis){
		    PASSO_STEPS_PER_S(8000), PASSO_STEPS_PER_S2(80000), PASSO_STEPS_PER_S2(160000)};
		error = passo_configure_axis(&passo, axis, &pins);
	}
	if (error == PASSO_OK)
		error = passo_servo_check(&servo, &passo, &options);
	if (error == PASSO_OK)
		error = passo_servo_start(&servo);
	for (int call = 0; call < atoi(given[count - 1]) && error == PASSO_OK; call++) {
		for (uint8_t axis = 0; axis < axes; axis++)
			commands[axis] += (int64_t)(axis + 1) * 3 * (1 << 29);
		const uint32_t due = (uint32_t)call * PERIOD, now = host.hardware.microseconds(&linux_host);
		host.hardware.wait(&linux_host, due - now < PERIOD ? due - now : PERIOD);
		error = passo_servo_write(&servo, commands);
		if (error == PASSO_OK)
			error = passo_positions(&passo, positions);
	}
	printf("%s %u\n", passo_error_name(error), (unsigned)linux_host.words);
	return error != PASSO_OK;
}
