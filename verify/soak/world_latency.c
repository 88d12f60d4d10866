/* SPDX-License-Identifier: MIT
 * When words take effect: latencies of the core, measured on the model.
 */
#include "address.h"
#include "world.h"

static int64_t word_clocks(const struct world *world)
{
	return 64 * (int64_t)world->half_period;
}

int64_t world_executes(const struct world *world, unsigned length, unsigned index)
{
	return (int64_t)world->setup + ((int64_t)length + 2) * word_clocks(world) + world->latency->pins
	     + 4 * (int64_t)index;
}

int64_t world_checks(const struct world *world, unsigned index)
{
	return (int64_t)world->setup + ((int64_t)index + 2) * word_clocks(world) + world->latency->check;
}

/* Writes one word to a new model; returns the latency from the end of the CRC word to the first pin
 * change. */
static int64_t first_change(uint16_t address, uint32_t value)
{
	const struct passo_parameters parameters = {
	    .channels = 1, .axes = 1, .tick_log2 = 7, .line_queue_log2 = 2, .ramp_queue_log2 = 2};
	static struct world world;
	uint32_t mosi[PASSO_FRAME_WORDS_MAX], miso[PASSO_FRAME_WORDS_MAX];

	if (!world_open(&world, &parameters, NULL))
		return -1;
	world_run(&world, 100);
	const uint64_t begin = world.clock;
	const size_t count = passo_frame_write(mosi, 1, address, &value, 1);
	world_exchange(&world, mosi, miso, count, 32u * count);
	world_run(&world, 100);
	if (world.row_count < 2u)
		return -1;
	return (int64_t)(world.rows[1].clock - begin) - (int64_t)world.setup - 3 * word_clocks(&world);
}

bool world_measure(struct world_latency *latency)
{
	latency->pins =
	    first_change(axis_address(0, 0, PASSO_AXIS_PINS), 1u << PASSO_AXIS_PINS_STEP_INVERTED_LSB);
	latency->enable = first_change(axis_address(0, 0, PASSO_AXIS_ENABLE), 1u << PASSO_AXIS_ENABLE_LSB);
	latency->command =
	    first_change(channel_address(0, PASSO_CHANNEL_COMMAND), 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB);
	latency->check = 40;
	return latency->pins > 0 && latency->enable > 0 && latency->command > 0;
}
