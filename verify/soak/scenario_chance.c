/* SPDX-License-Identifier: MIT
 * Random numbers.
 */
#include "scenario.h"

void scenario_seed(struct scenario_random *random, uint64_t seed, uint64_t number)
{
	uint64_t z = seed * UINT64_C(0x9E3779B97F4A7C15) + number + 1u;

	for (unsigned i = 0; i < 3u; i++) {
		z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
		z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
		z ^= z >> 31;
	}
	random->state = z | 1u;
}

uint32_t scenario_draw(struct scenario_random *random, uint32_t below)
{
	uint64_t x = random->state;

	x ^= x >> 12;
	x ^= x << 25;
	x ^= x >> 27;
	random->state = x;
	return below == 0u ? 0u : (uint32_t)((x * UINT64_C(0x2545F4914F6CDD1D) >> 32) % below);
}

bool scenario_chance(struct scenario_random *random, uint32_t percent)
{
	return scenario_draw(random, 100) < percent;
}

uint32_t scenario_log(struct scenario_random *random, uint32_t from, uint32_t to)
{
	uint32_t doublings = 0;

	while (from << doublings < to)
		doublings++;
	const uint32_t low = from << scenario_draw(random, doublings + 1u);
	const uint32_t value = low + scenario_draw(random, low);
	return value > to ? to : value;
}
