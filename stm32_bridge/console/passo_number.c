/* SPDX-License-Identifier: MIT */
#include "passo_number.h"

#include <string.h>

#include "passo.h"
#include "passo_decimal.h"

/* Parses a number times 10^power exactly and checks its limits. */
static bool read_decimal(const struct passo_reading *reading, const struct passo_key *key,
    struct passo_item item, int power, bool is_signed, struct passo_decimal *number)
{
	uint32_t limit = is_signed ? PASSO_SIGNED_MAX : PASSO_NUMBER_MAX;

	if (!passo_decimal_read(number, item.text, item.length, power))
		return passo_complain(reading->sink, "%s must be a number, not %Q", key->name, item.text,
		    (uint32_t)item.length);
	if (number->negative && !is_signed && !passo_decimal_is_zero(number))
		return passo_complain(reading->sink, "%s must not be negative", key->name);
	if (passo_decimal_exceeds(number, limit))
		return number->negative
		         ? passo_complain(reading->sink, "%s must be at least -%u", key->name, limit)
		         : passo_complain(reading->sink, "%s must be at most %u", key->name, limit);
	if (number->too_fine)
		return passo_complain(reading->sink, "%s must have at most %u decimals", key->name,
		    (uint32_t)PASSO_DECIMALS_MAX);
	return true;
}

bool passo_number_read(const struct passo_reading *reading, const struct passo_key *key,
    struct passo_item item, uint64_t factor, uint64_t *value)
{
	struct passo_decimal number;

	if (!read_decimal(reading, key, item, 0, false, &number))
		return false;
	*value = passo_decimal_times(&number, factor);
	return true;
}

bool passo_number_signed(
    const struct passo_reading *reading, const struct passo_key *key, struct passo_item item, int64_t *value)
{
	struct passo_decimal number;

	if (!read_decimal(reading, key, item, 0, true, &number))
		return false;
	*value = (int64_t)passo_decimal_times(&number, PASSO_UNIT_Q32);
	if (number.negative)
		*value = -*value;
	return true;
}

bool passo_number_whole(const struct passo_reading *reading, const struct passo_key *key,
    struct passo_item item, uint32_t low, uint32_t high, uint32_t *value)
{
	struct passo_decimal number;

	if (!passo_decimal_read(&number, item.text, item.length, 0) || !number.is_whole)
		return passo_complain(reading->sink, "%s must be a whole number, not %Q", key->name,
		    item.text, (uint32_t)item.length);
	if ((number.negative && number.whole != 0u) || number.whole < low || number.whole > high)
		return passo_complain(reading->sink, "%s must be %u to %u", key->name, low, high);
	*value = (uint32_t)number.whole;
	return true;
}

/* --------------------------------------------------------------------------------------------- times ---- */

/* Splits a time into number and unit. */
static struct passo_item cut_unit(const char *text, int *power, bool *clocks)
{
	static const struct {
		const char *name;
		int power;
	} UNITS[] = {{"clocks", 0}, {"ns", -9}, {"us", -6}, {"ms", -3}, {"s", 0}};
	struct passo_item item = {.text = text, .length = strlen(text)};

	*power = 0;
	*clocks = false;
	for (unsigned i = 0; i < sizeof UNITS / sizeof UNITS[0]; i++) {
		size_t length = strlen(UNITS[i].name);

		if (item.length > length && strcmp(text + item.length - length, UNITS[i].name) == 0) {
			item.length -= length;
			*power = UNITS[i].power;
			*clocks = i == 0u;
			break;
		}
	}
	return item;
}

bool passo_number_time(const struct passo_reading *reading, const struct passo_key *key, const char *text,
    bool round_up, uint64_t *clocks)
{
	struct passo_decimal number;
	int power;
	bool in_clocks;
	struct passo_item item = cut_unit(text, &power, &in_clocks);
	uint32_t factor = in_clocks ? 1u : reading->clock_hz;

	if (!read_decimal(reading, key, item, power, false, &number))
		return false;
	*clocks = round_up ? passo_decimal_times_ceil(&number, factor) : passo_decimal_times(&number, factor);
	return true;
}

bool passo_number_microseconds(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint32_t *value)
{
	struct passo_reading in_microseconds = *reading;
	uint64_t wide;
	int power;
	bool in_clocks;

	cut_unit(text, &power, &in_clocks);
	if (in_clocks)
		return passo_complain(
		    reading->sink, "%s must be in s, ms, us or ns, not %q", key->name, text);
	in_microseconds.clock_hz = 1000000u;
	if (!passo_number_time(&in_microseconds, key, text, false, &wide))
		return false;
	*value = wide > UINT32_MAX ? UINT32_MAX : (uint32_t)wide;
	return true;
}

bool passo_number_pin_time(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint32_t *value)
{
	uint64_t clocks;

	if (!passo_number_time(reading, key, text, true, &clocks))
		return false;
	if (clocks == 0u || clocks > PASSO_PIN_CLOCKS_MAX)
		return passo_complain(reading->sink, "%s is %u clocks; must be 1 to %u", key->name,
		    clocks > UINT32_MAX ? UINT32_MAX : (uint32_t)clocks, PASSO_PIN_CLOCKS_MAX);
	*value = (uint32_t)clocks;
	return true;
}
