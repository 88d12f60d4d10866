/* SPDX-License-Identifier: MIT
 * Record of the pins for verify/soak/player.v.
 */
#include "world_private.h"

void world_note_pins(
    struct world *world, const struct passo_inputs *inputs, const struct passo_outputs *outputs)
{
	const bool same = PASSO_SAME_OUTPUTS(outputs, &world->recorded_outputs)
	               && outputs->spi_miso == world->recorded_outputs.spi_miso
	               && PASSO_SAME_INPUTS(inputs, &world->recorded_inputs);

	if (same || world->recorded_clocks == 0u) {
		world->recorded_clocks++;
	} else {
		world_end_record(world);
		world->recorded_clocks = 1;
	}
	world->recorded_inputs = *inputs;
	world->recorded_outputs = *outputs;
}

/* Writes the clocks recorded with equal inputs and outputs. */
static void write_run(struct world *world)
{
	const struct passo_inputs *inputs = &world->recorded_inputs;
	const struct passo_outputs *outputs = &world->recorded_outputs;

	if (world->record) {
		fprintf(world->record, "%llx", (unsigned long long)world->recorded_clocks);
#define WRITE_INPUT(name, type, number) fprintf(world->record, " %llx", (unsigned long long)inputs->name);
#define WRITE_OUTPUT(name, type, number) fprintf(world->record, " %llx", (unsigned long long)outputs->name);
		PASSO_INPUTS(WRITE_INPUT)
		PASSO_OUTPUTS(WRITE_OUTPUT)
#undef WRITE_INPUT
#undef WRITE_OUTPUT
		fprintf(world->record, " %x\n", outputs->spi_miso ? 1u : 0u);
	}
	world->recorded_clocks = 0;
}

void world_end_record(struct world *world)
{
	if (world->recorded_clocks != 0u)
		write_run(world);
}

void world_record_estop(struct world *world)
{
	world->recorded_inputs.estop_n = false;
	passo_core_estop(&world->model, false, &world->recorded_outputs);
	write_run(world);
}
