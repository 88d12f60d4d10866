/* SPDX-License-Identifier: MIT
 * Shared by the inputs of all channels: the tick of the filter, e-stop, watchdog. See rtl/passo_machine.v,
 * rtl/passo_estop.v and rtl/passo_watchdog.v.
 */
#include "passo_model.h"
#include "passo_words.h"

static const uint32_t UNIT_CLOCKS = 0x10000; /* of the watchdog, and how many of them it counts */
static const uint32_t UNITS = 1024;

void passo_machine_reset(struct passo_machine_unit *machine)
{
	*machine = (struct passo_machine_unit){.watchdog_fed = true};
}

void passo_machine_restart(struct passo_machine_unit *machine, const struct passo_machine_unit *before)
{
	passo_machine_reset(machine);
	machine->filter = before->filter;
	machine->estop_pressed = before->estop_pressed;
	machine->estop_released = before->estop_released;
	machine->estop_seen = before->estop_seen;
}

static void clock_estop(struct passo_machine_unit *machine, bool estop_n, bool clear)
{
	/* asynchronous: it is pressed before the clock */
	const bool pressed = machine->estop_pressed || !estop_n;

	if (!estop_n)
		machine->estop_pressed = true;
	else if ((machine->estop_released & 2u) != 0u && clear)
		machine->estop_pressed = false;
	machine->estop_released = (uint8_t)(estop_n ? (machine->estop_released << 1 | 1) & 3 : 0);
	machine->estop_seen = (uint8_t)((machine->estop_seen << 1 | (pressed ? 1 : 0)) & 3);
}

static void clock_watchdog(struct passo_machine_unit *machine, bool feed, bool moving)
{
	const uint16_t stop_after = machine->watchdog_stop_after;
	const uint16_t disable_after = machine->watchdog_disable_after;
	const bool fed = machine->watchdog_fed, stop = machine->watchdog_stop;
	const bool over = machine->watchdog_count == (stop ? disable_after : stop_after);
	const bool trips = machine->watchdog_silent && moving && !stop;

	machine->watchdog_fed = feed;
	machine->watchdog_unit = (machine->watchdog_unit + 1u) % UNIT_CLOCKS;
	if (machine->watchdog_unit == 0u)
		machine->watchdog_count = (uint16_t)((machine->watchdog_count + 1u) % UNITS);
	if (over && stop_after != 0u)
		machine->watchdog_silent = true;
	if (over && stop && disable_after != 0u)
		machine->watchdog_disable = true;
	if (trips)
		machine->watchdog_stop = true;
	if (fed)
		machine->watchdog_silent = machine->watchdog_stop = machine->watchdog_disable = false;
	if (fed || trips) {
		machine->watchdog_count = 0;
		machine->watchdog_unit = 0;
	}
}

void passo_machine_clock(struct passo_machine_unit *machine, const struct passo_bus *bus,
    const struct passo_inputs *inputs, bool moving)
{
	const bool clears = bus->write && bus->address == PASSO_ADDRESS_ESTOP_CLEAR && (bus->data & 1u) != 0u;
	const bool ends = machine->count == machine->filter;
	const bool writes_filter = bus->write && bus->address == PASSO_ADDRESS_INPUT_FILTER;

	machine->tick = ends && !writes_filter;
	machine->count = ends || writes_filter ? 0u : (uint16_t)(machine->count + 1u);
	clock_estop(machine, inputs->estop_n, clears || inputs->rst);
	clock_watchdog(machine, bus->write || bus->read, moving);
	if (writes_filter && !inputs->rst)
		machine->filter = (uint16_t)bus->data;
	if (bus->write && bus->address == PASSO_ADDRESS_WATCHDOG) {
		const struct passo_watchdog word = passo_unpack_watchdog(bus->data);
		machine->watchdog_stop_after = word.stop_after;
		machine->watchdog_disable_after = word.disable_after;
	}
}

/* Clocks until the watchdog acts. */
static uint64_t watchdog_quiet(const struct passo_machine_unit *machine)
{
	const bool stop = machine->watchdog_stop;
	const uint16_t wanted = stop ? machine->watchdog_disable_after : machine->watchdog_stop_after;
	const bool done = stop ? machine->watchdog_disable : machine->watchdog_silent;
	const uint64_t clocks = (uint64_t)machine->watchdog_count * UNIT_CLOCKS + machine->watchdog_unit;
	const uint64_t end = (uint64_t)wanted * UNIT_CLOCKS;

	if (wanted == 0u || done)
		return UINT64_MAX;
	return clocks < end ? end - clocks : 0u;
}

uint64_t passo_machine_quiet(
    const struct passo_machine_unit *machine, const struct passo_inputs *inputs, bool moving)
{
	const bool pressed = machine->estop_pressed;
	const uint8_t seen = pressed ? 3u : 0u, released = inputs->estop_n ? 3u : 0u;
	const bool trips = machine->watchdog_silent && moving && !machine->watchdog_stop;

	if (machine->watchdog_fed || trips || machine->estop_seen != seen
	    || machine->estop_released != released || (!inputs->estop_n && !pressed))
		return 0;
	return watchdog_quiet(machine);
}

void passo_machine_skip(struct passo_machine_unit *machine, uint64_t clocks)
{
	const uint64_t silence =
	    (uint64_t)machine->watchdog_count * UNIT_CLOCKS + machine->watchdog_unit + clocks;

	machine->watchdog_count = (uint16_t)(silence / UNIT_CLOCKS % UNITS);
	machine->watchdog_unit = (uint32_t)(silence % UNIT_CLOCKS);
	machine->count = (uint16_t)((machine->count + clocks) % (machine->filter + 1u));
	machine->tick = machine->count == 0u;
}
