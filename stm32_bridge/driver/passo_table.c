/* SPDX-License-Identifier: MIT
 * The shape tables of the core: their contents, and loading them.
 *
 * The tables cannot be read back, so the host keeps track; after writes of another host their contents are
 * unknown.
 */
#include "passo_driver.h"

/* Contents of a bank: unknown, the points after reset, an alpha (below 2^31), or the CRC of user-defined
 * points. */
#define HOLDS_UNKNOWN 0u
#define HOLDS_RESET 1u
#define HOLDS_USER UINT32_C(0x80000000)
#define BLOCK PASSO_FRAME_PAYLOAD_MAX

void passo_driver_tables_fresh(struct passo_host *host)
{
	for (unsigned bank = 0; bank < PASSO_BANKS; bank++)
		host->table[bank] = HOLDS_RESET;
}

static uint32_t user_id(const uint16_t *points)
{
	uint32_t crc = PASSO_CRC_START;

	for (unsigned k = 0; k < PASSO_TABLE_SIZE; k++) {
		uint32_t point = points[k];
		crc = passo_crc(crc, &point, 1);
	}
	return crc | HOLDS_USER;
}

/* No points: those after a reset. */
static enum passo_error load(struct passo_host *host, unsigned bank, const uint16_t *points)
{
	const uint16_t address = passo_shape_addresses[bank - 1u];
	uint32_t words[BLOCK];

	for (unsigned k = 0; k < PASSO_TABLE_SIZE; k += BLOCK) {
		unsigned count = PASSO_TABLE_SIZE - k < BLOCK ? PASSO_TABLE_SIZE - k : BLOCK;
		for (unsigned i = 0; i < count; i++)
			words[i] = points ? points[k + i] : passo_shape_point(bank, k + i);
		enum passo_error error = passo_host_write(host, (uint16_t)(address + k), words, count);
		if (error != PASSO_OK)
			return error;
	}
	return PASSO_OK;
}

static enum passo_error load_sigmoid(struct passo_host *host, uint32_t alpha)
{
	uint16_t points[PASSO_TABLE_SIZE];

	if (passo_sigmoid_table(alpha, points) != PASSO_PLAN_OK)
		return PASSO_ERROR_ARGUMENT_PLAN;
	return load(host, PASSO_SHAPE_SIGMOID, points);
}

static enum passo_error make_hold(struct passo *passo, unsigned bank, uint32_t alpha, const uint16_t *user)
{
	uint32_t *holds = &passo->host->table[bank - 1u];
	enum passo_error error;
	uint32_t wanted = HOLDS_RESET;

	if (user)
		wanted = user_id(user);
	else if (bank == PASSO_SHAPE_SIGMOID && alpha != PASSO_SIGMOID_ALPHA_RESET)
		wanted = alpha;

	if (*holds == wanted)
		return PASSO_OK;
	if (!passo_driver_at_rest(passo) || passo_unpack_status(passo->host->status).any_occupied)
		return PASSO_ERROR_TABLE;
	*holds = HOLDS_UNKNOWN;
	if (!user && bank == PASSO_SHAPE_SIGMOID)
		error = load_sigmoid(passo->host, alpha);
	else
		error = load(passo->host, bank, user);
	if (error == PASSO_OK)
		*holds = wanted;
	return (unsigned)error == PASSO_ERROR_REFUSED + PASSO_VERDICT_BUSY ? PASSO_ERROR_TABLE : error;
}

enum passo_error passo_driver_tables(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape)
{
	for (uint32_t i = 0; i < plan->ramp_count; i++) {
		const unsigned bank = (unsigned)plan->ramps[i].shape;
		if (bank == PASSO_SHAPE_LINEAR)
			continue;
#ifdef PASSO_LINEAR_MOVES /* for the flash of a small controller */
		return PASSO_ERROR_TABLE;
#endif
		const uint16_t *user = shape && (unsigned)shape->bank == bank ? shape->table : NULL;
		enum passo_error error = make_hold(passo, bank, plan->sigmoid_alpha, user);
		if (error != PASSO_OK)
			return error;
	}
	return PASSO_OK;
}

enum passo_error passo_load_table(struct passo *passo, enum passo_shape bank, const uint16_t *points)
{
	struct passo_table_facts facts;
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (bank == PASSO_SHAPE_LINEAR || (unsigned)bank > PASSO_BANKS)
		return PASSO_ERROR_ARGUMENT_SHAPE;
	if (points && passo_table_check(points, &facts) != PASSO_PLAN_OK)
		return PASSO_ERROR_ARGUMENT_SHAPE;
	error = passo_driver_ready(passo, true);
	if (error == PASSO_ERROR_MOVING)
		return PASSO_ERROR_TABLE;
	return error != PASSO_OK ? error
	                         : make_hold(passo, (unsigned)bank, PASSO_SIGMOID_ALPHA_RESET, points);
}
