/* SPDX-License-Identifier: MIT
 * Basic functions of the driver.
 */
#include "passo.h"

#include "passo_driver.h"
#include "passo_math.h"

#define MICROSECONDS_PER_SECOND 1000000u

enum passo_error passo_driver_check(const struct passo *passo)
{
	if (!passo)
		return PASSO_ERROR_ARGUMENT_POINTER;
	return passo->assumed != PASSO_ASSUMED_NOT_OPEN ? PASSO_OK : PASSO_ERROR_NOT_OPEN;
}

enum passo_error passo_driver_check_axis(const struct passo *passo, uint8_t axis)
{
	enum passo_error error = passo_driver_check(passo);

	return error == PASSO_OK && axis >= passo->axes ? PASSO_ERROR_ARGUMENT_AXIS : error;
}

bool passo_driver_is_link_error(enum passo_error error)
{
	return error >= PASSO_ERROR_TRANSFER && error <= PASSO_ERROR_BAD_CRC;
}

uint32_t passo_driver_now(const struct passo *passo)
{
	const struct passo_hardware *hardware = &passo->host->hardware;

	return hardware->microseconds ? hardware->microseconds(hardware->context) : 0u;
}

struct passo_deadline passo_driver_deadline(const struct passo *passo, uint64_t clocks)
{
	return (struct passo_deadline){
	    .left = clocks == 0u
	              ? UINT64_MAX
	              : passo_mul_div_ceil(clocks, MICROSECONDS_PER_SECOND, passo->machine.clock_hz),
	    .looked_at = passo_driver_now(passo),
	};
}

uint64_t passo_driver_left(const struct passo *passo, struct passo_deadline *deadline)
{
	const uint32_t now = passo_driver_now(passo), passed = now - deadline->looked_at;

	deadline->looked_at = now;
	deadline->left -= deadline->left < passed ? deadline->left : passed;
	return deadline->left;
}

enum passo_error passo_driver_write(
    struct passo *passo, uint16_t address, const uint32_t *words, size_t length)
{
	return passo_host_write(passo->host, (uint16_t)(passo->base + address), words, length);
}

enum passo_error passo_driver_command(struct passo *passo, struct passo_channel_command command)
{
	const uint32_t word = passo_pack_channel_command(&command);

	return passo_driver_write(passo, PASSO_CHANNEL_COMMAND, &word, 1);
}

uint32_t passo_driver_run(const struct passo *passo, enum passo_gate gate)
{
	const unsigned bit = 1u << passo->channel;
	struct passo_run run = passo_unpack_run(passo->host->run);

	run.status_channel = passo->channel;
	run.run = (uint8_t)(gate != PASSO_GATE_CLOSED ? run.run | bit : run.run & ~bit);
	if (gate != PASSO_GATE_CLOSED) /* else a motion that waits for sync would start */
		run.wait_sync =
		    (uint8_t)(gate == PASSO_GATE_SYNC ? run.wait_sync | bit : run.wait_sync & ~bit);
	return passo_pack_run(&run);
}

enum passo_error passo_driver_gate(struct passo *passo, enum passo_gate gate)
{
	const uint32_t word = passo_driver_run(passo, gate);

	if (word == passo->host->run && !passo->host->run_due)
		return PASSO_OK;
	return passo_host_write(passo->host, PASSO_ADDRESS_RUN, &word, 1);
}

enum passo_error passo_driver_moving(enum passo_error error)
{
	const bool is_busy = (unsigned)error == PASSO_ERROR_REFUSED + PASSO_VERDICT_BUSY;

	return is_busy ? PASSO_ERROR_MOVING : error;
}

uint64_t passo_clocks(const struct passo *passo, uint32_t microseconds)
{
	return (uint64_t)microseconds * passo->machine.clock_hz / 1000000u;
}

const struct passo_machine *passo_machine(const struct passo *passo)
{
	return &passo->machine;
}

uint8_t passo_axes(const struct passo *passo)
{
	return passo->axes;
}
