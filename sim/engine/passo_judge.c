/* SPDX-License-Identifier: MIT
 * Compares recorded pins of the core with the C model on every clock.
 */
#include "passo_judge.h"

#include <string.h>

#include "passo_core.h"

/* Pin levels from this clock on: inputs and MISO sampled at its rising edge, the others after the previous
 * edge. */
struct judge_row {
	uint64_t clock;
	uint64_t inputs[PASSO_INPUT_COUNT];
	uint64_t miso;
	uint64_t outputs[PASSO_OUTPUT_COUNT];
};

struct judge {
	struct passo_core core;
	struct judge_row now;
	uint64_t clock;                            /* executed */
	uint64_t matched[PASSO_OUTPUT_COUNT + 1u]; /* edges of the outputs, and bits of MISO when SCLK rose */
	uint64_t difference_clock;
	uint32_t difference_signal; /* index in outputs; MISO follows */
	uint64_t expected, actual;
};

uint64_t judge_size(void)
{
	return sizeof(struct judge);
}

bool judge_reset(void *room, const struct passo_parameters *parameters)
{
	struct judge *judge = room;

	memset(judge, 0, sizeof *judge);
	return passo_core_reset(&judge->core, parameters);
}

static bool differs(struct judge *judge, uint64_t clock, uint32_t signal, uint64_t expected, uint64_t actual)
{
	if (expected == actual)
		return false;
	judge->difference_clock = clock;
	judge->difference_signal = signal;
	judge->expected = expected;
	judge->actual = actual;
	return true;
}

static unsigned ones(uint64_t bits)
{
	unsigned count = 0;
	for (; bits != 0u; bits &= bits - 1u)
		count++;
	return count;
}

static struct passo_inputs inputs_of(const struct judge_row *row)
{
	struct passo_inputs inputs;

#define TAKE(name, type, number) inputs.name = (type)row->inputs[number];
	PASSO_INPUTS(TAKE)
#undef TAKE
	return inputs;
}

static bool compare_outputs(struct judge *judge, const struct judge_row *row)
{
	struct passo_outputs now = *passo_core_outputs(&judge->core);
	const struct passo_outputs *model = &now;

	passo_core_estop(&judge->core, row->inputs[PASSO_INPUT_ESTOP_N] != 0u, &now);

#define COMPARE(name, type, number)                                                                          \
	if (differs(judge, judge->clock, number, model->name, row->outputs[number]))                         \
		return false;
	PASSO_OUTPUTS(COMPARE)
#undef COMPARE
	return true;
}

bool judge_follow(void *room, const void *recorded, size_t count, uint64_t until)
{
	struct judge *judge = room;
	const struct judge_row *rows = recorded;
	size_t next = 0;

	while (judge->clock < until) {
		struct judge_row *now = &judge->now;
		const bool sclk_was = now->inputs[PASSO_INPUT_SPI_SCLK] != 0u;

		if (next < count && rows[next].clock == judge->clock + 1u) {
			for (unsigned i = 0; i < PASSO_OUTPUT_COUNT && judge->clock != 0u; i++)
				judge->matched[i] += ones(rows[next].outputs[i] ^ now->outputs[i]);
			*now = rows[next++];
		}
		if (!compare_outputs(judge, now))
			return false;
		const struct passo_inputs inputs = inputs_of(now);
		passo_core_clock(&judge->core, &inputs);
		judge->clock++;
		/* MISO follows SCLK, not the clock: the model shows it with the edge that sees SCLK. */
		if (differs(judge, judge->clock, PASSO_OUTPUT_COUNT,
			passo_core_outputs(&judge->core)->spi_miso ? 1u : 0u, now->miso))
			return false;
		judge->matched[PASSO_OUTPUT_COUNT] +=
		    inputs.spi_sclk && !sclk_was && !inputs.spi_cs_n ? 1u : 0u;
	}
	return true;
}

void judge_difference(const void *room, uint64_t difference[4])
{
	const struct judge *judge = room;

	difference[0] = judge->difference_clock;
	difference[1] = judge->difference_signal;
	difference[2] = judge->expected;
	difference[3] = judge->actual;
}

void judge_matched(const void *room, uint64_t *matched)
{
	const struct judge *judge = room;

	memcpy(matched, judge->matched, sizeof judge->matched);
}
