/* SPDX-License-Identifier: MIT
 * Rules of the registers: what each access of a frame is answered. See rtl/passo_rules.v.
 */
#include "passo_rules.h"

#include "passo_shapes.h"

static bool has_part(const struct passo_parameters *parameters, enum passo_part part)
{
	switch (part) {
	case PASSO_PART_INPUTS:
		return parameters->inputs != 0u;
	case PASSO_PART_ENCODERS:
		return parameters->encoders != 0u;
	case PASSO_PART_OUTPUTS:
		return parameters->outputs != 0u;
	case PASSO_PART_TRACKERS:
		return parameters->trackers != 0u;
	case PASSO_PART_RASTER:
		return parameters->raster != 0u;
	case PASSO_PART_COMPARE:
		return parameters->compare != 0u;
	case PASSO_PART_NONE:
		break;
	}
	return true;
}

/* Of a register of a channel; `axis` is that of its block or of its word. */
static struct passo_rule rule_in_channel(unsigned address, unsigned *axis)
{
	if (address >= PASSO_CHANNEL_ENCODER_BASE) {
		*axis = (address - PASSO_CHANNEL_ENCODER_BASE) / PASSO_CHANNEL_ENCODER_STRIDE;
		return passo_encoder_rule(address % PASSO_CHANNEL_ENCODER_STRIDE);
	}
	if (address >= PASSO_CHANNEL_AXIS_BASE) {
		*axis = (address - PASSO_CHANNEL_AXIS_BASE) / PASSO_CHANNEL_AXIS_STRIDE;
		return passo_axis_rule(address % PASSO_CHANNEL_AXIS_STRIDE);
	}
	const struct passo_rule rule = passo_channel_rule(address);
	*axis = rule.per_axis ? address % PASSO_AXES_MAX : 0u;
	return rule;
}

struct passo_rule passo_rule_at(const struct passo_parameters *parameters, uint16_t address)
{
	const unsigned block = (unsigned)address >> 8;
	struct passo_rule rule = {0};
	unsigned axis = 0;

	if (block == 0u)
		rule = passo_core_rule(address);
	else if (passo_bank_at(address) != 0u)
		rule = passo_shape_rule();
	else if (block <= parameters->channels)
		rule = rule_in_channel(address & 0xFFu, &axis);
	return has_part(parameters, rule.part) && axis < parameters->axes ? rule : (struct passo_rule){0};
}

bool passo_rule_exists(const struct passo_rule *rule)
{
	return rule->read || rule->write || rule->push;
}

uint8_t passo_rule_refusal(const struct passo_rule *rule, const struct passo_bus *bus, bool bad_value)
{
	if (bus->read)
		return rule->read ? PASSO_VERDICT_OK : PASSO_VERDICT_BAD_OPERATION;
	if (bus->push != rule->push)
		return PASSO_VERDICT_BAD_OPERATION;
	if (rule->push)
		return PASSO_VERDICT_OK;
	if (!rule->write)
		return PASSO_VERDICT_READ_ONLY;
	return (bus->data & ~rule->defined) != 0u || bus->data > rule->maximum
	            || (rule->nonzero && bus->data == 0u) || bad_value
	         ? PASSO_VERDICT_BAD_VALUE
	         : PASSO_VERDICT_OK;
}
