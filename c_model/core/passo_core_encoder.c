/* SPDX-License-Identifier: MIT
 * Encoder: quadrature and index of one axis. See rtl/passo_encoder.v and rtl/passo_encoder_filter.v.
 */
#include "passo_core_encoder.h"

#include "passo_least.h"

static bool sampled(const struct passo_encoder_filter *filter)
{
	return (filter->sync & 2u) != 0u;
}

static void filter_clock(struct passo_encoder_filter *filter, bool pin, uint8_t length)
{
	const bool differs = sampled(filter) != filter->level;
	const bool accepted = filter->count >= length;

	if (differs && accepted)
		filter->level = sampled(filter);
	filter->count = differs && !accepted ? (uint8_t)(filter->count + 1u) : 0u;
	filter->sync = (uint8_t)((filter->sync << 1 | (pin ? 1 : 0)) & 3);
}

static bool active(const struct passo_encoder *encoder, const struct passo_encoder_wires *wires)
{
	return encoder->index.level != wires->index_inverted
	    && (!wires->index_gated || (encoder->a.level && encoder->b.level));
}

void passo_encoder_reset(struct passo_encoder *encoder)
{
	*encoder = (struct passo_encoder){.active_q = true};
}

static void restart_filter(struct passo_encoder_filter *filter, const struct passo_encoder_filter *before)
{
	filter->level = sampled(before);
	filter->count = 0;
}

void passo_encoder_restart(struct passo_encoder *encoder, const struct passo_encoder *before)
{
	restart_filter(&encoder->a, &before->a);
	restart_filter(&encoder->b, &before->b);
	restart_filter(&encoder->index, &before->index);
	encoder->a_q = encoder->a.level;
	encoder->b_q = encoder->b.level;
	encoder->active_q = true;
	encoder->count_made = encoder->count_down = encoder->slipped = encoder->index_event = false;
	encoder->illegal = 0;
}

void passo_encoder_clock(struct passo_encoder *encoder, const struct passo_encoder_wires *wires)
{
	const bool a = encoder->a.level;
	const bool b = encoder->b.level;
	const bool changed_a = a != encoder->a_q;
	const bool changed_b = b != encoder->b_q;
	const bool now_active = active(encoder, wires);

	encoder->count_made = changed_a != changed_b;
	encoder->count_down = (a == encoder->b_q) != wires->inverted;
	encoder->slipped = changed_a && changed_b;
	encoder->index_event = now_active && !encoder->active_q;
	if (encoder->slipped && encoder->illegal != 0xFFu)
		encoder->illegal++;
	if (wires->clear)
		encoder->illegal = 0;
	encoder->a_q = a;
	encoder->b_q = b;
	encoder->active_q = now_active;
	filter_clock(&encoder->a, wires->a, wires->filter);
	filter_clock(&encoder->b, wires->b, wires->filter);
	filter_clock(&encoder->index, wires->index, wires->filter);
}

static uint64_t filter_quiet(const struct passo_encoder_filter *filter, bool pin, uint8_t length)
{
	if (filter->sync != (pin ? 3u : 0u))
		return 0;
	if (filter->level == pin)
		return filter->count == 0u ? UINT64_MAX : 0u;
	return filter->count < length ? (uint64_t)(length - filter->count) : 0u;
}

uint64_t passo_encoder_quiet(const struct passo_encoder *encoder, const struct passo_encoder_wires *wires)
{
	const bool a = encoder->a.level, b = encoder->b.level;
	uint64_t clocks;

	if (encoder->a_q != a || encoder->b_q != b || encoder->active_q != active(encoder, wires)
	    || encoder->count_down != ((a == b) != wires->inverted) || encoder->count_made || encoder->slipped
	    || encoder->index_event || wires->clear)
		return 0;
	clocks = passo_least(filter_quiet(&encoder->a, wires->a, wires->filter),
	    filter_quiet(&encoder->b, wires->b, wires->filter));
	return passo_least(clocks, filter_quiet(&encoder->index, wires->index, wires->filter));
}

static void filter_skip(struct passo_encoder_filter *filter, uint64_t clocks)
{
	if (sampled(filter) != filter->level)
		filter->count = (uint8_t)(filter->count + clocks);
}

void passo_encoder_skip(struct passo_encoder *encoder, uint64_t clocks)
{
	filter_skip(&encoder->a, clocks);
	filter_skip(&encoder->b, clocks);
	filter_skip(&encoder->index, clocks);
}
