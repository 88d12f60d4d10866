/* SPDX-License-Identifier: MIT
 * One interface to two engines that execute the core: the C model and the Verilated RTL.
 * Both are driven through the same pins by the same SPI master, so the same calls produce the same input
 * waveforms. Changes of the output pins are recorded in the pin log.
 */
#ifndef PASSO_ENGINE_H
#define PASSO_ENGINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_pins.h"
#include "passo_rig.h"

#ifdef __cplusplus
extern "C" {
#endif

struct passo_engine_config {
	struct passo_parameters core;
	uint32_t clock_hz;        /* time scale of the waves */
	uint32_t spi_half_period; /* clocks per SCLK level, at least 1 */
	uint32_t every_clock;     /* 1: the model executes every clock instead of skipping quiet time */
};

struct passo_engine;

/* NULL if memory is short or the library was built for other parameters. */
struct passo_engine *passo_engine_create(const struct passo_engine_config *config);
void passo_engine_destroy(struct passo_engine *engine);

/* One chip select: sends and receives `count` words, then waits for `gap` clocks. */
void passo_engine_transfer(
    struct passo_engine *engine, const uint32_t *mosi, uint32_t *miso, size_t count, uint64_t gap);

/* Connects a machine to the pins, instead of one before; returns it, null if memory is short. It belongs to
 * the engine. */
struct passo_rig *passo_engine_attach(struct passo_engine *engine, const struct passo_rig_config *config);

/* Runs for up to `clocks`, fewer if the log is full or an event of the machine calls; returns the clocks
 * executed. */
uint64_t passo_engine_run(struct passo_engine *engine, uint64_t clocks);

/* For a host that reads the state every `period` clocks, with frames of `look` clocks, the next of them now:
 * runs through the periods in which it would certainly read what it did in the last frame. They need no
 * frames: a frame that only reads changes nothing in the core that moves. Returns the clocks, 0 if the host
 * must look; always 0 with the RTL, with inputs, whose watchdog needs the frames, and with a machine. */
uint64_t passo_engine_pass_looks(struct passo_engine *engine, uint64_t period, uint64_t look);

/* A struct passo_hardware of the driver: its functions with the engine as the context. A frame is followed by
 * PASSO_ENGINE_GAP clocks, which the core needs to execute it. */
#define PASSO_ENGINE_GAP 64u
bool passo_engine_host_transfer(void *engine, const uint32_t *mosi, uint32_t *miso, size_t words);
uint32_t passo_engine_host_microseconds(void *engine);
void passo_engine_host_wait(void *engine, uint32_t microseconds);

/* Direct access to the SPI pins, for an external master that counts time in ticks. Sets the unit: `ticks`
 * last as long as `clocks` of the core, and tick t ends with clock floor(t * clocks / ticks). Tick 0 is
 * now. */
void passo_engine_pace(struct passo_engine *engine, uint64_t clocks, uint64_t ticks);

/* Runs to the end of a tick, but only to the first tick at whose end irq has changed or the log is full.
 * Ticks in the past are ignored. Returns the tick reached. */
uint64_t passo_engine_follow(struct passo_engine *engine, uint64_t tick);

/* Asserts (true) or releases (false) chip select now. */
void passo_engine_select(struct passo_engine *engine, bool selected);

/* Exchanges bytes in mode 0, most significant bit first, starting now; each SCLK level lasts `half_period`
 * ticks. Not limited by a full log. */
void passo_engine_exchange(
    struct passo_engine *engine, const uint8_t *mosi, uint8_t *miso, size_t count, uint32_t half_period);

/* Levels of the irq and running pins, one bit per channel. */
uint32_t passo_engine_irq(const struct passo_engine *engine);
uint32_t passo_engine_running(const struct passo_engine *engine);

/* Sets the levels of an input pin, a bit per axis or channel, from the next clock on. */
void passo_engine_set(struct passo_engine *engine, enum passo_input input, uint64_t levels);
uint64_t passo_engine_clock(const struct passo_engine *engine);

/* Events in the log. */
size_t passo_engine_waiting(const struct passo_engine *engine);
/* Moves up to `capacity` of the oldest events to `events`; returns their number. */
size_t passo_engine_drain(struct passo_engine *engine, struct passo_pin_event *events, size_t capacity);

/* Records all signals of the core to an FST file, from `begin` to `end` clocks after the next clock on which
 * a channel is running; with `begin` 0 from now on. Time 0 is the reset. False if this build has no waves. */
bool passo_engine_open_waves(struct passo_engine *engine, const char *path, uint64_t begin, uint64_t end);
void passo_engine_close_waves(struct passo_engine *engine);

#ifdef __cplusplus
}
#endif

#endif
