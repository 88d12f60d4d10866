/* SPDX-License-Identifier: MIT
 * User-defined shapes: 257 points, the last of which is always 1, with linear interpolation.
 */
#include "passo_math.h"
#include "passo_plan_draft.h"
#include "passo_shapes.h"

static const int32_t ONE = 65536;

enum passo_plan_error passo_table_check(
    const uint16_t table[PASSO_TABLE_SIZE], struct passo_table_facts *facts)
{
	enum passo_plan_error error = table[0] == 0 ? PASSO_PLAN_OK : PASSO_PLAN_TABLE_START;
	uint32_t sum = table[0];
	*facts = (struct passo_table_facts){.symmetric = table[0] == 0};
	for (uint32_t k = 1; k < PASSO_TABLE_SIZE; k++) {
		sum += table[k];
		if (table[k] < table[k - 1] && error == PASSO_PLAN_OK) {
			error = PASSO_PLAN_TABLE_FALLS;
			facts->worst = (uint16_t)k;
		}
	}
	for (uint32_t k = 1; k <= PASSO_TABLE_SIZE / 2; k++)
		facts->symmetric &= table[k] + table[PASSO_TABLE_SIZE - k] == ONE;
	/* Trapezoidal rule, in units of 2^-16 / 256: the first point and the last, which is 1, count half. */
	facts->mean = sum + (uint32_t)(ONE - table[0]) / 2;
	return error;
}

/* Error of the midpoint sum over a ramp's ticks against the mean of its shape, in units of 2^-24. Straight
 * lines are summed exactly; each bend adds half its change of slope times the square of its distance from the
 * nearest tick boundary. Bend k is k * ticks / 256 ticks into the ramp. */
static int64_t bends(const uint16_t table[PASSO_TABLE_SIZE], uint64_t ticks)
{
	int64_t sum = 0;
	int32_t slope = table[1] - table[0];
	uint32_t into = 0;
	for (uint32_t k = 1; k < PASSO_TABLE_SIZE; k++) {
		int32_t next_slope = (k + 1 < PASSO_TABLE_SIZE ? table[k + 1] : ONE) - table[k];
		into = (into + (uint32_t)ticks) % PASSO_TABLE_SIZE;
		int32_t distance = ((int32_t)into ^ 128) - 128; /* -128 .. 127 */
		sum += (int64_t)(next_slope - slope) * (distance * distance);
		slope = next_slope;
	}
	return sum / (int64_t)(2 * ticks);
}

/* A mirrored shape has the complementary mean and bends in the other direction. The missing end of the
 * progress reduces the part above the mean. */
static uint64_t table_weight(const struct passo_draft *draft, uint64_t ticks, bool mirror)
{
	const uint64_t one = UINT64_C(1) << PASSO_WEIGHT_BITS;
	uint64_t mean = mirror ? one - draft->mean : draft->mean;
	int64_t above = (int64_t)((one - mean) >> 8);
	int64_t lacking = passo_lacking_weight(ticks, 2 * ticks) * above / (PASSO_MEAN_HALF >> 8);
	int64_t bent = bends(draft->table, ticks);
	return ticks * mean - (uint64_t)(mirror ? -bent : bent) - (uint64_t)lacking;
}

static uint32_t start_draft(struct passo_draft *draft, const struct passo_machine *machine,
    const int32_t *steps, const struct passo_user_shape *shape)
{
	enum passo_plan_error error = passo_draft_start(draft, machine, steps, PASSO_PROFILE_LINEAR);
	if (error != PASSO_PLAN_OK)
		return error;
	if (shape->bank == PASSO_SHAPE_LINEAR || (unsigned)shape->bank > PASSO_BANKS)
		return PASSO_PLAN_BAD_BANK;
	struct passo_table_facts facts;
	uint32_t refused = passo_table_check(shape->table, &facts);
	if (refused != PASSO_PLAN_OK)
		return refused;
	draft->shape = shape->bank;
	draft->table = shape->table;
	draft->mirrors = !shape->forward;
	draft->mean = facts.mean;
	draft->table_weight = table_weight;
	return PASSO_PLAN_OK;
}

enum passo_plan_error passo_plan_user_in_time(const struct passo_machine *machine,
    const struct passo_move_in_time *move, const struct passo_user_shape *shape, struct passo_plan *plan)
{
	struct passo_draft draft;
	uint32_t refused = start_draft(&draft, machine, move->steps, shape);
	if (refused != PASSO_PLAN_OK)
		return refused;
	return passo_draft_in_time(&draft, move->total_clocks, move->ramp_clocks, plan);
}

enum passo_plan_error passo_plan_user_by_speed(const struct passo_machine *machine,
    const struct passo_move_by_speed *move, const struct passo_user_shape *shape, struct passo_plan *plan)
{
	struct passo_draft draft;
	uint32_t refused = start_draft(&draft, machine, move->steps, shape);
	if (refused != PASSO_PLAN_OK)
		return refused;
	const struct passo_limits limits = passo_limits_of(move);
	return passo_draft_by_speed(&draft, &limits, plan);
}
