/* SPDX-License-Identifier: MIT
 * Compares the recorded pins of the core (probes/passo_spi_top.vh) with the C model on every clock.
 */
#include <stddef.h>
#include <string.h>

#include "passo_core.h"

/* Pin levels from this clock on: inputs and MISO sampled at its rising edge, the others after the previous
 * edge. */
struct judge_row {
	uint64_t clock;
	uint64_t inputs; /* rst, sclk, mosi, cs_n, sync: bits 4 .. 0 */
	uint64_t miso;
	uint64_t outputs[5]; /* step, dir, enable, running, irq */
};

struct judge {
	struct passo_core core;
	struct judge_row now;
	uint64_t clock;      /* executed */
	uint64_t matched[6]; /* edges of the outputs, and bits of MISO when SCLK rose */
	uint64_t difference_clock;
	uint32_t difference_signal; /* index in outputs; 5 is MISO */
	uint64_t expected, actual;
};

uint64_t judge_size(void)
{
	return sizeof(struct judge);
}

bool judge_reset(struct judge *judge, const uint8_t parameters[5])
{
	const struct passo_parameters wanted = {.channels = parameters[0],
	    .axes = parameters[1],
	    .tick_log2 = parameters[2],
	    .line_queue_log2 = parameters[3],
	    .ramp_queue_log2 = parameters[4]};

	memset(judge, 0, sizeof *judge);
	return passo_core_reset(&judge->core, &wanted);
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

static bool compare_outputs(struct judge *judge, const struct judge_row *row)
{
	const struct passo_outputs *model = passo_core_outputs(&judge->core);
	const uint64_t expected[5] = {
	    model->step, model->dir, model->enable, model->running, model->irq ? 1u : 0u};

	for (uint32_t i = 0; i < 5u; i++)
		if (differs(judge, judge->clock, i, expected[i], row->outputs[i]))
			return false;
	return true;
}

/* Compares up to the clock `until`, which must not be before the last row. False at the first difference. */
bool judge_follow(struct judge *judge, const struct judge_row *rows, size_t count, uint64_t until)
{
	size_t next = 0;

	while (judge->clock < until) {
		struct judge_row *now = &judge->now;
		const bool sclk_was = (now->inputs >> 3 & 1u) != 0u;

		if (next < count && rows[next].clock == judge->clock + 1u) {
			for (unsigned i = 0; i < 5u && judge->clock != 0u; i++)
				judge->matched[i] += ones(rows[next].outputs[i] ^ now->outputs[i]);
			*now = rows[next++];
		}
		if (!compare_outputs(judge, now))
			return false;
		const struct passo_inputs inputs = {.spi_sclk = (now->inputs >> 3 & 1u) != 0u,
		    .spi_mosi = (now->inputs >> 2 & 1u) != 0u,
		    .spi_cs_n = (now->inputs >> 1 & 1u) != 0u,
		    .sync = (now->inputs & 1u) != 0u,
		    .rst = (now->inputs >> 4 & 1u) != 0u};
		passo_core_clock(&judge->core, &inputs);
		judge->clock++;
		/* MISO follows SCLK, not the clock: the model shows it with the edge that sees SCLK. */
		if (differs(judge, judge->clock, 5, passo_core_outputs(&judge->core)->spi_miso ? 1u : 0u,
			now->miso))
			return false;
		judge->matched[5] += inputs.spi_sclk && !sclk_was && !inputs.spi_cs_n ? 1u : 0u;
	}
	return true;
}

void judge_difference(const struct judge *judge, uint64_t difference[4])
{
	difference[0] = judge->difference_clock;
	difference[1] = judge->difference_signal;
	difference[2] = judge->expected;
	difference[3] = judge->actual;
}

void judge_matched(const struct judge *judge, uint64_t matched[6])
{
	memcpy(matched, judge->matched, sizeof judge->matched);
}
