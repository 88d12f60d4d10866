/* SPDX-License-Identifier: MIT
 * Shared by the inputs of all channels: the tick of the filter, e-stop, watchdog. See rtl/passo_machine.v,
 * rtl/passo_estop.v and rtl/passo_watchdog.v.
 */
#include "passo_model.h"
#include "passo_words.h"

static const unsigned UNIT_LOG2 = 16; /* clocks of a unit of the watchdog, which counts up to 1023 of them */

void passo_machine_reset(struct passo_machine_unit *machine)
{
	*machine = (struct passo_machine_unit){.watchdog_holds = true};
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

static uint32_t unit_ticks(unsigned tick_log2)
{
	return 1u << (UNIT_LOG2 - tick_log2);
}

static uint16_t wanted(const struct passo_machine_unit *machine)
{
	return machine->watchdog_stop ? machine->watchdog_disable_after : machine->watchdog_stop_after;
}

static bool is_over(const struct passo_machine_unit *machine, unsigned tick_log2)
{
	return machine->watchdog_count / unit_ticks(tick_log2) == wanted(machine);
}

static bool may_trip(const struct passo_machine_unit *machine, bool moving)
{
	return machine->watchdog_silent && moving && !machine->watchdog_stop;
}

static void clock_watchdog(
    struct passo_machine_unit *machine, bool feed, const struct passo_machine_wires *wires)
{
	const bool over = is_over(machine, wires->tick_log2), stop = machine->watchdog_stop;
	const bool ends = over && !machine->watchdog_holds;
	const bool trips = may_trip(machine, wires->moving) && wires->slew_tick;

	if (wires->slew_tick && !machine->watchdog_holds)
		machine->watchdog_count =
		    (machine->watchdog_count + 1u) % (1024u * unit_ticks(wires->tick_log2));
	machine->watchdog_holds = over || feed || trips;
	machine->watchdog_silent = (machine->watchdog_silent || ends) && !feed;
	machine->watchdog_stop = (stop || trips) && !feed;
	machine->watchdog_disable = (machine->watchdog_disable || (ends && stop)) && !feed;
	if (feed || trips)
		machine->watchdog_count = 0;
}

void passo_machine_clock(struct passo_machine_unit *machine, const struct passo_bus *bus,
    const struct passo_inputs *inputs, const struct passo_machine_wires *wires)
{
	const bool clears = bus->write && bus->address == PASSO_ADDRESS_ESTOP_CLEAR && (bus->data & 1u) != 0u;
	const bool ends = machine->count == machine->filter;
	const bool writes_filter = bus->write && bus->address == PASSO_ADDRESS_INPUT_FILTER;

	machine->tick = ends && !writes_filter;
	machine->count = ends || writes_filter ? 0u : (uint16_t)(machine->count + 1u);
	clock_estop(machine, inputs->estop_n, clears || inputs->rst);
	clock_watchdog(machine, bus->write || bus->read, wires);
	if (writes_filter && !inputs->rst)
		machine->filter = (uint16_t)bus->data;
	if (bus->write && bus->address == PASSO_ADDRESS_WATCHDOG) {
		const struct passo_watchdog word = passo_unpack_watchdog(bus->data);
		machine->watchdog_stop_after = word.stop_after;
		machine->watchdog_disable_after = word.disable_after;
	}
}

/* Clocks until the one on which the watchdog acts. */
static uint64_t watchdog_quiet(const struct passo_machine_unit *machine,
    const struct passo_machine_wires *wires, uint64_t clocks_to_slew)
{
	const bool over = is_over(machine, wires->tick_log2);
	const uint32_t end = wanted(machine) * unit_ticks(wires->tick_log2);

	if (machine->watchdog_holds != over)
		return 0;
	if (may_trip(machine, wires->moving))
		return clocks_to_slew;
	return over ? UINT64_MAX
	            : clocks_to_slew + ((uint64_t)(end - machine->watchdog_count - 1u) << wires->tick_log2);
}

uint64_t passo_machine_quiet(const struct passo_machine_unit *machine, const struct passo_inputs *inputs,
    const struct passo_machine_wires *wires, uint64_t clocks_to_slew)
{
	const bool pressed = machine->estop_pressed;
	const uint8_t seen = pressed ? 3u : 0u, released = inputs->estop_n ? 3u : 0u;

	if (machine->estop_seen != seen || machine->estop_released != released
	    || (!inputs->estop_n && !pressed))
		return 0;
	return watchdog_quiet(machine, wires, clocks_to_slew);
}

void passo_machine_skip(struct passo_machine_unit *machine, uint64_t clocks, uint64_t slew_ticks)
{
	if (!machine->watchdog_holds)
		machine->watchdog_count += (uint32_t)slew_ticks;
	machine->count = (uint16_t)((machine->count + clocks) % (machine->filter + 1u));
	machine->tick = machine->count == 0u;
}
